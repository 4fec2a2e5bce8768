#pragma once

#include "pcl_fft_ground/cluster_extraction.h"

namespace pcl_fft_ground {

/** Clusters points by voxel contact (Sec. IV-C): non-empty voxels that touch, be it at a corner, form a
 * cluster.
 *
 * It may be put in the place of `pcl::EuclideanClusterExtraction`: on dense scans it is many times faster.
 * Clusters of equal size stand by their first point.
 */
template <typename PointT>
class VoxelClusterExtraction : public ClusterExtraction<PointT> {
 public:
  using Ptr = pcl::shared_ptr<VoxelClusterExtraction<PointT>>;
  using ConstPtr = pcl::shared_ptr<const VoxelClusterExtraction<PointT>>;

  VoxelClusterExtraction() : ClusterExtraction<PointT>("VoxelClusterExtraction") {}

 protected:
  std::vector<std::vector<Eigen::Index>> clustersOf(core::Points points) const override;
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/voxel_cluster_extraction.hpp>
#endif
