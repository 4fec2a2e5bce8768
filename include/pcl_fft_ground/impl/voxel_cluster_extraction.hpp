#pragma once

#include <pcl/console/print.h>
#include <pcl/exceptions.h>

#include <cmath>
#include <sstream>

#include <pcl/impl/pcl_base.hpp>

#include "pcl_fft_ground/core/scan/threads.h"
#include "pcl_fft_ground/core/segments/voxel_clusters.h"
#include "pcl_fft_ground/impl/indexed_points.hpp"
#include "pcl_fft_ground/voxel_cluster_extraction.h"

namespace pcl_fft_ground {

template <typename PointT>
void VoxelClusterExtraction<PointT>::setLeafSize(double leaf_size) {
  if (!std::isfinite(leaf_size) || leaf_size <= 0) {
    std::ostringstream message;
    message << "VoxelClusterExtraction: leaf size is " << leaf_size
            << ", must be a finite number of metres above 0";
    throw pcl::PCLException(message.str());
  }
  leaf_size_ = leaf_size;
}

template <typename PointT>
void VoxelClusterExtraction<PointT>::extract(std::vector<pcl::PointIndices>& clusters) {
  clusters.clear();
  if (!initCompute()) return;
  const core::Threads threads(number_of_threads_);
  const impl::IndexedPoints<PointT> points(*input_, fake_indices_ ? nullptr : indices_.get());
  if (!points.areValid()) {
    PCL_ERROR("[pcl_fft_ground::VoxelClusterExtraction] the indices reach beyond the cloud of %zu points\n",
              input_->size());
    return;
  }
  const core::Points finite = points.finitePoints();
  const std::vector<std::size_t> positions = points.finitePositions(static_cast<std::size_t>(finite.cols()));
  for (const std::vector<Eigen::Index>& members : core::voxelClusters(finite, leaf_size_)) {
    if (members.size() < min_cluster_size_ || members.size() > max_cluster_size_) continue;
    pcl::PointIndices& cluster = clusters.emplace_back();
    cluster.header = input_->header;
    cluster.indices.reserve(members.size());
    for (const Eigen::Index n : members)
      cluster.indices.push_back(points.index(positions.empty() ? static_cast<std::size_t>(n) : positions[n]));
  }
  deinitCompute();
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_VoxelClusterExtraction(T) \
  template class PCL_FFT_GROUND_FILTERS_EXPORT pcl_fft_ground::VoxelClusterExtraction<T>;
