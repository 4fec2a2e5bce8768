#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pcl_fft_ground/cluster_extraction.h"
#include "pcl_fft_ground/core/segments/object_clusters.h"

namespace pcl_fft_ground {

/** Clusters points into objects: what touches is told apart where it meets in creases
 * (core::objectClusters()).
 *
 * It may be put in the place of VoxelClusterExtraction and of `pcl::EuclideanClusterExtraction`. It takes the
 * object points of a scan that was made from above. The clusters do not depend on the order of the points;
 * such of equal size stand by their place.
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
class ObjectClusterExtraction : public ClusterExtraction<PointT> {
 public:
  using Ptr = pcl::shared_ptr<ObjectClusterExtraction<PointT>>;
  using ConstPtr = pcl::shared_ptr<const ObjectClusterExtraction<PointT>>;

  ObjectClusterExtraction() : ClusterExtraction<PointT>("ObjectClusterExtraction") {}

  /// Size of the smallest object [m], finite and above 0: of a heap, nothing smaller is cut off. Default: 4.5
  /// leaf sizes. An eighth of the largest object suits most scans. Throws `pcl::PCLException` on other
  /// values.
  void setMinimumObjectSize(double size);
  double getMinimumObjectSize() const {
    return minimum_object_size_.value_or(core::MINIMUM_OBJECT_LEAVES * this->getLeafSize());
  }

  /// Direction of positive elevation, any finite length above 0; kept normalised. Default: +z. One that leans
  /// by less than 10 degrees from +z counts as +z. Throws as
  /// above.
  void setUpDirection(const Eigen::Vector3d& up);
  Eigen::Vector3d getUpDirection() const { return up_; }

  /** Height above the ground [m], as GroundSegmentation::getHeightAboveGround() gives it: one for each point
   * of the cloud or, with setIndices(), one for each index. Empty, the default: not known. The clusters do
   * without it; it is kept for who measures them by core::measureObject(). With another number of heights
   * extract() finds nothing.
   */
  void setHeightAboveGround(std::vector<double> heights) { heights_ = std::move(heights); }
  const std::vector<double>& getHeightAboveGround() const { return heights_; }

 protected:
  std::vector<std::vector<Eigen::Index>> clustersOf(core::Points points) const override;
  std::string problem(std::size_t count) const override;
  using ClusterExtraction<PointT>::input_;

 private:
  std::optional<double> minimum_object_size_;
  Eigen::Vector3d up_ = Eigen::Vector3d::UnitZ();
  std::vector<double> heights_;
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/object_cluster_extraction.hpp>
#endif
