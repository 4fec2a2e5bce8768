#include "pcl_fft_ground/core/segments/object_properties.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "scan/parameter_check.h"
#include "segments/relief.h"
#include "segments/round_body.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double BORDER = 3;  // an object that comes nearer to the border may go on beyond it [leaf sizes]

/// Numbers of the points in an order that only their places and heights give.
std::vector<Eigen::Index> byPlace(const PointsView& points, const std::vector<double>& heights) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(points.cols()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  const auto key = [&](Eigen::Index n) {
    const double height = heights.empty() ? 0 : heights[static_cast<std::size_t>(n)];
    return std::make_tuple(points(0, n), points(1, n), points(2, n), height);
  };
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return key(a) < key(b); });
  return order;
}

void measureBox(const Eigen::Matrix3Xd& points, ObjectProperties& object) {
  object.centre = points.rowwise().mean();
  const Eigen::Matrix3Xd centred = points.colwise() - object.centre;
  const Eigen::Matrix3d covariance = centred * centred.transpose() / static_cast<double>(points.cols());
  object.axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().rowwise().reverse();
  const Eigen::Matrix3Xd along = object.axes.transpose() * centred;
  object.lengths = along.rowwise().maxCoeff() - along.rowwise().minCoeff();
}

/// Area that the points of a column cover [columns]: one if they are as dense as amid the object.
std::vector<double> coveredAreas(const Relief& relief, const std::vector<double>& counts) {
  double inner = 0, inner_columns = 0, all = 0;
  for (std::size_t c = 0; c < counts.size(); ++c) {
    all += counts[c];
    const auto& neighbours = relief.neighbours(c);
    if (std::count(neighbours.begin(), neighbours.end(), NO_COLUMN) > 0) continue;
    inner += counts[c];
    ++inner_columns;
  }
  const double density = inner_columns > 0 ? inner / inner_columns : all / static_cast<double>(counts.size());
  std::vector<double> areas;
  areas.reserve(counts.size());
  for (const double count : counts) areas.push_back(std::min(1.0, count / density));
  // Amid the object chance alone makes counts differ: there, a column is covered.
  for (std::size_t c = 0; c < counts.size(); ++c) {
    const auto& neighbours = relief.neighbours(c);
    if (std::count(neighbours.begin(), neighbours.end(), NO_COLUMN) == 0) areas[c] = 1;
  }
  return areas;
}

/// Greatest slope of a relief [degrees].
double steepestSlope(const Relief& relief) {
  constexpr double DEGREES = 57.29577951308232;
  const std::vector<float> heights = smoothed(relief, relief.heights());
  double steepest = 0;
  for (std::size_t c = 0; c < heights.size(); ++c) {
    const auto& n = relief.neighbours(c);
    if (n[0] == NO_COLUMN || n[2] == NO_COLUMN || n[4] == NO_COLUMN || n[6] == NO_COLUMN) continue;
    const auto at = [&](std::size_t d) { return heights[static_cast<std::size_t>(n[d])]; };
    steepest = std::max(steepest, 0.5 * std::hypot(at(0) - at(4), at(2) - at(6)));
  }
  return DEGREES * std::atan(steepest);
}

/// Footing, volume, height and slope. \param level points with z up
void measureRelief(const Points& level, const std::vector<double>& heights, double leaf_size,
                   ObjectProperties& object) {
  const Relief relief(level, leaf_size);
  std::vector<double> counts(relief.size(), 0), height_sums(relief.size(), 0);
  for (std::size_t n = 0; n < relief.columnOfPoint().size(); ++n) {
    const auto c = static_cast<std::size_t>(relief.columnOfPoint()[n]);
    ++counts[c];
    if (!heights.empty()) height_sums[c] += std::max(0.0, heights[n]);
  }
  const std::vector<double> areas = coveredAreas(relief, counts);
  const double area = relief.side() * relief.side();
  object.footing = area * std::accumulate(areas.begin(), areas.end(), 0.0);
  object.steepest = steepestSlope(relief);
  if (heights.empty()) return;
  object.height = *std::max_element(heights.begin(), heights.end());
  object.volume = 0;
  for (std::size_t c = 0; c < relief.size(); ++c)
    object.volume += area * areas[c] * height_sums[c] / counts[c];
}

bool isAtBorder(const Points& points, const ObjectView& view) {
  if (view.coverage == nullptr) return false;
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    if (!view.coverage->covers(points.col(n).cast<double>(), BORDER * view.leaf_size)) return true;
  return false;
}

}  // namespace

ObjectProperties measureObject(const PointsView& points, const std::vector<double>& heights,
                               const ObjectView& view) {
  require(std::isfinite(view.leaf_size) && view.leaf_size > 0, "leaf_size", view.leaf_size,
          "a finite number of metres above 0");
  if (!heights.empty() && heights.size() != static_cast<std::size_t>(points.cols()))
    throw std::invalid_argument("there must be one height per point");
  ObjectProperties object;
  if (points.cols() == 0) return object;

  const std::vector<Eigen::Index> order = byPlace(points, heights);
  const Points sorted = points(Eigen::all, order);
  std::vector<double> sorted_heights;
  if (!heights.empty())
    for (const Eigen::Index n : order) sorted_heights.push_back(heights[static_cast<std::size_t>(n)]);
  object.points = order.size();
  measureBox(sorted.cast<double>(), object);
  object.at_border = isAtBorder(sorted, view);

  const Eigen::Matrix3d level =
      Eigen::Quaterniond::FromTwoVectors(view.up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3Xd upright = level * (sorted.cast<double>().colwise() - object.centre);
  measureRelief(upright.cast<float>(), sorted_heights, view.leaf_size, object);
  ObjectProperties box = object;
  box.centre.setZero();
  box.axes = level * object.axes;
  object.body = fitRoundBody(upright, box);
  if (object.body) {
    object.body->centre = level.transpose() * object.body->centre + object.centre;
    object.body->axis = level.transpose() * object.body->axis;
  }
  return object;
}

}  // namespace pcl_fft_ground::core
