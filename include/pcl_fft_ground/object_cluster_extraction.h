#pragma once

#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "pcl_fft_ground/core/segments/object_clusters.h"
#include "pcl_fft_ground/export.h"

namespace pcl_fft_ground {

/** Clusters points into objects: what touches is told apart where it meets in creases
 * (core::objectClusters()).
 *
 * The interface is that of VoxelClusterExtraction and of `pcl::EuclideanClusterExtraction`, and it may be put
 * in their place. It takes the object points of a scan that was made from above. Points that are not finite
 * belong to no cluster. The clusters do not depend on the order of the points.
 *
 * \code
 * pcl_fft_ground::ObjectClusterExtraction<pcl::PointXYZ> extraction;
 * extraction.setInputCloud(scan);
 * extraction.setIndices(objects);
 * extraction.setMinimumObjectSize(0.1);
 * extraction.setHeightAboveGround(filter.getHeightAboveGround());
 * extraction.extract(clusters);
 * \endcode
 */
template <typename PointT>
class ObjectClusterExtraction : public pcl::PCLBase<PointT> {
 public:
  using Ptr = pcl::shared_ptr<ObjectClusterExtraction<PointT>>;
  using ConstPtr = pcl::shared_ptr<const ObjectClusterExtraction<PointT>>;

  /// Side of the voxels of contact [m], finite and above 0. Default 0.02. Throws `pcl::PCLException` on other
  /// values.
  void setLeafSize(double leaf_size);
  double getLeafSize() const { return leaf_size_; }

  /// Size of the smallest object [m], finite and above 0: of a heap, nothing smaller is cut off. Default: 4.5
  /// leaf sizes. An eighth of the largest object suits most scans. Throws as above.
  void setMinimumObjectSize(double size);
  double getMinimumObjectSize() const {
    return minimum_object_size_.value_or(core::MINIMUM_OBJECT_LEAVES * leaf_size_);
  }

  /// Direction of positive elevation, any finite length above 0; kept normalised. Default: +z. One that leans
  /// by less than 10 degrees from +z counts as +z. Throws as
  /// above.
  void setUpDirection(const Eigen::Vector3d& up);
  Eigen::Vector3d getUpDirection() const { return up_; }

  /** Height above the ground [m], as GroundSegmentation::getHeightAboveGround() gives it: one for each point
   * of the cloud or, with setIndices(), one for each index. Empty, the default: not known. The clusters do
   * without it; it is kept for who measures them by core::measureObject().
   */
  void setHeightAboveGround(std::vector<double> heights) { heights_ = std::move(heights); }
  const std::vector<double>& getHeightAboveGround() const { return heights_; }

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
   * equal ones by their place; old content is discarded. Empty without an input, with an invalid index or
   * with heights whose number fits neither the cloud nor the indices.
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
  std::optional<double> minimum_object_size_;
  Eigen::Vector3d up_ = Eigen::Vector3d::UnitZ();
  std::vector<double> heights_;
  unsigned number_of_threads_ = 1;
  pcl::uindex_t min_cluster_size_ = 1;
  pcl::uindex_t max_cluster_size_ = std::numeric_limits<pcl::uindex_t>::max();
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/object_cluster_extraction.hpp>
#endif
