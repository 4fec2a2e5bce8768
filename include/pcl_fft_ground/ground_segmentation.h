#pragma once

#include <pcl/PointIndices.h>
#include <pcl/filters/filter_indices.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/ground/ground_surface.h"
#include "pcl_fft_ground/core/ground/labels.h"
#include "pcl_fft_ground/core/scan/frame.h"
#include "pcl_fft_ground/core/scan/points.h"
#include "pcl_fft_ground/core/scan/prepare.h"
#include "pcl_fft_ground/export.h"
#include "pcl_fft_ground/impl/indexed_points.hpp"

namespace pcl_fft_ground {

using core::SideSource;
using core::UpDirection;
using core::UpEstimation;
using core::Yaw;

/** A filter that splits a scan into ground and objects: the interface that all methods share.
 *
 * As a `pcl::FilterIndices` it keeps the objects, ready for clustering, and with `setNegative(true)` the
 * ground; segment() gives both. Points that are not finite are in neither and always among the removed ones.
 * A point so far from all others that it cannot belong to the scan (core::findFarPoints()) counts as an
 * object and does not influence the rest. The input is never modified, and equal input gives equal output bit
 * for bit.
 *
 * `PointT` is a point type with x, y and z, or `pcl::PCLPointCloud2`: a cloud of any fields, all of which are
 * kept, as ROS nodes and PCL's command-line tools have them. Its x, y and z may be float64, and then keep
 * their detail at any distance from the origin (so do those of a point type).
 *
 * Where the data does not let the method work, nothing throws: PCL_ERROR and getError() say why, and every
 * finite point counts as ground. Setters throw `pcl::PCLException` on values out of range.
 */
template <typename PointT>
class GroundSegmentation : public pcl::FilterIndices<PointT> {
 public:
  using PointCloud = typename impl::CloudView<PointT>::Cloud;
  using Ptr = pcl::shared_ptr<GroundSegmentation<PointT>>;
  using ConstPtr = pcl::shared_ptr<const GroundSegmentation<PointT>>;

  GroundSegmentation(const GroundSegmentation& other);
  GroundSegmentation& operator=(const GroundSegmentation& other);

  /** Splits the input into ground and objects.
   * \param[out] ground,objects indices into the input cloud, in the order of setIndices(); old content is
   * discarded and the header is that of the cloud. `setNegative` has no influence. Both empty without an
   * input.
   */
  void segment(pcl::PointIndices& ground, pcl::PointIndices& objects);

  /// Reference direction of positive elevation in the frame of the input, any finite length above 0; kept
  /// normalised. Until it is called +z is the reference, and AUTO may find that another direction is up.
  void setUpDirection(const Eigen::Vector3d& up);
  Eigen::Vector3d getUpDirection() const {
    return frame_parameters_.up_direction.value_or(Eigen::Vector3d::UnitZ());
  }

  /// Where the sensor stood, finite, in the frame of the input [m]: above the ground, which tells AUTO the
  /// side. (The sensor origin of a cloud is not heeded: it is the pose of its frame.)
  void setSensorPosition(const Eigen::Vector3d& position);
  /// The position set; NaN where it is not.
  Eigen::Vector3d getSensorPosition() const;

  /// How the direction of positive elevation is found, see core::UpEstimation.
  void setUpEstimation(UpEstimation estimation);
  UpEstimation getUpEstimation() const { return frame_parameters_.up_estimation; }

  /// How the elevation grid is turned about the vertical, see core::Yaw.
  void setYaw(Yaw yaw) { frame_parameters_.yaw = yaw; }
  Yaw getYaw() const { return frame_parameters_.yaw; }

  /// Height above the ground surface [m], finite, up to which a point still is ground. Default 0, as
  /// published.
  void setHeightTolerance(double tolerance);
  virtual double getHeightTolerance() const { return height_tolerance_.value_or(0.0); }

  /** How many threads share the work: 0 is one for each core. Default 1: that which calls, or those that it
   * gives by a core::Threads. The results are the same for every number.
   */
  void setNumberOfThreads(unsigned threads) { number_of_threads_ = threads; }
  unsigned getNumberOfThreads() const { return number_of_threads_; }

  /// Height of the ground, as the method sees it, in the level frame of the last run; without cells before
  /// the first.
  virtual const core::GroundSurface& getGroundSurface() const = 0;

