#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pcl_fft_ground/core/scan/frame.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"

/// The steps of levelFrame(), for points that are not all there at once.
namespace pcl_fft_ground::core {

/** Angle [rad] about up by which the axes must be turned.
 * \param up a unit vector in the input frame
 * \param hull convex hull of the points in levelFrame() with an angle of 0, seen along up
 */
double yawOf(Yaw yaw, const PointStatistics& statistics, const Eigen::Vector3d& up,
             const std::vector<Eigen::Vector2d>& hull);

/** The frame in which a direction is +z and the centroid the origin.
 * \param yaw angle about up [rad]
 * \return rigid transform `frame_from_input`
 */
Eigen::Isometry3d levelFrame(const PointStatistics& statistics, const Eigen::Vector3d& up, double yaw);

}  // namespace pcl_fft_ground::core
