#pragma once

#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>

#include <limits>
#include <vector>

#include "pcl_fft_ground/export.h"

namespace pcl_fft_ground {

/** Clusters points by voxel contact (Sec. IV-C): non-empty voxels that touch, be it at a corner, form a
 * cluster.
 *
 * The interface is that of `pcl::EuclideanClusterExtraction`, with the leaf size in place of the tolerance
 * and the search method, and it may be put in its place: on dense scans it is many times faster. Points that
 * are not finite belong to no cluster.
 */
template <typename PointT>
class VoxelClusterExtraction : public pcl::PCLBase<PointT> {
 public:
  using Ptr = pcl::shared_ptr<VoxelClusterExtraction<PointT>>;
  using ConstPtr = pcl::shared_ptr<const VoxelClusterExtraction<PointT>>;

  /// Side of a voxel [m], finite and above 0. Default 0.02. Throws `pcl::PCLException` on other values.
  void setLeafSize(double leaf_size);
  double getLeafSize() const { return leaf_size_; }

  /// The least number of points of a cluster. Default 1.
  void setMinClusterSize(pcl::uindex_t size) { min_cluster_size_ = size; }
  pcl::uindex_t getMinClusterSize() const { return min_cluster_size_; }

  /// The largest number of points of a cluster. Default: no limit.
  void setMaxClusterSize(pcl::uindex_t size) { max_cluster_size_ = size; }
  pcl::uindex_t getMaxClusterSize() const { return max_cluster_size_; }

  /** How many threads share the work: 0 is one for each core. Default 1: that which calls, or those that it
   * gives by a core::Threads. The results are the same for every number.
   */
  void setNumberOfThreads(unsigned threads) { number_of_threads_ = threads; }
  unsigned getNumberOfThreads() const { return number_of_threads_; }

  /** Finds the clusters.
   * \param[out] clusters indices into the input cloud, in the order of setIndices(); larger clusters first,
   * equal ones by their first point; old content is discarded. Empty without an input or with an invalid
   * index.
   */
  void extract(std::vector<pcl::PointIndices>& clusters);

 protected:
  using pcl::PCLBase<PointT>::input_;
  using pcl::PCLBase<PointT>::indices_;
  using pcl::PCLBase<PointT>::fake_indices_;
  using pcl::PCLBase<PointT>::initCompute;
  using pcl::PCLBase<PointT>::deinitCompute;

 private:
  double leaf_size_ = 0.02;
  unsigned number_of_threads_ = 1;
  pcl::uindex_t min_cluster_size_ = 1;
  pcl::uindex_t max_cluster_size_ = std::numeric_limits<pcl::uindex_t>::max();
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/voxel_cluster_extraction.hpp>
#endif
