#pragma once

#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>

#include <limits>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/scan/points.h"
#include "pcl_fft_ground/export.h"

namespace pcl_fft_ground {

/** What the classes that cluster points have in common; their interface is that of
 * `pcl::EuclideanClusterExtraction`, with the leaf size in place of the tolerance and the search method.
 *
 * Points that are not finite belong to no cluster.
 */
template <typename PointT>
class ClusterExtraction : public pcl::PCLBase<PointT> {
 public:
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
   * \param[out] clusters indices into the input cloud, in the order of setIndices(); larger clusters first;
   * old content is discarded. Empty without an input or with an invalid index.
   */
  void extract(std::vector<pcl::PointIndices>& clusters);

 protected:
  /// \param name of the class, for its messages
  explicit ClusterExtraction(const char* name) : name_(name) {}

  /// The clusters as columns of finite points, in the order of the clusters to be.
  virtual std::vector<std::vector<Eigen::Index>> clustersOf(core::Points points) const = 0;

  /// Why nothing can be clustered; empty if something can. \param count of the points that are listed
  virtual std::string problem(std::size_t count) const;

  /// Throws `pcl::PCLException` naming the parameter, its value and its range if it is not valid.
  void require(bool valid, const char* parameter, double value, const char* range) const;

  using pcl::PCLBase<PointT>::input_;
  using pcl::PCLBase<PointT>::indices_;
  using pcl::PCLBase<PointT>::fake_indices_;
  using pcl::PCLBase<PointT>::initCompute;
  using pcl::PCLBase<PointT>::deinitCompute;

 private:
  const char* name_;
  double leaf_size_ = 0.02;
  unsigned number_of_threads_ = 1;
  pcl::uindex_t min_cluster_size_ = 1;
  pcl::uindex_t max_cluster_size_ = std::numeric_limits<pcl::uindex_t>::max();
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/cluster_extraction.hpp>
#endif
