#include "align/relief_icp.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pcl_fft_ground/core/scan/point_statistics.h"
#include "scan/point_sample.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double PI = 3.14159265358979323846;

constexpr Eigen::Index SAMPLE = 4000;  // points of each scan that take part
constexpr int MAX_ITERATIONS = 40;
constexpr double OUTLYING = 3;     // deviations at which a height counts half
constexpr double BLOCKS = 6;       // parts of the overlap along its longer side, for the jackknife
constexpr std::size_t LEAST = 30;  // heights that a fit rests on
constexpr double NEARLY_ALL = 0.95;

double medianOf(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

ReliefScan reliefScan(const PointsView& points, double spacing) {
  ReliefScan scan{{}, {}, reliefSurface(points, spacing)};
  const Points sample = sampleOf(points, SAMPLE);
  scan.sample.resize(3, sample.cols());
  Eigen::Index count = 0;
  for (Eigen::Index n = 0; n < sample.cols(); ++n) {
    const auto footing =
        scan.surface.at(static_cast<double>(sample(0, n)), static_cast<double>(sample(1, n)));
    if (!footing) continue;
    scan.sample.col(count++) = sample.col(n);
    scan.variance.push_back(footing->variance);
  }
  scan.sample.conservativeResize(Eigen::NoChange, count);
  return scan;
}

std::vector<ReliefIcp::Pair> ReliefIcp::pairsOf(const Eigen::Isometry3d& correction) const {
  std::vector<Pair> pairs;
  pairs.reserve(static_cast<std::size_t>(moving_.sample.cols() + reference_.sample.cols()));
  for (Eigen::Index n = 0; n < moving_.sample.cols(); ++n) {
    const Eigen::Vector3d from = correction * moving_.sample.col(n).cast<double>();
    const auto footing = reference_.surface.at(from.x(), from.y());
    if (!footing) continue;
    const Eigen::Vector3d normal(-footing->slope.x(), -footing->slope.y(), 1);
    pairs.push_back({from,
                     {from.x(), from.y(), footing->height},
                     normal,
                     from.z() - footing->height,
                     moving_.variance[static_cast<std::size_t>(n)] + footing->uncertainty});
  }
  const Eigen::Isometry3d inverse = correction.inverse();
  for (Eigen::Index n = 0; n < reference_.sample.cols(); ++n) {
    const Eigen::Vector3d to = reference_.sample.col(n).cast<double>();
    const Eigen::Vector3d place = inverse * to;
    const auto footing = moving_.surface.at(place.x(), place.y());
    if (!footing) continue;
    const Eigen::Vector3d normal(-footing->slope.x(), -footing->slope.y(), 1);
    pairs.push_back({correction * Eigen::Vector3d(place.x(), place.y(), footing->height), to,
                     correction.linear() * normal, footing->height - place.z(),
                     reference_.variance[static_cast<std::size_t>(n)] + footing->uncertainty});
  }
  return pairs;
}

ReliefFit ReliefIcp::run(const Eigen::Isometry3d& start) const {
  Eigen::Isometry3d correction = start;
  for (int iteration = 0; iteration < MAX_ITERATIONS; ++iteration) {
    const std::vector<Pair> pairs = pairsOf(correction);
    if (pairs.size() < LEAST) break;
    if (iteration == 0) {
      std::vector<double> heights;
      heights.reserve(pairs.size());
      for (const Pair& pair : pairs) heights.push_back(pair.height);
      correction = Eigen::Translation3d(0, 0, -medianOf(std::move(heights))) * correction;
      continue;
    }
    std::vector<double> sizes;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const Pair& pair : pairs) {
      sizes.push_back(std::abs(pair.height) / std::sqrt(pair.variance));
      centre += pair.to;
    }
    centre /= static_cast<double>(pairs.size());
    const double scale = OUTLYING * std::max(1.0, 1.48 * medianOf(sizes));
    MotionFit fit(centre);
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      const double weight = 1 / (1 + std::pow(sizes[n] / scale, 2));
      fit.addToPlane(pairs[n].from, pairs[n].to, pairs[n].normal, weight / pairs[n].variance);
    }
    const Vector6d step = fit.motion();
    correction = motionAbout(centre, step) * correction;
    if (step.head<3>().norm() < settled_) break;
  }
  return summarise(correction);
}

