#include "pcl_fft_ground/core/scan/far_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace pcl_fft_ground::core {
namespace {

constexpr Eigen::Index FEWEST_POINTS = 8;      // fewer cannot tell a stray point from the scan
constexpr Eigen::Index CUT_OFF_ONE_IN = 2000;  // points left out at either end of an axis
constexpr double REACH = 3.0;                  // how many box lengths outside of the box are still the scan

/// True where no point can be far: a far point lies at least 5.8 standard deviations off the mean once a
/// thousand points are there, as at most a thousandth of them lies at either end of the box.
bool isCompact(const PointStatistics& statistics, Eigen::Index count) {
  if (count < 1000) return false;
  const double deviation = std::sqrt(statistics.covariance.diagonal().maxCoeff());
  const Eigen::Array3d mean = statistics.mean;
  const Eigen::Array3d reach = (statistics.bounds.high - mean).max(mean - statistics.bounds.low);
  return reach.maxCoeff() <= 4.0 * deviation;
}

/// Lower and upper end of the values of one axis, the outermost ones cut off.
std::pair<double, double> trimmedRange(const PointsView& points, Eigen::Index axis) {
  std::vector<float> values(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) values[static_cast<std::size_t>(i)] = points(axis, i);
  const auto cut = static_cast<std::ptrdiff_t>(std::max<Eigen::Index>(1, points.cols() / CUT_OFF_ONE_IN));
  const auto low = values.begin() + cut, high = values.end() - 1 - cut;
  std::nth_element(values.begin(), low, values.end());
  std::nth_element(low + 1, high, values.end());  // must not move *low
  return {*low, *high};
}

}  // namespace

Bounds reachOfScan(const PointsView& points) {
  constexpr double ANYWHERE = std::numeric_limits<double>::infinity();
  if (points.cols() < FEWEST_POINTS)
    return {Eigen::Array3d::Constant(-ANYWHERE), Eigen::Array3d::Constant(ANYWHERE)};
  Bounds box;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    std::tie(box.low[axis], box.high[axis]) = trimmedRange(points, axis);
  const double reach = REACH * (box.high - box.low).maxCoeff();
  return {box.low - reach, box.high + reach};
}

std::vector<Eigen::Index> findFarPoints(const PointsView& points, const PointStatistics& statistics) {
  if (points.cols() < FEWEST_POINTS || isCompact(statistics, points.cols())) return {};
  const Bounds within = reachOfScan(points);
  std::vector<Eigen::Index> far;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Array3d p = points.col(i).cast<double>().array();
    if ((p < within.low).any() || (p > within.high).any()) far.push_back(i);
  }
  return far;
}

}  // namespace pcl_fft_ground::core
