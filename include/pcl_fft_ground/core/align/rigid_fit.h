#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "pcl_fft_ground/core/export.h"

namespace pcl_fft_ground::core {

/** Least-squares turn about the vertical and shift that bring points on to others, in closed form. */
class YawFit {
 public:
  /// The weight is at least 0.
  void add(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double weight) {
    weight_ += weight;
    from_ += weight * from;
    to_ += weight * to;
    dot_ += weight * from.head<2>().dot(to.head<2>());
    cross_ += weight * (from.x() * to.y() - from.y() * to.x());
  }

  /// to_from; the identity if nothing of weight was added. Give points near the origin: the sums are plain.
  PCL_FFT_GROUND_CORE_EXPORT Eigen::Isometry3d solve() const;

 private:
  double weight_ = 0;
  double dot_ = 0;
  double cross_ = 0;
  Eigen::Vector3d from_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_ = Eigen::Vector3d::Zero();
};

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The motion v: first turned by the rotation vector v.tail(3) about `centre`, then shifted by v.head(3).
PCL_FFT_GROUND_CORE_EXPORT Eigen::Isometry3d motionAbout(const Eigen::Vector3d& centre, const Vector6d& v);

/** One Gauss-Newton step of a rigid motion in all six degrees of freedom: point-to-plane and point-to-point.
 *
 * Unknown is the motion of motionAbout() about a centre near the points, which keeps it well conditioned.
 */
class MotionFit {
 public:
  explicit MotionFit(const Eigen::Vector3d& centre) : centre_(centre) {}

  /// Distance of `from` to the plane through `to` with a unit `normal`. The weight is at least 0.
  PCL_FFT_GROUND_CORE_EXPORT void addToPlane(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                             const Eigen::Vector3d& normal, double weight);
  /// Distance of `from` to `to`. The weight is at least 0.
  PCL_FFT_GROUND_CORE_EXPORT void addToPoint(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                             double weight);
  /// The same with a weight for each direction. It is symmetric and has no negative eigenvalue.
  PCL_FFT_GROUND_CORE_EXPORT void addToPoint(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                             const Eigen::Matrix3d& weight);

  /// Adds or takes away the equations of another fit about the same centre.
  MotionFit& operator+=(const MotionFit& other) {
    information_ += other.information_;
    gradient_ += other.gradient_;
    return *this;
  }
  MotionFit& operator-=(const MotionFit& other) {
    information_ -= other.information_;
    gradient_ -= other.gradient_;
    return *this;
  }

  /// Shift and rotation vector, as for motionAbout(), that lower the weighted sum of squares most; directions
  /// that nothing holds do not move.
  PCL_FFT_GROUND_CORE_EXPORT Vector6d motion() const;

  /// The same as a transform.
  Eigen::Isometry3d solve() const { return motionAbout(centre_, motion()); }

  /// Sum of weight times squared gradient, in the order (shift, rotation) about the centre.
  const Matrix6d& information() const { return information_; }

 private:
  Eigen::Vector3d centre_;
  Matrix6d information_ = Matrix6d::Zero();
  Vector6d gradient_ = Vector6d::Zero();
};

/** Covariance of a motion by how far parts of the scene contradict each other: the jackknife.
 *
 * Errors that points of one part share, by drift inside a scan or by what each scan sees of an object, make
 * the parts disagree, however many points they have. Each part is left out in turn; of n parts
 * C = (n - 1) / n sum (v_i - v)(v_i - v)^T, v the motion by all of them, v_i that without the i-th.
 *
 * \param parts equations of each part for motions about one centre; parts without equations do not count
 * \return zero for fewer than two parts
 */
PCL_FFT_GROUND_CORE_EXPORT Matrix6d jackknifeCovariance(const std::vector<MotionFit>& parts);

/** Covariance for motions about the origin of what was found for motions about `centre`. */
PCL_FFT_GROUND_CORE_EXPORT Matrix6d covarianceAboutOrigin(const Matrix6d& about_centre,
                                                          const Eigen::Vector3d& centre);

/// Largest standard deviation of a motion, in any direction, at places so far from its centre, level with it
/// [m]. \param about_centre covariance for motions about the centre
PCL_FFT_GROUND_CORE_EXPORT double deviationAtDistance(const Matrix6d& about_centre, double distance);

/// Turn about the vertical [rad], in (-pi, pi], of a rotation that is nearly one.
PCL_FFT_GROUND_CORE_EXPORT double yawOf(const Eigen::Isometry3d& transform);

/// Angle [rad] by which a rotation tilts the vertical.
PCL_FFT_GROUND_CORE_EXPORT double tiltOf(const Eigen::Isometry3d& transform);

}  // namespace pcl_fft_ground::core
