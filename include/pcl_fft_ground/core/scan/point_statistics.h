#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// Smallest and largest coordinate of each axis [m].
struct Bounds {
  Eigen::Array3d low = Eigen::Array3d::Zero();
  Eigen::Array3d high = Eigen::Array3d::Zero();
};

/// Axis-aligned bounds of points; all zero for none. O(n).
PCL_FFT_GROUND_CORE_EXPORT Bounds boundsOf(const PointsView& points);

/// Coordinates beyond this are given relative to an origin: the floats around it are 1 mm apart [m].
constexpr double LARGE_COORDINATE = 1e4;

/** What to subtract from the coordinates of one axis before they become floats: the median of the finite
 * ones, which a few far outliers do not move, rounded to whole metres if it is beyond LARGE_COORDINATE; else
 * 0.
 */
PCL_FFT_GROUND_CORE_EXPORT double wholeOrigin(std::vector<double> coordinates);

/// Where the points of a scan lie, in the frame of the points.
struct PointStatistics {
  Bounds bounds;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();        ///< centroid [m]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance [m^2]
};

/** Bounds, centroid and covariance of points; all zero for none.
 *
 * Coordinates are rounded to a millionth of the longest side of the bounds (more coarsely beyond four million
 * points), so that all sums are sums of integers: the result does not depend on the order of the points.
 * O(n).
 */
PCL_FFT_GROUND_CORE_EXPORT PointStatistics summarise(const PointsView& points);

}  // namespace pcl_fft_ground::core
