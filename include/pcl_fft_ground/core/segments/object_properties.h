#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/grid/scan_coverage.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// A body that is round about an axis, fitted to what is seen of an object. Metres, in the frame of the
/// points.
struct RoundBody {
  enum class Shape {
    CYLINDER,  ///< a pipe; the length is that of the part that is seen
    ELLIPSOID  ///< a jar; the length is that of the whole ellipsoid
  };
  Shape shape = Shape::CYLINDER;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< amid the length, on the axis
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();   ///< unit length
  double length = 0;                                 ///< along the axis [m]
  double radius = 0;                                 ///< the largest [m]
  double residual = 0;  ///< root mean square distance of the points from its surface [m]; outliers count as
                        ///< much as three standard deviations
};

/// What can be measured of an object that is seen from above. Metres, in the frame of the points.
struct ObjectProperties {
  std::size_t points = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();          ///< mean of the points
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();        ///< principal axes in columns, the longest first
  Eigen::Vector3d lengths = Eigen::Vector3d::Zero();         ///< extent along each of them [m]
  double footing = 0;                                        ///< area that is covered, seen from above [m^2]
  double volume = std::numeric_limits<double>::quiet_NaN();  ///< between what is seen and the ground [m^3]
  double height = std::numeric_limits<double>::quiet_NaN();  ///< of the highest point above the ground [m]
  double steepest = 0;                                       ///< greatest slope of its upper side [degrees]
  bool at_border = false;         ///< part of it may lie outside of what the scan covers
  std::optional<RoundBody> body;  ///< where one fits to a twelfth of its radius
};

/// How objects are looked at.
struct ObjectView {
  double leaf_size = 0.02;                        ///< side of a voxel that holds a few points [m], > 0
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< direction of positive elevation, unit length
  const ScanCoverage* coverage = nullptr;         ///< where the scan has looked; null: at_border is not told
};

/** Measures an object.
 * \param points finite points of it
 * \param heights of each above the ground [m]; empty: volume and height are not known
 * \return a default value if there are no points. The same for every order of the points, bit for bit.
 * \throws std::invalid_argument if the numbers of points and heights differ or the leaf size is not above 0
 * \note O(n log n); the fits see no more than a few hundred points
 */
PCL_FFT_GROUND_CORE_EXPORT ObjectProperties measureObject(const PointsView& points,
                                                          const std::vector<double>& heights,
                                                          const ObjectView& view = {});

}  // namespace pcl_fft_ground::core
