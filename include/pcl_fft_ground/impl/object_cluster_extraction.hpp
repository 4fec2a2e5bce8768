#pragma once

#include <pcl/console/print.h>
#include <pcl/exceptions.h>

#include <cmath>
#include <sstream>
#include <string>

#include <pcl/impl/pcl_base.hpp>

#include "pcl_fft_ground/core/scan/frame.h"
#include "pcl_fft_ground/core/scan/threads.h"
#include "pcl_fft_ground/impl/indexed_points.hpp"
#include "pcl_fft_ground/object_cluster_extraction.h"

namespace pcl_fft_ground {
namespace impl {

inline void requireOfObjectClusters(bool valid, const char* parameter, double value, const char* range) {
  if (valid) return;
  std::ostringstream message;
  message << "ObjectClusterExtraction: " << parameter << " is " << value << ", must be " << range;
  throw pcl::PCLException(message.str());
}

}  // namespace impl

template <typename PointT>
void ObjectClusterExtraction<PointT>::setLeafSize(double leaf_size) {
  impl::requireOfObjectClusters(std::isfinite(leaf_size) && leaf_size > 0, "leaf size", leaf_size,
                                "a finite number of metres above 0");
  leaf_size_ = leaf_size;
}

template <typename PointT>
void ObjectClusterExtraction<PointT>::setMinimumObjectSize(double size) {
  impl::requireOfObjectClusters(std::isfinite(size) && size > 0, "minimum object size", size,
                                "a finite number of metres above 0");
  minimum_object_size_ = size;
}

template <typename PointT>
void ObjectClusterExtraction<PointT>::setUpDirection(const Eigen::Vector3d& up) {
  const double length = up.stableNorm();
  impl::requireOfObjectClusters(up.allFinite() && length > 0, "length of the up direction", length,
                                "a finite number above 0");
  up_ = (up / up.cwiseAbs().maxCoeff()).normalized();
}

template <typename PointT>
void ObjectClusterExtraction<PointT>::extract(std::vector<pcl::PointIndices>& clusters) {
  clusters.clear();
  if (!initCompute()) return;
  const core::Threads threads(number_of_threads_);
  const impl::IndexedPoints<PointT> points(*input_, fake_indices_ ? nullptr : indices_.get());
  if (!points.areValid()) {
    PCL_ERROR("[pcl_fft_ground::ObjectClusterExtraction] the indices reach beyond the cloud of %zu points\n",
              input_->size());
    return;
  }
  if (!heights_.empty() && heights_.size() != input_->size() && heights_.size() != points.size()) {
    PCL_ERROR("[pcl_fft_ground::ObjectClusterExtraction] %zu heights for %zu points\n", heights_.size(),
              points.size());
    return;
  }
  Eigen::Isometry3d level = Eigen::Isometry3d::Identity();
  level.linear() = Eigen::Quaterniond::FromTwoVectors(up_, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  core::Points finite = points.finitePoints();
  const std::vector<std::size_t> positions = points.finitePositions(static_cast<std::size_t>(finite.cols()));
  // Creases look the same from a little aside: then the voxels are those of VoxelClusterExtraction.
  constexpr double LEVEL = 0.985;  // cosine of 10 degrees
  if (up_.z() < LEVEL) finite = core::transformed(std::move(finite), level);
  for (const std::vector<Eigen::Index>& members :
       core::objectClusters(finite, {leaf_size_, getMinimumObjectSize()})) {
    if (members.size() < min_cluster_size_ || members.size() > max_cluster_size_) continue;
    pcl::PointIndices& cluster = clusters.emplace_back();
    cluster.header = input_->header;
    cluster.indices.reserve(members.size());
    for (const Eigen::Index n : members) {
      const auto position = static_cast<std::size_t>(n);
      cluster.indices.push_back(points.index(positions.empty() ? position : positions[position]));
    }
  }
  deinitCompute();
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_ObjectClusterExtraction(T) \
  template class PCL_FFT_GROUND_FILTERS_EXPORT pcl_fft_ground::ObjectClusterExtraction<T>;
