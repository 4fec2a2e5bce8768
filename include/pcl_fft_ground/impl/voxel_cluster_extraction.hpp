#pragma once

#include "pcl_fft_ground/core/segments/voxel_clusters.h"
#include "pcl_fft_ground/impl/cluster_extraction.hpp"
#include "pcl_fft_ground/voxel_cluster_extraction.h"

namespace pcl_fft_ground {

template <typename PointT>
std::vector<std::vector<Eigen::Index>> VoxelClusterExtraction<PointT>::clustersOf(core::Points points) const {
  return core::voxelClusters(points, this->getLeafSize());
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_VoxelClusterExtraction(T) \
  template class PCL_FFT_GROUND_FILTERS_EXPORT pcl_fft_ground::VoxelClusterExtraction<T>;
