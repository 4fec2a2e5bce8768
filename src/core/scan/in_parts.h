#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "pcl_fft_ground/core/scan/frame.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"

/// The steps of summarise() and levelFrame(), for points that are not all there at once.
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
