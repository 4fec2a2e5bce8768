#include "pcl_fft_ground/core/scan/far_points.h"

#include <algorithm>
#include <cmath>

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

std::vector<Eigen::Index> findFarPoints(const PointsView& points, const PointStatistics& statistics) {
  if (points.cols() < FEWEST_POINTS || isCompact(statistics, points.cols())) return {};
  Eigen::Array3d low, high;
  for (Eigen::Index axis = 0; axis < 3; ++axis) std::tie(low[axis], high[axis]) = trimmedRange(points, axis);
  const double reach = REACH * (high - low).maxCoeff();

  std::vector<Eigen::Index> far;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Array3d p = points.col(i).cast<double>().array();
    if ((p < low - reach).any() || (p > high + reach).any()) far.push_back(i);
  }
  return far;
}

}  // namespace pcl_fft_ground::core
