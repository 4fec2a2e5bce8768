#include "align/rigid_motion.h"

#include <cmath>

namespace pcl_fft_ground::core {

namespace {

constexpr double SMALL_ANGLE = 1e-4;  // [rad]; below it series are exact to 1e-16

/// sin a / a, (1 - cos a) / a^2 and (a - sin a) / a^3.
Eigen::Vector3d rotationFactors(double angle) {
  const double square = angle * angle;
  if (angle < SMALL_ANGLE) return {1.0 - square / 6.0, 0.5 - square / 24.0, 1.0 / 6.0 - square / 120.0};
  return {std::sin(angle) / angle, (1.0 - std::cos(angle)) / square,
          (angle - std::sin(angle)) / (square * angle)};
}

/// Integral of the rotation along the motion: turns the twist's translation part into the translation.
Eigen::Matrix3d translationFactor(const Eigen::Vector3d& rotation) {
  const Eigen::Matrix3d cross = crossMatrix(rotation);
  const Eigen::Vector3d factors = rotationFactors(rotation.norm());
  return Eigen::Matrix3d::Identity() + factors.y() * cross + factors.z() * cross * cross;
}

}  // namespace

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

Eigen::Isometry3d motionOf(const Vector6d& twist) {
  const Eigen::Vector3d rotation = twist.tail<3>();
  const Eigen::Matrix3d cross = crossMatrix(rotation);
  const Eigen::Vector3d factors = rotationFactors(rotation.norm());
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() += factors.x() * cross + factors.y() * cross * cross;
  motion.translation() = translationFactor(rotation) * twist.head<3>();
  return motion;
}

Vector6d twistOf(const Eigen::Isometry3d& motion) {
  const Eigen::Quaterniond q(motion.linear());
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const double sine = q.vec().norm();  // of half the angle
  const double scale = sine < SMALL_ANGLE ? 2.0 : 2.0 * std::atan2(sine, sign * q.w()) / sine;
  Vector6d twist;
  twist.tail<3>() = sign * scale * q.vec();
  twist.head<3>() = translationFactor(twist.tail<3>()).partialPivLu().solve(motion.translation());
  return twist;
}

Matrix6d adjoint(const Eigen::Isometry3d& motion) {
  Matrix6d matrix = Matrix6d::Zero();
  matrix.topLeftCorner<3, 3>() = motion.linear();
  matrix.bottomRightCorner<3, 3>() = motion.linear();
  matrix.topRightCorner<3, 3>() = crossMatrix(motion.translation()) * motion.linear();
  return matrix;
}

Matrix6d rightInverseJacobian(const Vector6d& twist) {
  Matrix6d bracket = Matrix6d::Zero();
  bracket.topLeftCorner<3, 3>() = crossMatrix(twist.tail<3>());
  bracket.bottomRightCorner<3, 3>() = bracket.topLeftCorner<3, 3>();
  bracket.topRightCorner<3, 3>() = crossMatrix(twist.head<3>());
  return Matrix6d::Identity() + 0.5 * bracket + bracket * bracket / 12.0;
}

}  // namespace pcl_fft_ground::core
