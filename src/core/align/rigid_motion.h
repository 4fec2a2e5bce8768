#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace pcl_fft_ground::core {

/// A motion as (translation part, rotation vector [rad]): an element of the Lie algebra of SE(3).
using Twist = Eigen::Matrix<double, 6, 1>;
using TwistMatrix = Eigen::Matrix<double, 6, 6>;

/// The cross product with a vector, as a matrix.
Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v);

/// The motion of a twist, and the twist of a motion (rotation below pi).
Eigen::Isometry3d motionOf(const Twist& twist);
Twist twistOf(const Eigen::Isometry3d& motion);

/// Carries a twist into another frame: motion * motionOf(t) = motionOf(adjoint(motion) t) * motion.
TwistMatrix adjoint(const Eigen::Isometry3d& motion);

/// Derivative of twistOf(motionOf(twist) * motionOf(d)) by d at 0, to second order in the twist; with the
/// twist's sign turned that of twistOf(motionOf(d) * motionOf(twist)).
TwistMatrix rightInverseJacobian(const Twist& twist);

}  // namespace pcl_fft_ground::core
