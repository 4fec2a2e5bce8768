#include "scan/point_sample.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

namespace pcl_fft_ground::core {
namespace {

/// Spreads the bits of the coordinates over 32.
std::uint32_t hashOf(const float* coordinates) {
  std::uint32_t bits[3];
  std::memcpy(bits, coordinates, sizeof bits);
  std::uint32_t hash = bits[0] * 0x9e3779b1U ^ bits[1] * 0x85ebca6bU ^ bits[2] * 0xc2b2ae35U;
  hash ^= hash >> 15;
  hash *= 0x2c1b3c6dU;
  return hash ^ (hash >> 13);
}

}  // namespace

Points sampleOf(const PointsView& points, Eigen::Index wanted) {
  return sampleOfSample(points, points.cols(), wanted);
}

Points sampleOfSample(const PointsView& points, Eigen::Index total, Eigen::Index wanted) {
  if (total <= 2 * wanted) return points;
  const double share = static_cast<double>(wanted) / static_cast<double>(total);
  const auto threshold = static_cast<std::uint32_t>(share * 4294967295.0);
  std::vector<std::uint32_t> chosen(static_cast<std::size_t>(points.cols()));
  std::size_t count = 0;
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    chosen[count] = static_cast<std::uint32_t>(n);
    count += hashOf(points.data() + 3 * n) < threshold ? 1 : 0;
  }
  if (count == 0) return points;  // identical points: all are chosen or none
  Points sample(3, count);
  for (std::size_t k = 0; k < count; ++k)
    sample.col(static_cast<Eigen::Index>(k)) = points.col(static_cast<Eigen::Index>(chosen[k]));
  return sample;
}

}  // namespace pcl_fft_ground::core
