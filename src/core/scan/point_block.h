#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// Some consecutive points, each coordinate on its own: loops over them run on several points at once.
struct PointBlock {
  static constexpr std::size_t SIZE = 512;

  std::array<float, SIZE> x, y, z;
  std::size_t count = 0;  ///< of the points that are there

  /// Takes up to SIZE points.
  void read(const PointsView& points, std::size_t begin) {
    count = std::min(SIZE, static_cast<std::size_t>(points.cols()) - begin);
    const float* p = points.data() + 3 * begin;
    for (std::size_t n = 0; n < count; ++n) {
      x[n] = p[3 * n];
      y[n] = p[3 * n + 1];
      z[n] = p[3 * n + 2];
    }
  }
};

}  // namespace pcl_fft_ground::core
