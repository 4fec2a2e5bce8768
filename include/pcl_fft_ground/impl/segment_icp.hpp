#pragma once

#include <pcl/common/transforms.h>
#include <pcl/exceptions.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <pcl/impl/pcl_base.hpp>

#include "pcl_fft_ground/core/segments/voxel_clusters.h"
#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/impl/indexed_points.hpp"
#include "pcl_fft_ground/impl/lazy_kd_tree.hpp"
#include "pcl_fft_ground/segment_icp.h"
#include "pcl_fft_ground/voxel_cluster_extraction.h"

namespace pcl_fft_ground {
namespace impl {

/// Segments of a cloud: those given or, without any, those that ground segmentation and clusterer find.
template <typename PointT, typename Clusterer>
std::vector<pcl::PointIndices> clustersOf(const typename pcl::PointCloud<PointT>::ConstPtr& cloud,
                                          const pcl::IndicesConstPtr& indices,
                                          const std::vector<pcl::PointIndices>& given,
                                          const typename GroundSegmentation<PointT>::Ptr& ground_segmentation,
                                          const Clusterer& clusterer, double leaf_size) {
  if (!given.empty()) return given;
  typename GroundSegmentation<PointT>::Ptr segmentation = ground_segmentation;
  if (!segmentation) segmentation.reset(new FFTGroundSegmentation<PointT>);
  segmentation->setInputCloud(cloud);
  // All points of the target: PCLBase copies constant indices, so that there it must not be given none.
  segmentation->setIndices(indices ? pcl::IndicesPtr(new pcl::Indices(*indices)) : pcl::IndicesPtr());
  pcl::PointIndices ground;
  const pcl::PointIndices::Ptr objects(new pcl::PointIndices);
  segmentation->segment(ground, *objects);
  const pcl::IndicesConstPtr object_indices(new pcl::Indices(objects->indices));
  if (clusterer) return clusterer(cloud, object_indices);
  VoxelClusterExtraction<PointT> extraction;
  extraction.setLeafSize(leaf_size);
  extraction.setInputCloud(cloud);
  extraction.setIndices(object_indices);
  std::vector<pcl::PointIndices> clusters;
  if (!object_indices->empty()) extraction.extract(clusters);
  return clusters;
}

/// Columns of the usable points of a cloud that belong to each cluster.
template <typename PointT>
std::vector<std::vector<Eigen::Index>> columnsOf(const pcl::PointCloud<PointT>& cloud,
                                                 const core::UsablePoints& usable,
                                                 const std::vector<pcl::PointIndices>& clusters) {
  std::vector<Eigen::Index> column(cloud.size(), -1);
  for (Eigen::Index n = 0; n < usable.points.cols(); ++n)
    column[static_cast<std::size_t>(usable.column(n))] = n;
  std::vector<std::vector<Eigen::Index>> result;
  for (const pcl::PointIndices& cluster : clusters) {
    if (!IndexedPoints<PointT>(cloud, &cluster.indices).areValid())
      throw pcl::PCLException("SegmentICP: the indices of a segment reach beyond its cloud");
    std::vector<Eigen::Index>& columns = result.emplace_back();
    for (const pcl::index_t n : cluster.indices)
      if (column[static_cast<std::size_t>(n)] >= 0) columns.push_back(column[static_cast<std::size_t>(n)]);
  }
  return result;
}

}  // namespace impl

template <typename PointSource, typename PointTarget>
SegmentICP<PointSource, PointTarget>::SegmentICP() {
  reg_name_ = "SegmentICP";
  this->setSearchMethodTarget(typename Base::KdTreePtr(new impl::LazyKdTree<PointTarget>));
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setMinMatches(std::size_t matches) {
  if (matches < 1) throw pcl::PCLException("SegmentICP: number of matches is 0, must be 1 or more");
  parameters_.min_matches = matches;
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setMinScore(double score) {
  if (!(score >= 0 && score <= 1))
    throw pcl::PCLException("SegmentICP: least score is " + std::to_string(score) + ", must be 0 to 1");
  parameters_.min_score = score;
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setMaxSigma(double sigma) {
  if (!(sigma > 0 && std::isfinite(sigma)))
    throw pcl::PCLException("SegmentICP: largest deviation is " + std::to_string(sigma) +
                            " m, must be a finite number above 0");
  parameters_.max_sigma = sigma;
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::setUpDirection(const Eigen::Vector3d& up) {
  const double length = up.stableNorm();
  if (!up.allFinite() || !(length > 0))
    throw pcl::PCLException("SegmentICP: length of the up direction is " + std::to_string(length) +
                            ", must be a finite number above 0");
  up_direction_ = up.stableNormalized();
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::describe(const Eigen::Matrix3d& level_from_input) {
  const auto prepared = [&](core::RawPoints raw) {
    core::UsablePoints usable = core::usablePoints(std::move(raw));
    usable.points = level_from_input.cast<float>() * usable.points;
    return usable;
  };
  const core::UsablePoints source = prepared(impl::IndexedPoints<PointSource>(*input_, nullptr).rawPoints());
  const core::UsablePoints target = prepared(impl::IndexedPoints<PointTarget>(*target_, nullptr).rawPoints());
  core::SegmentParameters parameters = segment_parameters_;
  if (!parameters.voxel_size)
    parameters.voxel_size = std::max(core::voxelSizeFor(source.points), core::voxelSizeFor(target.points));
  const double leaf_size = *parameters.voxel_size;
  const Clusters source_clusters = impl::clustersOf<PointSource>(
      input_, indices_, source_segments_, source_ground_, source_clusterer_, leaf_size);
  const Clusters target_clusters = impl::clustersOf<PointTarget>(
      target_, nullptr, target_segments_, target_ground_, target_clusterer_, leaf_size);
  source_scan_ =
      core::describeScan(source.points, impl::columnsOf(*input_, source, source_clusters), parameters);
  target_scan_ =
      core::describeScan(target.points, impl::columnsOf(*target_, target, target_clusters), parameters);
}

template <typename PointSource, typename PointTarget>
void SegmentICP<PointSource, PointTarget>::computeTransformation(PointCloudSource& output,
                                                                 const Matrix4& guess) {
  const Eigen::Quaterniond level =
      Eigen::Quaterniond::FromTwoVectors(up_direction_, Eigen::Vector3d::UnitZ());
  const Eigen::Isometry3d level_from_input(level);
  describe(level.toRotationMatrix());
  Eigen::Isometry3d target_from_source(guess.template cast<double>());
  target_from_source.linear() =
      Eigen::Quaterniond(target_from_source.linear()).normalized().toRotationMatrix();
  alignment_ =
      core::alignScans(source_scan_, target_scan_,
                       level_from_input * target_from_source * level_from_input.inverse(), parameters_);
  const Eigen::Isometry3d found =
      level_from_input.inverse() * alignment_.reference_from_moving * level_from_input;
  Eigen::Matrix<double, 6, 6> input_from_level = Eigen::Matrix<double, 6, 6>::Zero();
  input_from_level.topLeftCorner<3, 3>() = input_from_level.bottomRightCorner<3, 3>() =
      level_from_input.linear().transpose();
  alignment_.covariance = (input_from_level * alignment_.covariance * input_from_level.transpose()).eval();
  converged_ = alignment_.accepted;
  transformation_ = final_transformation_ = found.matrix().template cast<typename Matrix4::Scalar>();
  pcl::transformPointCloud(*input_, *indices_, output, final_transformation_);
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_SegmentICP(T) \
  template class PCL_FFT_GROUND_REGISTRATION_EXPORT pcl_fft_ground::SegmentICP<T, T>;
