#include "pcl_fft_ground/core/scan/frame.h"

#include <cmath>
#include <vector>

#include "pcl_fft_ground/core/scan/convex_hull.h"
#include "pcl_fft_ground/core/scan/threads.h"
#include "scan/hull_filter.h"
#include "scan/in_parts.h"

namespace pcl_fft_ground::core {
namespace {

/// The smallest rotation that turns a unit vector on to +z.
Eigen::Matrix3d levelFromInput(const Eigen::Vector3d& up) {
  const double horizontal = up.head<2>().norm();
  if (horizontal == 0) return Eigen::Vector3d(1, up.z() < 0 ? -1 : 1, up.z() < 0 ? -1 : 1).asDiagonal();
  const Eigen::Vector3d axis(up.y() / horizontal, -up.x() / horizontal, 0);
  return Eigen::AngleAxisd(std::atan2(horizontal, up.z()), axis).toRotationMatrix();
}

/// Angle [rad] of the main horizontal axis, (-pi/2, pi/2].
double principalAngle(const Eigen::Matrix2d& covariance) {
  return 0.5 * std::atan2(2 * covariance(0, 1), covariance(0, 0) - covariance(1, 1));
}

/// The corners of the convex hull of points, seen along up.
std::vector<Eigen::Vector2d> horizontalHull(const PointsView& points, const Eigen::Vector3d& centre,
                                            const Eigen::Matrix3d& level_from_input) {
  const HorizontalProjection projection{level_from_input.topRows<2>(), centre};
  return convexHull(outermostPoints(points, projection));
}

}  // namespace

double yawOf(Yaw yaw, const PointStatistics& statistics, const Eigen::Vector3d& up,
             const std::vector<Eigen::Vector2d>& hull) {
  const Eigen::Matrix3d level_from_input = levelFromInput(up);
  switch (yaw) {
    case Yaw::MIN_AREA_RECTANGLE:
      return minimumAreaRectangleAngle(hull);
    case Yaw::PRINCIPAL_AXES:
      return principalAngle(
          (level_from_input * statistics.covariance * level_from_input.transpose()).topLeftCorner<2, 2>());
    case Yaw::NONE:
      break;
  }
  return 0;
}

Eigen::Isometry3d levelFrame(const PointStatistics& statistics, const Eigen::Vector3d& up, double yaw) {
  Eigen::Isometry3d frame_from_input = Eigen::Isometry3d::Identity();
  frame_from_input.linear() =
      Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix() * levelFromInput(up);
  frame_from_input.translation() = -(frame_from_input.linear() * statistics.mean);
  return frame_from_input;
}

Eigen::Isometry3d levelFrame(const PointsView& points, const PointStatistics& statistics,
                             const Eigen::Vector3d& up, Yaw yaw) {
  if (points.cols() == 0) return Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector2d> hull;
  if (yaw == Yaw::MIN_AREA_RECTANGLE) hull = horizontalHull(points, statistics.mean, levelFromInput(up));
  return levelFrame(statistics, up, yawOf(yaw, statistics, up, hull));
}

Eigen::Isometry3d estimateFrame(const PointsView& points, const PointStatistics& statistics,
                                const FrameParameters& parameters) {
  return levelFrame(points, statistics, estimateUp(points, statistics, parameters).axis, parameters.yaw);
}

Points transformed(Points points, const Eigen::Isometry3d& target_from_source) {
  const Eigen::Matrix3d rotation = target_from_source.linear();
  const Eigen::Vector3d translation = target_from_source.translation();
  forEachRange(points.cols(), POINTS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
    for (Eigen::Index i = begin; i < end; ++i)
      points.col(i) = (rotation * points.col(i).cast<double>() + translation).cast<float>();
  });
  return points;
}

}  // namespace pcl_fft_ground::core
