#pragma once

#include <pcl/registration/registration.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/align/relief_alignment.h"
#include "pcl_fft_ground/registration_export.h"
#include "pcl_fft_ground/scan_describer.h"

namespace pcl_fft_ground {

/** Aligns two overlapping scans by the relief of the ground, where there are no objects to go by.
 *
 * The initial guess is that of align(): where navigation puts the source, in the target's frame. All places
 * that navigation allows are searched, by correlation in the frequency domain (core::alignRelief()). A pair
 * that cannot be aligned with confidence is refused: hasConverged() is false, getRefusal() says why, and the
 * final transformation is the guess. Nothing but a setter throws.
 *
 * Bare ground is asked for: where an alignment would be accepted the objects on either scan are found by
 * FFTGroundSegmentation, and if they have more than setMaxObjectShare() of the voxels the pair is refused, as
 * objects seen from other places have other sides and are no relief.
 *
 * The convergence criteria and the correspondences of `pcl::Registration` have no influence. No tree is built
 * over the target unless getFitnessScore() asks for one.
 */
template <typename PointSource, typename PointTarget>
class ReliefAlignment : public pcl::Registration<PointSource, PointTarget> {
 public:
  using Base = pcl::Registration<PointSource, PointTarget>;
  using Matrix4 = typename Base::Matrix4;
  using PointCloudSource = typename Base::PointCloudSource;
  using Ptr = pcl::shared_ptr<ReliefAlignment<PointSource, PointTarget>>;
  using ConstPtr = pcl::shared_ptr<const ReliefAlignment<PointSource, PointTarget>>;

  ReliefAlignment();

  /// How far off the guess may be, horizontally and, if setMaxRise() does not tell, vertically [m], above 0.
  /// Default 0.6.
  void setMaxShift(double shift);
  double getMaxShift() const { return parameters_.gates.max_shift; }

  /// How far off the guess may be vertically [m], above 0.
  void setMaxRise(double rise);
  double getMaxRise() const { return max_rise_.value_or(getMaxShift()); }

  /// How far off the heading of the guess may be [degrees], above 0 to 180. Default 8.
  void setMaxTurn(double degrees);
  double getMaxTurn() const { return parameters_.gates.max_turn; }

  /// Side of the finest cells of the elevation grids [m], at least 0. Default 0: 2.4 times the spacing of the
  /// points.
  void setCellSize(double size);
  double getCellSize() const { return parameters_.cell_size.value_or(0); }

  /// Largest share of a scan's voxels that objects may have, 0 to 1. Default 0.1; with 1 no objects are
  /// looked for, and what stands on the ground counts as relief: wrong poses then can be accepted.
  void setMaxObjectShare(double share);
  double getMaxObjectShare() const { return max_object_share_; }

  /// Largest deviation predicted at the edge of the overlap that is asked for [m], at least 0. Default 0: 0.4
  /// times the spacing of the points, which is allowed at most.
  void setMaxSigma(double sigma);
  double getMaxSigma() const { return parameters_.max_sigma.value_or(0); }

  /// Direction of positive elevation in both frames, any finite length above 0. Default +z.
  void setUpDirection(const Eigen::Vector3d& up);
  Eigen::Vector3d getUpDirection() const { return up_direction_; }

  /// Why the last pair was refused; empty if it was not.
  const std::string& getRefusal() const { return result_.refusal; }
  /// The pose of the last pair that fits best, refused or not; reference_from_moving is target_from_source.
  const core::ReliefPose& getBest() const { return result_.best; }
  /// Other places that navigation allows and where the relief fits better than around them, the best first.
  const std::vector<core::ReliefPose>& getRivals() const { return result_.rivals; }
  /// Predicted standard deviation at the edge of the overlap [m].
  double getDeviation() const { return result_.deviation; }
  /// Covariance of (translation [m], rotation vector [rad]) of a small motion after the transform, in the
  /// target's frame.
  const Eigen::Matrix<double, 6, 6>& getCovariance() const { return result_.covariance; }

 protected:
  void computeTransformation(PointCloudSource& output, const Matrix4& guess) override;

 private:
  std::string reasonAgainstObjects() const;

  using Base::converged_;
  using Base::final_transformation_;
  using Base::indices_;
  using Base::input_;
  using Base::reg_name_;
  using Base::target_;
  using Base::transformation_;

  core::ReliefParameters parameters_;
  std::optional<double> max_rise_;
  double max_object_share_ = core::MOST_OBJECTS_ON_RELIEF;
  Eigen::Vector3d up_direction_ = Eigen::Vector3d::UnitZ();
  core::ReliefResult result_;
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/relief_alignment.hpp>
#endif
