#include "pcl_fft_ground/core/align/rigid_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "align/rigid_motion.h"

namespace pcl_fft_ground::core {

Eigen::Isometry3d YawFit::solve() const {
  Eigen::Isometry3d to_from = Eigen::Isometry3d::Identity();
  if (weight_ <= 0) return to_from;
  const Eigen::Vector3d from = from_ / weight_;
  const Eigen::Vector3d to = to_ / weight_;
  const double dot = dot_ - weight_ * from.head<2>().dot(to.head<2>());
  const double cross = cross_ - weight_ * (from.x() * to.y() - from.y() * to.x());
  to_from.linear() = Eigen::AngleAxisd(std::atan2(cross, dot), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  to_from.translation() = to - to_from.linear() * from;
  return to_from;
}

Eigen::Isometry3d motionAbout(const Eigen::Vector3d& centre, const Vector6d& v) {
  const Eigen::Vector3d rotation = v.tail<3>();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = Eigen::AngleAxisd(rotation.norm(), rotation.stableNormalized()).toRotationMatrix();
  motion.translation() = centre + v.head<3>() - motion.linear() * centre;
  return motion;
}

void MotionFit::addToPlane(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                           const Eigen::Vector3d& normal, double weight) {
  Vector6d gradient;
  gradient << normal, (from - centre_).cross(normal);
  information_.noalias() += weight * gradient * gradient.transpose();
  gradient_ += weight * normal.dot(to - from) * gradient;
}

void MotionFit::addToPoint(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double weight) {
  addToPoint(from, to, Eigen::Matrix3d(weight * Eigen::Matrix3d::Identity()));
}

void MotionFit::addToPoint(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                           const Eigen::Matrix3d& weight) {
  Eigen::Matrix<double, 3, 6> jacobian;
  jacobian << Eigen::Matrix3d::Identity(), -crossMatrix(from - centre_);
  const Eigen::Matrix<double, 6, 3> weighted = jacobian.transpose() * weight;
  information_.noalias() += weighted * jacobian;
  gradient_ += weighted * (to - from);
}

Vector6d MotionFit::motion() const {
  constexpr double UNHELD = 1e-9;  // relative to the direction that is held best
  // Of dynamic size, as GCC sees uninitialised values in the fixed one where there are none.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information_);
  const Vector6d values = solver.eigenvalues();
  const Vector6d along = solver.eigenvectors().transpose() * gradient_;
  Vector6d step = Vector6d::Zero();
  for (Eigen::Index k = 0; k < 6; ++k)
    if (values[k] > UNHELD * values[5]) step += along[k] / values[k] * solver.eigenvectors().col(k);
  return step;
}

Matrix6d covarianceAboutOrigin(const Matrix6d& about_centre, const Eigen::Vector3d& centre) {
  // A turn about the centre shifts the origin by centre x rotation.
  Matrix6d origin_from_centre = Matrix6d::Identity();
  origin_from_centre.topRightCorner<3, 3>() = crossMatrix(centre);
  return origin_from_centre * about_centre * origin_from_centre.transpose();
}

double deviationAtDistance(const Matrix6d& covariance, double radius) {
  constexpr int DIRECTIONS = 8;
  double largest = 0;
  for (int k = 0; k < DIRECTIONS; ++k) {
    const double angle = 2 * 3.14159265358979323846 * k / DIRECTIONS;
    const Eigen::Vector3d arm(radius * std::cos(angle), radius * std::sin(angle), 0);
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian.leftCols<3>().setIdentity();
    jacobian.rightCols<3>() << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
    const Eigen::Matrix3d at_edge = jacobian * covariance * jacobian.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(at_edge, Eigen::EigenvaluesOnly);
    largest = std::max(largest, solver.eigenvalues()[2]);
  }
  return std::sqrt(std::max(0.0, largest));
}

double yawOf(const Eigen::Isometry3d& transform) {
  return std::atan2(transform(1, 0) - transform(0, 1), transform(0, 0) + transform(1, 1));
}

double tiltOf(const Eigen::Isometry3d& transform) {
  return std::acos(std::clamp(transform(2, 2), -1.0, 1.0));
}

Matrix6d jackknifeCovariance(const std::vector<MotionFit>& parts) {
  MotionFit all(Eigen::Vector3d::Zero());
  std::size_t count = 0;
  for (const MotionFit& part : parts) {
    if (part.information().isZero(0)) continue;
    all += part;
    ++count;
  }
  if (count < 2) return Matrix6d::Zero();
  const Vector6d motion = all.motion();
  Matrix6d sum = Matrix6d::Zero();
  for (const MotionFit& part : parts) {
    if (part.information().isZero(0)) continue;
    MotionFit others = all;
    others -= part;
    const Vector6d difference = others.motion() - motion;
    sum += difference * difference.transpose();
  }
  return static_cast<double>(count - 1) / static_cast<double>(count) * sum;
}

}  // namespace pcl_fft_ground::core
