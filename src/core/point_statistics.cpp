#include "pcl_fft_ground/core/point_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pcl_fft_ground::core {
namespace {

/// As many bits as let n products of two such numbers be summed in 63 bits, and no more than 20: a millionth.
int quantisationBits(Eigen::Index n) {
  return std::clamp((62 - std::ilogb(static_cast<double>(n))) / 2, 1, 20);
}

/// Sums of integer coordinates and of their products.
struct IntegerMoments {
  std::int64_t x = 0, y = 0, z = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void add(std::int64_t i, std::int64_t j, std::int64_t k) {
    x += i, y += j, z += k;
    xx += i * i, xy += i * j, xz += i * k;
    yy += j * j, yz += j * k, zz += k * k;
  }
  Eigen::Vector3d mean(double n) const { return Eigen::Vector3d(x, y, z) / n; }
  Eigen::Matrix3d covariance(double n) const {
    Eigen::Matrix3d products;
    products << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return products / n - mean(n) * mean(n).transpose();
  }
};

/// Four points at a time fill whole vector registers.
using FourPoints = Eigen::Array<float, 12, 1>;

FourPoints fourTimes(const Eigen::Array3f& values) {
  return values.replicate<4, 1>();
}

FourPoints fourPointsAt(const PointsView& points, Eigen::Index i) {
  return Eigen::Map<const FourPoints>(points.data() + 3 * i);
}

/// Moments of the points counted in steps from the lower corner.
IntegerMoments integerMoments(const PointsView& points, const Eigen::Array3d& low, float steps_per_metre) {
  IntegerMoments moments;
  const FourPoints lows = fourTimes(low.cast<float>());
  const Eigen::Index fours = points.cols() / 4 * 4;
  for (Eigen::Index i = 0; i < fours; i += 4) {
    const Eigen::Array<int, 12, 1> q = ((fourPointsAt(points, i) - lows) * steps_per_metre).cast<int>();
    for (Eigen::Index k = 0; k < 12; k += 3) moments.add(q[k], q[k + 1], q[k + 2]);
  }
  for (Eigen::Index i = fours; i < points.cols(); ++i) {
    const Eigen::Array3i q = ((points.col(i).array() - lows.head<3>()) * steps_per_metre).cast<int>();
    moments.add(q[0], q[1], q[2]);
  }
  return moments;
}

}  // namespace

Bounds boundsOf(const PointsView& points) {
  if (points.cols() == 0) return {};
  FourPoints lows = fourTimes(points.col(0)), highs = lows;
  const Eigen::Index fours = points.cols() / 4 * 4;
  for (Eigen::Index i = 0; i < fours; i += 4) {
    const FourPoints p = fourPointsAt(points, i);
    lows = lows.min(p);
    highs = highs.max(p);
  }
  Eigen::Array3f low = lows.reshaped(3, 4).rowwise().minCoeff(),
                 high = highs.reshaped(3, 4).rowwise().maxCoeff();
  for (Eigen::Index i = fours; i < points.cols(); ++i) {
    low = low.min(points.col(i).array());
    high = high.max(points.col(i).array());
  }
  return {low.cast<double>(), high.cast<double>()};
}

PointStatistics summarise(const PointsView& points) {
  PointStatistics result;
  result.bounds = boundsOf(points);
  const Eigen::Array3d low = result.bounds.low;
  result.mean = low;
  const double extent = (result.bounds.high - result.bounds.low).maxCoeff();
  if (extent == 0) return result;

  const double steps = std::ldexp(1.0, quantisationBits(points.cols())) / extent;
  const IntegerMoments moments = integerMoments(points, low, static_cast<float>(steps));
  const auto n = static_cast<double>(points.cols());
  // The casts round down: half a step brings the mean back to the middle.
  result.mean = low + (moments.mean(n).array() + 0.5) / steps;
  result.covariance = moments.covariance(n) / (steps * steps);
  return result;
}

}  // namespace pcl_fft_ground::core
