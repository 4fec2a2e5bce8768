#pragma once

#include <Eigen/Geometry>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// How the direction of positive elevation is found.
enum class UpEstimation {
  AUTO,            ///< the axis of the flattest half where it can be trusted, otherwise the given direction
  PRINCIPAL_AXIS,  ///< the direction in which the points vary least (Sec. IV-A)
  GIVEN,           ///< the given direction
};

/// How the grid is turned about the vertical.
enum class Yaw {
  MIN_AREA_RECTANGLE,  ///< along the smallest rectangle around the horizontal convex hull: fewest empty cells
  PRINCIPAL_AXES,      ///< along the horizontal principal axes, as printed in Sec. IV-A
  NONE,                ///< not at all
};

/// Settings of estimateFrame().
struct FrameParameters {
  Eigen::Vector3d up_direction =
      Eigen::Vector3d::UnitZ();  ///< reference up in the input frame, any length > 0
  UpEstimation up_estimation = UpEstimation::PRINCIPAL_AXIS;  ///< how up is found
  Yaw yaw = Yaw::MIN_AREA_RECTANGLE;                          ///< how the grid is turned about up
};

/** Finds the frame in which the scan is level (Sec. IV-A): centroid at the origin, +z up.
 *
 * Up is the eigenvector of the smallest eigenvalue of the covariance, turned towards `up_direction`, or that
 * direction itself, and is brought on to +z by the smallest rotation; then the grid is turned about z. Where
 * the points determine no plane (fewer than three, identical or collinear ones) the given direction is used.
 * AUTO takes the principal axis of that half of the points which lies closest to a plane: walls, tall objects
 * and outliers do not tip it over. It is trusted where these points are spread along it no more than a tenth
 * as far as along the next axis; otherwise the principal axis of all points is, where that share is at most a
 * fifth. Where both are trusted and agree to 3 degrees, that of all points is taken.
 * Neither is trusted if it leans by more than 45 degrees from the given direction, which then is used.
 *
 * \param points points in the input frame; an empty set gives the identity
 * \return rigid transform `frame_from_input`
 * \note O(n). The result depends on the set of the points only, not on their order: all sums are sums of
 * integers.
 */
PCL_FFT_GROUND_CORE_EXPORT Eigen::Isometry3d estimateFrame(const PointsView& points,
                                                           const PointStatistics& statistics,
                                                           const FrameParameters& parameters);

/// Applies a rigid transform, computed in double, to points; points that are moved in are transformed in
/// place.
PCL_FFT_GROUND_CORE_EXPORT Points transformed(Points points, const Eigen::Isometry3d& target_from_source);

}  // namespace pcl_fft_ground::core
