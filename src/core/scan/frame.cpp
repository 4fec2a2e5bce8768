#include "pcl_fft_ground/core/scan/frame.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <optional>

#include "pcl_fft_ground/core/scan/convex_hull.h"
#include "scan/hull_filter.h"
#include "scan/robust_up.h"

namespace pcl_fft_ground::core {
namespace {

/// Direction of positive elevation, a unit vector.
Eigen::Vector3d estimateUp(const PointsView& points, const Eigen::Matrix3d& covariance,
                           const FrameParameters& parameters) {
  const Eigen::Vector3d given = parameters.up_direction.normalized();
  if (parameters.up_estimation == UpEstimation::GIVEN) return given;

  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::Vector3d variance = solver.eigenvalues();
  const bool no_plane = variance[1] <= 1e-9 * variance[2];
  if (no_plane) return given;
  const Eigen::Vector3d axis = solver.eigenvectors().col(0);
  const Eigen::Vector3d up = axis.dot(given) < 0 ? Eigen::Vector3d(-axis) : axis;
  if (parameters.up_estimation == UpEstimation::PRINCIPAL_AXIS) return up;

  constexpr double FLATTEST_VARIANCE_RATIO = 0.04;  // a fifth, squared
  constexpr double MOST_LEANING = 0.7071;           // cosine of 45 degrees
  const bool trusted = variance[0] <= FLATTEST_VARIANCE_RATIO * variance[1] && up.dot(given) >= MOST_LEANING;
  const Eigen::Vector3d fallback = trusted ? up : given;
  constexpr double AGREEING = 0.9986;  // cosine of 3 degrees: all points then tell more precisely than half
  const std::optional<Eigen::Vector3d> normal = normalOfFlattestHalf(points, given);
  return normal && !(trusted && normal->dot(up) >= AGREEING) ? *normal : fallback;
}

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

/// Angle [rad] of the smallest rectangle around the points, seen along up.
double rectangleAngle(const PointsView& points, const Eigen::Vector3d& centre,
                      const Eigen::Matrix3d& level_from_input) {
  const HorizontalProjection projection{level_from_input.topRows<2>(), centre};
  return minimumAreaRectangleAngle(convexHull(outermostPoints(points, projection)));
}

double estimateYaw(const PointsView& points, const PointStatistics& statistics,
                   const Eigen::Matrix3d& level_from_input, Yaw yaw) {
  switch (yaw) {
    case Yaw::MIN_AREA_RECTANGLE:
      return rectangleAngle(points, statistics.mean, level_from_input);
    case Yaw::PRINCIPAL_AXES:
      return principalAngle(
          (level_from_input * statistics.covariance * level_from_input.transpose()).topLeftCorner<2, 2>());
    case Yaw::NONE:
      break;
  }
  return 0;
}

}  // namespace

Eigen::Isometry3d estimateFrame(const PointsView& points, const PointStatistics& statistics,
                                const FrameParameters& parameters) {
  if (points.cols() == 0) return Eigen::Isometry3d::Identity();
  const Eigen::Matrix3d level_from_input =
      levelFromInput(estimateUp(points, statistics.covariance, parameters));
  const double yaw = estimateYaw(points, statistics, level_from_input, parameters.yaw);

  Eigen::Isometry3d frame_from_input = Eigen::Isometry3d::Identity();
  frame_from_input.linear() =
      Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix() * level_from_input;
  frame_from_input.translation() = -(frame_from_input.linear() * statistics.mean);
  return frame_from_input;
}

Points transformed(Points points, const Eigen::Isometry3d& target_from_source) {
  const Eigen::Matrix3d rotation = target_from_source.linear();
  const Eigen::Vector3d translation = target_from_source.translation();
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    points.col(i) = (rotation * points.col(i).cast<double>() + translation).cast<float>();
  return points;
}

}  // namespace pcl_fft_ground::core
