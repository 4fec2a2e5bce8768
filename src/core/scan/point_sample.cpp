#include "scan/point_sample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "pcl_fft_ground/core/scan/threads.h"

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

/// The points of a part whose hash lies below the threshold.
Points chosenOf(const PointsView& points, Eigen::Index begin, Eigen::Index end, std::uint32_t threshold) {
  std::array<const float*, 512> chosen;
  Points sample(3, end - begin);
  float* to = sample.data();
  for (const float *p = points.data() + 3 * begin, *const last = points.data() + 3 * end; p < last;) {
    const float* const block_end = std::min(p + 3 * chosen.size(), last);
    std::size_t count = 0;
    for (; p < block_end; p += 3) {
      chosen[count] = p;  // half of all branches would be mispredicted
      count += hashOf(p) < threshold ? 1 : 0;
    }
    for (std::size_t k = 0; k < count; ++k, to += 3) std::copy_n(chosen[k], 3, to);
  }
  sample.conservativeResize(Eigen::NoChange, (to - sample.data()) / 3);
  return sample;
}

/// Number of the squares of a grid around the bounds that hold points.
Eigen::Index occupiedSquares(const Points& points, const Bounds& bounds, double side) {
  const Eigen::Array2i last = ((bounds.high - bounds.low).head<2>() / side).cast<int>();
  std::vector<bool> seen(static_cast<std::size_t>(last.x() + 1) * static_cast<std::size_t>(last.y() + 1),
                         false);
  Eigen::Index count = 0;
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Eigen::Array2d at = (points.col(n).head<2>().cast<double>().array() - bounds.low.head<2>()) / side;
    const Eigen::Array2i square = at.cast<int>().max(0).min(last);
    const auto k = static_cast<std::size_t>(square.x()) +
                   static_cast<std::size_t>(square.y()) * static_cast<std::size_t>(last.x() + 1);
    count += seen[k] ? 0 : 1;
    seen[k] = true;
  }
  return count;
}

}  // namespace

Points sampleOf(const PointsView& points, Eigen::Index wanted) {
  return sampleOfSample(points, points.cols(), wanted);
}

Points sampleOfSample(const PointsView& points, Eigen::Index total, Eigen::Index wanted) {
  if (total <= 2 * wanted) return points;
  const double share = static_cast<double>(wanted) / static_cast<double>(total);
  const auto threshold = static_cast<std::uint32_t>(share * 4294967295.0);
  const auto chosen = resultsOfRanges(
      points.cols(), POINTS_AT_A_TIME,
      [&](Eigen::Index begin, Eigen::Index end) { return chosenOf(points, begin, end, threshold); });
  Eigen::Index count = 0;
  for (const Points& part : chosen) count += part.cols();
  if (count == 0) return points;  // identical points: all are chosen or none
  Points sample(3, count);
  count = 0;
  for (const Points& part : chosen) {
    sample.middleCols(count, part.cols()) = part;
    count += part.cols();
  }
  return sample;
}

double spacingOf(const PointSample& scan, const Bounds& bounds) {
  constexpr double IN_SQUARE = 8, CLOSE_ENOUGH = 1.15;
  constexpr int TRIALS = 8;
  constexpr Eigen::Index ENOUGH = 30000;
  const Points sample = sampleOfSample(scan.points, scan.total, ENOUGH);
  const auto count = static_cast<double>(sample.cols());
  const Eigen::Array2d extents = (bounds.high - bounds.low).head<2>();
  double side =
      std::max(std::sqrt(extents.prod() * IN_SQUARE / count), extents.maxCoeff() * IN_SQUARE / count);
  for (int n = 0; n < TRIALS && side > 0; ++n) {
    const double in_square = count / static_cast<double>(occupiedSquares(sample, bounds, side));
    if (in_square <= CLOSE_ENOUGH * IN_SQUARE) break;
    side *= std::sqrt(IN_SQUARE / in_square);
  }
  return side / std::sqrt(IN_SQUARE * static_cast<double>(scan.total) / count);
}

}  // namespace pcl_fft_ground::core
