#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

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

/// What told on which side of the ground up is.
enum class SideSource {
  PRIOR,    ///< nothing: that of +z
  GIVEN,    ///< the direction that was given
  OBJECTS,  ///< what stands out of the ground
  SENSOR,   ///< the sensor, which stands above the ground
};

/// The direction of positive elevation and how sure it is.
struct UpDirection {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< a unit vector in the frame of the points
  SideSource side_from = SideSource::PRIOR;         ///< why `axis` and not -`axis`
  /// How much of a ground is seen along the axis, in [0, 1]: 1 / (1 + r^2), r the mean bend of the ground
  /// between neighbouring cells over their side; 1 where nothing was asked.
  double axis_confidence = 1;
  /// How sure the side is by what objects and sensor tell, in [0, 1]: 0.5 where they tell nothing, less where
  /// they speak against it; 1 where nothing was asked.
  double side_confidence = 1;
  std::vector<std::string> reasons;   ///< short sentences
  std::vector<std::string> warnings;  ///< what contradicts or is too weak to be relied on; usually none
};

/// Settings of estimateFrame().
struct FrameParameters {
  std::optional<Eigen::Vector3d> up_direction = {};  ///< up in the input frame, any length > 0; nothing: not
                                                     ///< known, +z as a rule
  UpEstimation up_estimation = UpEstimation::PRINCIPAL_AXIS;  ///< how up is found
  Yaw yaw = Yaw::MIN_AREA_RECTANGLE;                          ///< how the grid is turned about up
  std::optional<Eigen::Vector3d> sensor_position = {};  ///< of the sensor in the input frame [m], if known
};

/** Finds the direction of positive elevation (Sec. IV-A).
 *
 * PRINCIPAL_AXIS: the eigenvector of the smallest eigenvalue of the covariance, turned towards
 * `up_direction`; GIVEN: that direction itself. Where the points determine no plane (fewer than three,
 * identical or collinear ones) it is used, too. AUTO takes the principal axis of that half of the points
 * which lies closest to a plane: walls, tall objects and outliers do not tip it over. It is trusted where
 * these points are spread along it no more than a tenth as far as along the next axis; otherwise the
 * principal axis of all points is, where that share is at most a fifth. Where both are trusted and agree to 3
 * degrees, that of all points is taken. Neither is trusted if it leans by more than 45 degrees from the given
 * direction, which then is used.
 *
 * Where no direction is given, AUTO also chooses between z and other axes, and the side. Seen along up, the
 * lowest points are ground, which is smoother than what stands on it. The sensor stands above the ground:
 * that whose position is told or, where the points show the rays of one (showsSensorAtOrigin()), the one at
 * the origin. z, upwards, is taken unless these speak clearly for another direction.
 *
 * \param points points in the input frame
 * \note O(n). The result depends on the set of the points only, not on their order.
 */
PCL_FFT_GROUND_CORE_EXPORT UpDirection estimateUp(const PointsView& points, const PointStatistics& statistics,
                                                  const FrameParameters& parameters);

/** The frame in which a direction is +z and the centroid the origin: up is turned there by the smallest
 * rotation; then the grid is turned about z.
 * \param points points in the input frame; an empty set gives the identity
 * \param up a unit vector in the input frame
 * \return rigid transform `frame_from_input`
 */
PCL_FFT_GROUND_CORE_EXPORT Eigen::Isometry3d levelFrame(const PointsView& points,
                                                        const PointStatistics& statistics,
                                                        const Eigen::Vector3d& up, Yaw yaw);

/// The frame in which the scan is level (Sec. IV-A): levelFrame() with the up of estimateUp().
PCL_FFT_GROUND_CORE_EXPORT Eigen::Isometry3d estimateFrame(const PointsView& points,
                                                           const PointStatistics& statistics,
                                                           const FrameParameters& parameters);

/// Applies a rigid transform, computed in double, to points; points that are moved in are transformed in
/// place.
PCL_FFT_GROUND_CORE_EXPORT Points transformed(Points points, const Eigen::Isometry3d& target_from_source);

}  // namespace pcl_fft_ground::core