  /// Height above the ground of the last run [m], along up, of each point of the input, in the order of
  /// setIndices(); NaN for points that are not finite. Empty without an input, a valid list of indices or a
  /// ground.
  std::vector<double> getHeightAboveGround() const;

  /// The points of the input that the last run worked on (core::usablePoints()), in its level frame; without
  /// an input or a valid list of indices none. Transformed at each call.
  core::Points getLevelPoints() const;

  /// Up in the last run, in the frame of the input, what told it and how sure it is.
  const UpDirection& getUp() const { return up_; }

  /// Frame of the last run: brings input points into the level frame whose +z is up. Identity before the
  /// first run.
  const Eigen::Isometry3d& getFrame() const { return frame_from_input_; }

  /// Points of the last run that lie too far from all others to belong to the scan; they count as objects.
  const pcl::Indices& getFarPoints() const { return far_points_; }

  /// Why the last run could not segment its input; empty if it could.
  const std::string& getError() const { return error_; }

  /// What the last run found remarkable: results that cannot be right, doubtful up (getUp()), far points. A
  /// sentence each with the value, what it means and the option that helps; usually none. The same went to
  /// PCL_WARN.
  const std::vector<std::string>& getWarnings() const { return warnings_; }

 protected:
  GroundSegmentation(const std::string& name, const core::FrameParameters& frame_parameters,
                     bool extract_removed_indices);

  /** Labels points as ground or object: what a method has to bring.
   * \param points the finite points of the input in the level frame; may be empty
   * \param frame_from_input the transform that brought them there
   * \return a label per point
   * \throws std::exception if the data does not let the method work
   */
  virtual core::Labels labelPoints(const core::Points& points, const Eigen::Isometry3d& frame_from_input) = 0;

  /// The points that getLevelPoints() gives, and which of the input they are.
  core::UsablePoints levelPoints() const;

  /// Adds a sentence to getWarnings() and logs it.
  void warn(const std::string& sentence);

  /// How up is found unless setUpEstimation() is called.
  void setDefaultUpEstimation(UpEstimation estimation);

  /// The height tolerance [m], if it was set.
  const std::optional<double>& givenHeightTolerance() const { return height_tolerance_; }

  /// Throws `pcl::PCLException` naming parameter, value and range unless `valid`.
  void requireParameter(bool valid, const std::string& parameter, double value,
                        const std::string& range) const;

  /// Throws as above unless the value is a finite number of metres above 0.
  void requireLength(const std::string& parameter, double value) const;

  void applyFilter(pcl::Indices& indices) override;
  void applyFilter(PointCloud& output) override;

  using pcl::FilterIndices<PointT>::initCompute;
  using pcl::FilterIndices<PointT>::deinitCompute;
  using pcl::FilterIndices<PointT>::input_;
  using pcl::FilterIndices<PointT>::negative_;
  using pcl::FilterIndices<PointT>::keep_organized_;
  using pcl::FilterIndices<PointT>::user_filter_value_;
  using pcl::FilterIndices<PointT>::removed_indices_;
  using pcl::Filter<PointT>::extract_removed_indices_;
  using pcl::Filter<PointT>::filter_name_;
  using pcl::PCLBase<PointT>::indices_;
  using pcl::PCLBase<PointT>::fake_indices_;

 private:
  core::Label keptLabel() const { return negative_ ? core::Label::GROUND : core::Label::OBJECT; }
  core::Labels computeLabels();
  core::PreparedScan prepare(const impl::IndexedPoints<PointT>& points);
  core::Labels labelScan(const core::PreparedScan& scan);
  void reportError(const std::string& sentence);
  void copyPoints(const pcl::Indices& indices, PointCloud& output) const;
  void copyOrganized(const core::Labels& labels, PointCloud& output) const;

  core::FrameParameters frame_parameters_;
  bool up_estimation_is_given_ = false;
  std::optional<double> height_tolerance_;
  unsigned number_of_threads_ = 1;
  UpDirection up_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  ///< of the points that the last run worked on
  Eigen::Isometry3d frame_from_input_ = Eigen::Isometry3d::Identity();
  pcl::Indices far_points_;
  std::string error_;
  std::vector<std::string> warnings_;
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/ground_segmentation.hpp>
#endif
