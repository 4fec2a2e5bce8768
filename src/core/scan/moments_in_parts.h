#pragma once

#include <array>
#include <cstdint>

#include "pcl_fft_ground/core/scan/point_statistics.h"

namespace pcl_fft_ground::core {

/** The sums of summarise(), for points that come in parts: bit for bit the same, as they are whole numbers.
 */
class MomentsInParts {
 public:
  /// \param bounds of all points
  /// \param points their number
  MomentsInParts(const Bounds& bounds, Eigen::Index points);

  void add(const PointsView& part);

  /// Of all points, once they are all added.
  PointStatistics statistics() const;

 private:
  Eigen::Index points_;
  Bounds bounds_;
  double steps_ = 0;  ///< to which coordinates are rounded, a metre; 0 where all points are one
  std::array<std::int64_t, 9> sums_{};
};

}  // namespace pcl_fft_ground::core
