#pragma once

#include <pcl/PointIndices.h>
#include <pcl/point_cloud.h>

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/segments/segment.h"
#include "pcl_fft_ground/ground_segmentation.h"
#include "pcl_fft_ground/registration_export.h"

namespace pcl_fft_ground {

/** Makes of a cloud what alignment needs to know of it: its segments and what it covers.
 *
 * Objects are told from ground by a segmentation and become segments by voxel contact, unless a clusterer or
 * the clusters themselves are given. What SegmentICP and SurveyAlignment see of a scan is made here.
 */
template <typename PointT>
class ScanDescriber {
 public:
  using PointCloudConstPtr = typename pcl::PointCloud<PointT>::ConstPtr;
  using Clusters = std::vector<pcl::PointIndices>;

  /// Finds the clusters of the object points of a cloud.
  using Clusterer =
      std::function<Clusters(const PointCloudConstPtr& cloud, const pcl::IndicesConstPtr& objects)>;

  /// What finds the objects; FFTGroundSegmentation with its defaults if not set or null.
  void setGroundSegmentation(const typename GroundSegmentation<PointT>::Ptr& ground) { ground_ = ground; }
  const typename GroundSegmentation<PointT>::Ptr& getGroundSegmentation() const { return ground_; }

  /// What clusters the objects; voxel contact if not set or empty.
  void setClusterer(const Clusterer& clusterer) { clusterer_ = clusterer; }
  const Clusterer& getClusterer() const { return clusterer_; }

  /// Clusters of object points, as indices into the cloud: nothing is segmented then. Empty: none are given.
  void setClusters(const Clusters& clusters) { clusters_ = clusters; }
  const Clusters& getClusters() const { return clusters_; }

  /// Which clusters become segments. \throws pcl::PCLException for a value out of range
  void setSegmentParameters(const core::SegmentParameters& parameters);
  const core::SegmentParameters& getSegmentParameters() const { return parameters_; }

  /// Direction of positive elevation in the frame of the cloud, any finite length above 0; kept normalised.
  /// A segmentation that was set has its own. Default +z. \throws pcl::PCLException for any other
  void setUpDirection(const Eigen::Vector3d& up);
  Eigen::Vector3d getUpDirection() const { return up_direction_; }

  /** Where the sensor stood, in the frame of the cloud [m]: alignment then judges by ray what the scan could
   * have seen. A segmentation is told so, too, that which was set included. Nothing (the default): a sensor
   * at the origin is found where the points show it, and other scans are looked at from above. \throws
   * pcl::PCLException for a place that is not finite
   */
  void setSensorPosition(const std::optional<Eigen::Vector3d>& position);
  const std::optional<Eigen::Vector3d>& getSensorPosition() const { return sensor_position_; }

  /// True if the clusters are not those of voxel contact.
  bool hasOwnClusters() const { return clusterer_ || !clusters_.empty(); }

  /// Side of the voxels that suit the cloud [m]: that of the parameters or, if they leave it open,
  /// core::voxelSizeFor() its points.
  double voxelSizeFor(const pcl::PointCloud<PointT>& cloud, const pcl::Indices* indices = nullptr) const;

  /** Describes a cloud in a frame whose z axis is up and whose origin is that of the cloud.
   * \param cloud in its own frame; points that are not finite do not count
   * \param indices the points to take; null: all
   * \param voxel_size side of a voxel [m]; 0: voxelSizeFor() the cloud
   * \return a scan without points, and getError() says why, where the cloud has no finite point, an index
   * lies beyond it, or the method cannot work on it
   */
  core::ScanSegments describe(const PointCloudConstPtr& cloud, const pcl::IndicesConstPtr& indices = nullptr,
                              double voxel_size = 0);

  /// Describes a cloud all of which is ground: for dense alignment. The same otherwise.
  core::ScanSegments describeAsGround(const PointCloudConstPtr& cloud,
                                      const pcl::IndicesConstPtr& indices = nullptr, double voxel_size = 0);

  /// Why the last cloud could not be described; empty if it could.
  const std::string& getError() const { return error_; }

  /// Turns the frame of the clouds to that of the descriptions.
  Eigen::Matrix3d levelFromInput() const;

 private:
  template <typename Describe>
  core::ScanSegments describeOrSayWhy(const pcl::PointCloud<PointT>& cloud, const pcl::Indices* indices,
                                      double voxel_size, const Describe& describe);
  pcl::PointIndices findObjects(const PointCloudConstPtr& cloud, const pcl::IndicesConstPtr& indices);

  typename GroundSegmentation<PointT>::Ptr ground_;
  Clusterer clusterer_;
  Clusters clusters_;
  core::SegmentParameters parameters_;
  Eigen::Vector3d up_direction_ = Eigen::Vector3d::UnitZ();
  std::optional<Eigen::Vector3d> sensor_position_;
  std::string error_;
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/scan_describer.hpp>
#endif