double ReliefIcp::overlapOf(const Eigen::Isometry3d& correction) const {
  double over_reference = 0, over_moving = 0;
  for (Eigen::Index n = 0; n < moving_.sample.cols(); ++n) {
    const Eigen::Vector3d place = correction * moving_.sample.col(n).cast<double>();
    if (reference_.surface.at(place.x(), place.y())) ++over_reference;
  }
  const Eigen::Isometry3d inverse = correction.inverse();
  for (Eigen::Index n = 0; n < reference_.sample.cols(); ++n) {
    const Eigen::Vector3d place = inverse * reference_.sample.col(n).cast<double>();
    if (moving_.surface.at(place.x(), place.y())) ++over_moving;
  }
  return std::max(over_reference / static_cast<double>(std::max<Eigen::Index>(1, moving_.sample.cols())),
                  over_moving / static_cast<double>(std::max<Eigen::Index>(1, reference_.sample.cols())));
}

/// What the two would leave if they had nothing in common but their mean planes, and how much there is of it.
void ReliefIcp::describeRelief(const std::vector<Pair>& pairs, ReliefFit& fit) const {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> products = Eigen::Matrix<double, 3, 2>::Zero();
  const auto place = [&](const Pair& pair) {
    return Eigen::Vector3d(1, pair.to.x() - fit.centre.x(), pair.to.y() - fit.centre.y());
  };
  for (const Pair& pair : pairs) {
    const Eigen::Vector3d p = place(pair);
    squares += p * p.transpose();
    products += p * Eigen::RowVector2d(pair.from.z() - fit.centre.z(), pair.to.z() - fit.centre.z());
  }
  const Eigen::Matrix<double, 3, 2> planes = squares.ldlt().solve(products);
  double unlike = 0, heights = 0, slopes = 0;
  for (const Pair& pair : pairs) {
    const Eigen::RowVector2d left =
        Eigen::RowVector2d(pair.from.z() - fit.centre.z(), pair.to.z() - fit.centre.z()) -
        place(pair).transpose() * planes;
    const Eigen::Vector2d slope = -pair.normal.head<2>() / pair.normal.z();
    unlike += left.squaredNorm() / pair.variance;
    heights += 0.5 * left.squaredNorm();
    slopes += (slope - 0.5 * planes.bottomRows<2>().rowwise().sum()).squaredNorm();
  }
  fit.relief = std::sqrt(unlike / fit.samples);
  // Of a Gaussian correlation of this length the mean squared slope is twice the variance over its square.
  fit.patch = slopes > 0 ? std::sqrt(2 * heights / slopes) : 0;
}

ReliefFit ReliefIcp::summarise(const Eigen::Isometry3d& correction) const {
  ReliefFit result;
  result.correction = correction;
  const std::vector<Pair> pairs = pairsOf(correction);
  result.samples = static_cast<double>(pairs.size());
  if (pairs.size() < LEAST) return result;
  result.overlap = overlapOf(correction);
  Eigen::AlignedBox2d box;
  for (const Pair& pair : pairs) {
    result.centre += pair.to / result.samples;
    box.extend(Eigen::Vector2d(pair.to.head<2>()));
  }
  const double side = box.sizes().maxCoeff() / BLOCKS;
  std::vector<MotionFit> blocks(static_cast<std::size_t>((BLOCKS + 1) * (BLOCKS + 1)),
                                MotionFit(result.centre));
  std::vector<double> distances;
  double sum = 0;
  for (const Pair& pair : pairs) {
    const Eigen::Array2d cell = (pair.to.head<2>() - box.min()) / side;
    const auto block = static_cast<std::size_t>(cell.x()) * static_cast<std::size_t>(BLOCKS + 1) +
                       static_cast<std::size_t>(cell.y());
    const double size = pair.height / std::sqrt(pair.variance);
    const double weight = 1 / (1 + std::pow(size / OUTLYING, 2));
    blocks[block].addToPlane(pair.from, pair.to, pair.normal, weight / pair.variance);
    sum += size * size;
    distances.push_back((pair.to - result.centre).head<2>().norm());
  }
  for (const MotionFit& block : blocks) result.information += block.information();
  result.spread = jackknifeCovariance(blocks);
  result.residual = std::sqrt(sum / result.samples);
  describeRelief(pairs, result);
  const double covered = result.overlap * std::min(moving_.surface.area(), reference_.surface.area());
  if (result.patch > 0) result.patches = covered / (PI * result.patch * result.patch);
  const auto far = distances.begin() + static_cast<std::ptrdiff_t>(NEARLY_ALL * result.samples);
  std::nth_element(distances.begin(), far, distances.end());
  result.radius = *far;
  return result;
}

}  // namespace pcl_fft_ground::core
