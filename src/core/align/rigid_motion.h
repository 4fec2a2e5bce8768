#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pcl_fft_ground/core/align/rigid_fit.h"

namespace pcl_fft_ground::core {

/// The cross product with a vector, as a matrix.
Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v);

/// The motion of a twist (translation part, rotation vector [rad]), an element of the Lie algebra of SE(3),
/// and the twist of a motion (rotation below pi).
Eigen::Isometry3d motionOf(const Vector6d& twist);
Vector6d twistOf(const Eigen::Isometry3d& motion);

/// Angle of the turn from one pose to another [rad], 0 to pi.
inline double angleBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Eigen::Matrix3d turn = a.linear().transpose() * b.linear();
  return Eigen::AngleAxisd(turn).angle();
}

/// Carries a twist into another frame: motion * motionOf(t) = motionOf(adjoint(motion) t) * motion.
Matrix6d adjoint(const Eigen::Isometry3d& motion);

/// Derivative of twistOf(motionOf(twist) * motionOf(d)) by d at 0, to second order in the twist; with the
/// twist's sign turned that of twistOf(motionOf(d) * motionOf(twist)).
Matrix6d rightInverseJacobian(const Vector6d& twist);

}  // namespace pcl_fft_ground::core
