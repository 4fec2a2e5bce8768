#include "scan/robust_up.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "pcl_fft_ground/core/scan/point_statistics.h"
#include "scan/point_sample.h"
#include "scan/radix_sort.h"

namespace pcl_fft_ground::core {
namespace {

/// A sheet of points: its normal and the variances along its axes.
struct Sheet {
  Eigen::Vector3d normal;
  double thickness = 0, breadth = 0, length = 0;  ///< [m^2], in rising order
};

Sheet principalSheet(const PointsView& points, const Eigen::Vector3d& given) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(summarise(points).covariance);
  const Eigen::Vector3d axis = solver.eigenvectors().col(0);
  const Eigen::Vector3d& variance = solver.eigenvalues();
  return {axis.dot(given) < 0 ? Eigen::Vector3d(-axis) : axis, variance[0], variance[1], variance[2]};
}

/// Heights along a direction that enclose some of the points.
struct Slab {
  float low, high;
};

std::vector<float> sortedHeights(const Points& points, const Eigen::Vector3d& direction, RadixSort& sort) {
  const Eigen::VectorXf heights = (direction.cast<float>().transpose() * points).transpose();
  std::vector<float> sorted(heights.data(), heights.data() + heights.size());
  sort(sorted);
  return sorted;
}

/// The thinnest slab across a direction that holds half of the points.
Slab thinnestHalf(const Points& points, const Eigen::Vector3d& direction, RadixSort& sort) {
  const std::vector<float> sorted = sortedHeights(points, direction, sort);
  const std::size_t half = sorted.size() / 2;
  std::size_t lowest = 0;
  for (std::size_t n = 0; n + half < sorted.size(); ++n)
    if (sorted[n + half] - sorted[n] < sorted[lowest + half] - sorted[lowest]) lowest = n;
  return {sorted[lowest], sorted[lowest + half]};
}

/// The slab of the lowest points across a direction, outliers below excepted.
Slab lowestPart(const Points& points, const Eigen::Vector3d& direction, RadixSort& sort) {
  constexpr double OUTLIERS = 0.015, GROUND = 0.3;  // shares of the points
  const std::vector<float> sorted = sortedHeights(points, direction, sort);
  const auto last = static_cast<double>(sorted.size() - 1);
  return {sorted[static_cast<std::size_t>(OUTLIERS * last)], sorted[static_cast<std::size_t>(GROUND * last)]};
}

Points pointsIn(const Slab& slab, const Points& points, const Eigen::Vector3d& direction) {
  const Eigen::VectorXf heights = (direction.cast<float>().transpose() * points).transpose();
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index n = 0; n < heights.size(); ++n)
    if (heights[n] >= slab.low && heights[n] <= slab.high) chosen.push_back(n);
  return points(Eigen::all, chosen);
}

/// Slab and principal sheet of its points in turn, until the normal stays.
template <typename SlabOf>
Sheet concentrated(const Points& points, const Eigen::Vector3d& start, const Eigen::Vector3d& given,
                   const SlabOf& slab_of) {
  constexpr int STEPS = 30;
  constexpr double SETTLED = 5e-4;  // [rad]
  Sheet sheet{start};
  RadixSort sort;
  for (int n = 0; n < STEPS; ++n) {
    const Eigen::Vector3d last = sheet.normal;
    sheet = principalSheet(pointsIn(slab_of(points, last, sort), points, last), given);
    if ((sheet.normal - last).norm() < SETTLED) break;
  }
  return sheet;
}

bool isTrusted(const Sheet& sheet, const Eigen::Vector3d& given) {
  constexpr double FLATTEST_VARIANCE_RATIO = 0.01;  // a tenth, squared: half of a slab is half as thick
  constexpr double MOST_LEANING = 0.7071;           // cosine of 45 degrees
  return sheet.breadth > 0 && sheet.thickness <= FLATTEST_VARIANCE_RATIO * sheet.breadth &&
         sheet.normal.dot(given) >= MOST_LEANING;
}

/// The thinner of the trusted sheets that the two starts lead to.
template <typename SlabOf>
std::optional<Sheet> thinnestSheet(const Points& points, const Eigen::Vector3d& given,
                                   const SlabOf& slab_of) {
  std::optional<Sheet> best;
  for (const Eigen::Vector3d& start : {given, principalSheet(points, given).normal}) {
    const Sheet sheet = concentrated(points, start, given, slab_of);
    if (isTrusted(sheet, given) && (!best || sheet.thickness < best->thickness)) best = sheet;
  }
  return best;
}

bool isNarrow(const Sheet& sheet) {
  constexpr double NARROW = 0.25;  // a half, squared
  return sheet.breadth < NARROW * sheet.length;
}

/// The normal of the lowest part of the points where that is clearly thinner than across the sheet, and
/// flatter than the sheet is: the ground may have less than half of the points, but it lies below the others.
Eigen::Vector3d normalBelow(const Sheet& sheet, const Points& points, const Eigen::Vector3d& given) {
  constexpr float CLEARLY = 0.6F;
  constexpr double AGREEING = 0.9962;  // cosine of 5 degrees: so small a slope the ground may have itself
  const Sheet lowest = concentrated(points, sheet.normal, given, lowestPart);
  RadixSort sort;
  const auto thickness = [&](const Eigen::Vector3d& normal) {
    const Slab slab = lowestPart(points, normal, sort);
    return slab.high - slab.low;
  };
  const bool clearly = thickness(lowest.normal) < CLEARLY * thickness(sheet.normal);
  const bool elsewhere = lowest.normal.dot(sheet.normal) < AGREEING;
  const bool flatter = lowest.thickness < sheet.thickness;  // else a pit beside the ground and its wall
  return clearly && elsewhere && flatter && isTrusted(lowest, given) ? lowest.normal : sheet.normal;
}

/// The points from their lower corner, in a unit of their own that is a power of two: neither the place of a
/// scan nor its unit decides about rounding, or about which points a sample takes.
Points inOwnUnit(Points points) {
  if (points.cols() == 0) return points;
  const Bounds bounds = boundsOf(points);
  points.colwise() -= bounds.low.matrix().cast<float>();
  const double extent = (bounds.high - bounds.low).maxCoeff();
  if (extent > 0) points *= static_cast<float>(std::ldexp(1.0, std::clamp(-std::ilogb(extent), -126, 126)));
  return points;
}

}  // namespace

std::optional<Eigen::Vector3d> normalOfFlattestHalf(const PointSample& scan, const Eigen::Vector3d& given) {
  constexpr Eigen::Index FEWEST_POINTS = 8, ENOUGH = 4000, ENOUGH_TO_START = 1000;
  const Points sample = sampleOfSample(inOwnUnit(scan.points), scan.total, ENOUGH);
  if (sample.cols() < FEWEST_POINTS) return std::nullopt;
  const Points few = sampleOfSample(sample, scan.total, ENOUGH_TO_START);
  const std::optional<Sheet> rough =
      few.cols() < FEWEST_POINTS ? std::nullopt : thinnestSheet(few, given, thinnestHalf);
  const Sheet half = rough ? concentrated(sample, rough->normal, given, thinnestHalf) : Sheet{given};
  if (isTrusted(half, given)) return isNarrow(half) ? normalBelow(half, sample, given) : half.normal;
  const std::optional<Sheet> lowest = thinnestSheet(sample, given, lowestPart);
  return lowest && isNarrow(*lowest) ? std::optional<Eigen::Vector3d>(lowest->normal) : std::nullopt;
}

}  // namespace pcl_fft_ground::core
