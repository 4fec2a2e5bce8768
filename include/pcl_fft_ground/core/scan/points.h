#pragma once

#include <Eigen/Core>

namespace pcl_fft_ground::core {

/// Points of a scan, one per column: x, y, z [m]. All coordinates are finite.
using Points = Eigen::Matrix3Xf;

/// Read-only view of points that lie one behind the other in memory.
using PointsView = Eigen::Ref<const Points, 0, Eigen::OuterStride<3>>;

}  // namespace pcl_fft_ground::core
