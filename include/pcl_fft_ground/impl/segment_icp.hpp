#pragma once

#include <pcl/common/transforms.h>
#include <pcl/console/print.h>
#include <pcl/exceptions.h>

#include <algorithm>
#include <stdexcept>

#include <pcl/impl/pcl_base.hpp>

#include "pcl_fft_ground/core/scan/threads.h"
#include "pcl_fft_ground/impl/lazy_kd_tree.hpp"
#include "pcl_fft_ground/impl/scan_describer.hpp"
#include "pcl_fft_ground/segment_icp.h"

namespace pcl_fft_ground {

template <typename PointSource, typename PointTarget>
SegmentICP<PointSource, PointTarget>::SegmentICP() {
  reg_name_ = "SegmentICP";
  this->setSearchMethodTarget(typename Base::KdTreePtr(new impl::LazyKdTree<PointTarget>));
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setInputTarget(const PointCloudTargetConstPtr& cloud) {
  Base::setInputTarget(cloud);
  forgetTarget();
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setTargetSegments(const Clusters& segments) {
  target_describer_.setClusters(segments);
  forgetTarget();
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setGroundSegmentation(
    const typename GroundSegmentation<PointSource>::Ptr& source,
    const typename GroundSegmentation<PointTarget>::Ptr& target) {
  source_describer_.setGroundSegmentation(source);
  target_describer_.setGroundSegmentation(target);
  forgetTarget();
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setClusterer(const Clusterer<PointSource>& source,
                                                        const Clusterer<PointTarget>& target) {
  source_describer_.setClusterer(source);
  target_describer_.setClusterer(target);
  forgetTarget();
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setAlignmentParameters(
    const core::AlignmentParameters& parameters) {
  try {
    core::validate(parameters);
  } catch (const std::invalid_argument& error) {
    throw pcl::PCLException(std::string("SegmentICP: ") + error.what());
  }
  parameters_ = parameters;
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setGates(const core::SearchGates& gates) {
  core::AlignmentParameters parameters = parameters_;
  parameters.gates = gates;
  setAlignmentParameters(parameters);
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setMinMatches(std::size_t matches) {
  core::AlignmentParameters parameters = parameters_;
  parameters.min_matches = matches;
  setAlignmentParameters(parameters);
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setMinScore(double score) {
  core::AlignmentParameters parameters = parameters_;
  parameters.min_score = score;
  setAlignmentParameters(parameters);
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setMaxSigma(double sigma) {
  core::AlignmentParameters parameters = parameters_;
  parameters.max_sigma = sigma;
  setAlignmentParameters(parameters);
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setSegmentParameters(const core::SegmentParameters& parameters) {
  source_describer_.setSegmentParameters(parameters);
  target_describer_.setSegmentParameters(parameters);
  forgetTarget();
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setUpDirection(const Eigen::Vector3d& up) {
  source_describer_.setUpDirection(up);
  target_describer_.setUpDirection(up);
  forgetTarget();
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setSensorPosition(const std::optional<Eigen::Vector3d>& source,
                                                             const std::optional<Eigen::Vector3d>& target) {
  source_describer_.setSensorPosition(source);
  target_describer_.setSensorPosition(target);
  forgetTarget();
}

/// \return why the scans cannot be described; empty if they can
template <typename PointSource, typename PointTarget>
std::string SegmentICP<PointSource, PointTarget>::describeScans() {
  const pcl::IndicesConstPtr source_indices = fake_indices_ ? nullptr : indices_;
  // Clusters that are not ours cannot be made anew in larger voxels: both scans get the larger ones at once.
  double voxel_size = 0;
  if (source_describer_.hasOwnClusters() || target_describer_.hasOwnClusters())
    voxel_size = std::max(source_describer_.voxelSizeFor(*input_, source_indices.get()),
                          target_describer_.voxelSizeFor(*target_));
  source_scan_ = source_describer_.describe(input_, source_indices, voxel_size);
  if (target_voxel_size_ != voxel_size) {
    target_scan_ = target_describer_.describe(target_, nullptr, voxel_size);
    target_voxel_size_ = voxel_size;
  }
  if (!source_describer_.getError().empty()) return "the source: " + source_describer_.getError();
  if (!target_describer_.getError().empty()) return "the target: " + target_describer_.getError();
  return {};
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::alignFrom(const Eigen::Isometry3d& guess) {
  const core::Threads threads(number_of_threads_);
  const Eigen::Isometry3d level_from_input(Eigen::Quaterniond(source_describer_.levelFromInput()));
  alignment_ = core::Alignment();
  alignment_.reference_from_moving = guess;
  converged_ = false;
  std::string error = describeScans();
  try {
    if (error.empty())
      alignment_ = core::alignScans(source_scan_, target_scan_,
                                    level_from_input * guess * level_from_input.inverse(), parameters_);
  } catch (const std::exception& problem) {
    error = problem.what();
  }
  if (!error.empty()) {
    alignment_.refusal = error;
    PCL_ERROR("[pcl_fft_ground::SegmentICP] %s\n", error.c_str());
    return;
  }
  alignment_.reference_from_moving =
      level_from_input.inverse() * alignment_.reference_from_moving * level_from_input;
  core::Matrix6d input_from_level = core::Matrix6d::Zero();
  input_from_level.topLeftCorner<3, 3>() = input_from_level.bottomRightCorner<3, 3>() =
      level_from_input.linear().transpose();
  alignment_.covariance = (input_from_level * alignment_.covariance * input_from_level.transpose()).eval();
  converged_ = alignment_.accepted;
}

template <typename PointSource, typename PointTarget>
const core::Alignment& SegmentICP<PointSource, PointTarget>::computeAlignment(
    const Eigen::Isometry3d& target_from_source) {
  converged_ = false;
  if (!this->initCompute()) {
    alignment_ = core::Alignment();
    alignment_.reference_from_moving = target_from_source;
    alignment_.refusal = "there is no source or no target";
    return alignment_;
  }
  alignFrom(target_from_source);
  transformation_ = final_transformation_ =
      alignment_.reference_from_moving.matrix().template cast<typename Matrix4::Scalar>();
  this->deinitCompute();
  return alignment_;
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::computeTransformation(PointCloudSource& output,
                                                                 const Matrix4& guess) {
  Eigen::Isometry3d target_from_source(guess.template cast<double>());
  target_from_source.linear() =
      Eigen::Quaterniond(target_from_source.linear()).normalized().toRotationMatrix();
  alignFrom(target_from_source);
  transformation_ = final_transformation_ =
      alignment_.reference_from_moving.matrix().template cast<typename Matrix4::Scalar>();
  pcl::transformPointCloud(*input_, *indices_, output, final_transformation_);
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_SegmentICP(T) \
  template class PCL_FFT_GROUND_REGISTRATION_EXPORT pcl_fft_ground::SegmentICP<T, T>;
