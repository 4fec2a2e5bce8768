#pragma once

#include <pcl/common/transforms.h>
#include <pcl/exceptions.h>

#include <cmath>
#include <string>

#include <pcl/impl/pcl_base.hpp>

#include "pcl_fft_ground/impl/indexed_points.hpp"
#include "pcl_fft_ground/impl/lazy_kd_tree.hpp"
#include "pcl_fft_ground/impl/scan_describer.hpp"
#include "pcl_fft_ground/relief_alignment.h"

namespace pcl_fft_ground {
namespace impl {

inline void requireRelief(bool valid, const char* what, double value, const char* allowed) {
  if (!valid)
    throw pcl::PCLException(std::string("ReliefAlignment: ") + what + " is " + std::to_string(value) +
                            ", must be " + allowed);
}

inline bool isPositive(double value) {
  return value > 0 && std::isfinite(value);
}

}  // namespace impl

template <typename PointSource, typename PointTarget>
ReliefAlignment<PointSource, PointTarget>::ReliefAlignment() {
  reg_name_ = "ReliefAlignment";
  this->setSearchMethodTarget(typename Base::KdTreePtr(new impl::LazyKdTree<PointTarget>));
}

template <typename PointSource, typename PointTarget>
void ReliefAlignment<PointSource, PointTarget>::setMaxShift(double shift) {
  impl::requireRelief(impl::isPositive(shift), "largest shift [m]", shift, "a finite number above 0");
  parameters_.gates.max_shift = shift;
}

template <typename PointSource, typename PointTarget>
void ReliefAlignment<PointSource, PointTarget>::setMaxRise(double rise) {
  impl::requireRelief(impl::isPositive(rise), "largest rise [m]", rise, "a finite number above 0");
  max_rise_ = rise;
}

template <typename PointSource, typename PointTarget>
void ReliefAlignment<PointSource, PointTarget>::setMaxTurn(double degrees) {
  impl::requireRelief(degrees > 0 && degrees <= 180, "largest turn [degrees]", degrees, "above 0 to 180");
  parameters_.gates.max_turn = degrees;
}

template <typename PointSource, typename PointTarget>
void ReliefAlignment<PointSource, PointTarget>::setCellSize(double size) {
  impl::requireRelief(size >= 0 && std::isfinite(size), "cell size [m]", size,
                      "a finite number of 0 or more");
  if (size > 0)
    parameters_.cell_size = size;
  else
    parameters_.cell_size.reset();
}

template <typename PointSource, typename PointTarget>
void ReliefAlignment<PointSource, PointTarget>::setMaxObjectShare(double share) {
  impl::requireRelief(share >= 0 && share <= 1, "largest share of objects", share, "0 to 1");
  max_object_share_ = share;
}

template <typename PointSource, typename PointTarget>
void ReliefAlignment<PointSource, PointTarget>::setMaxSigma(double sigma) {
  impl::requireRelief(sigma >= 0 && std::isfinite(sigma), "largest deviation [m]", sigma,
                      "a finite number of 0 or more");
  if (sigma > 0)
    parameters_.max_sigma = sigma;
  else
    parameters_.max_sigma.reset();
}

template <typename PointSource, typename PointTarget>
void ReliefAlignment<PointSource, PointTarget>::setUpDirection(const Eigen::Vector3d& up) {
  const double length = up.stableNorm();
  impl::requireRelief(up.allFinite() && length > 0, "length of the up direction", length,
                      "a finite number above 0");
  up_direction_ = up.stableNormalized();
}

/// \return why the scans are not bare ground; empty if they are
template <typename PointSource, typename PointTarget>
std::string ReliefAlignment<PointSource, PointTarget>::reasonAgainstObjects() const {
  if (max_object_share_ >= 1) return {};
  const auto reason = [this](const std::string& which, const core::ScanSegments& scan,
                             const std::string& error) {
    if (!error.empty()) return "the objects of the " + which + " cannot be told: " + error;
    const double share = core::shareOfObjects(scan);
    if (share <= max_object_share_) return std::string();
    return "objects have " + std::to_string(std::lround(100 * share)) + " % of the voxels of the " + which +
           ", allowed are " + std::to_string(std::lround(100 * max_object_share_)) + " %";
  };
  ScanDescriber<PointSource> source;
  source.setUpDirection(up_direction_);
  const core::ScanSegments moving = source.describe(input_, indices_);
  const std::string against = reason("source", moving, source.getError());
  if (!against.empty()) return against;
  ScanDescriber<PointTarget> target;
  target.setUpDirection(up_direction_);
  const core::ScanSegments reference = target.describe(target_);
  return reason("target", reference, target.getError());
}

template <typename PointSource, typename PointTarget>
void ReliefAlignment<PointSource, PointTarget>::computeTransformation(PointCloudSource& output,
                                                                      const Matrix4& guess) {
  const Eigen::Isometry3d level(Eigen::Quaterniond::FromTwoVectors(up_direction_, Eigen::Vector3d::UnitZ()));
  const auto levelled = [&](const core::Points& points) -> core::Points {
    return level.linear().cast<float>() * points;
  };
  const core::Points source =
      levelled(impl::IndexedPoints<PointSource>(*input_, indices_.get()).finite().points);
  const core::Points target = levelled(impl::IndexedPoints<PointTarget>(*target_, nullptr).finite().points);
  Eigen::Isometry3d target_from_source(guess.template cast<double>());
  target_from_source.linear() =
      Eigen::Quaterniond(target_from_source.linear()).normalized().toRotationMatrix();
  core::ReliefParameters parameters = parameters_;
  parameters.gates.max_rise = getMaxRise();
  const Eigen::Isometry3d level_guess = level * target_from_source * level.inverse();
  try {
    result_ = core::alignRelief(source, target, level_guess, parameters);
    if (result_.accepted) result_.refusal = reasonAgainstObjects();
  } catch (const std::exception& problem) {  // points spread so widely that cells were too many
    result_ = core::ReliefResult();
    result_.best.reference_from_moving = level_guess;
    result_.refusal = problem.what();
    PCL_ERROR("[pcl_fft_ground::ReliefAlignment] %s\n", problem.what());
  }
  result_.accepted = result_.refusal.empty();
  if (!result_.accepted) result_.reference_from_moving = level_guess;

  const auto unlevelled = [&](const Eigen::Isometry3d& pose) { return level.inverse() * pose * level; };
  result_.reference_from_moving = unlevelled(result_.reference_from_moving);
  result_.best.reference_from_moving = unlevelled(result_.best.reference_from_moving);
  for (core::ReliefPose& rival : result_.rivals)
    rival.reference_from_moving = unlevelled(rival.reference_from_moving);
  Eigen::Matrix<double, 6, 6> input_from_level = Eigen::Matrix<double, 6, 6>::Zero();
  input_from_level.topLeftCorner<3, 3>() = input_from_level.bottomRightCorner<3, 3>() =
      level.linear().transpose();
  result_.covariance = (input_from_level * result_.covariance * input_from_level.transpose()).eval();
  converged_ = result_.accepted;
  transformation_ = final_transformation_ =
      result_.reference_from_moving.matrix().template cast<typename Matrix4::Scalar>();
  pcl::transformPointCloud(*input_, *indices_, output, final_transformation_);
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_ReliefAlignment(T) \
  template class PCL_FFT_GROUND_REGISTRATION_EXPORT pcl_fft_ground::ReliefAlignment<T, T>;
