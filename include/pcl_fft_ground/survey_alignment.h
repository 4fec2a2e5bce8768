#pragma once

#include <pcl/point_cloud.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/survey/survey.h"
#include "pcl_fft_ground/registration_export.h"
#include "pcl_fft_ground/scan_describer.h"

namespace pcl_fft_ground {

/** Aligns the scans of a survey pair by pair and makes one map of them: Sec. V-D of the paper and beyond.
 *
 * Each scan is described by its segments when it is added, some megabyte; its points are not kept. align()
 * pairs the scans by core::planPairs(), aligns each pair as SegmentICP does, and solves for all poses at once
 * by core::solveSurvey(). The z axes of the scans and of the world point up.
 *
 * Setters hold for the scans and pairs that follow. They throw `pcl::PCLException` on values out of range.
 */
template <typename PointT>
class SurveyAlignment {
 public:
  using PointCloudConstPtr = typename pcl::PointCloud<PointT>::ConstPtr;
  using Clusterer = typename ScanDescriber<PointT>::Clusterer;

  /// What finds the objects of the scans; FFTGroundSegmentation with its defaults if not set.
  void setGroundSegmentation(const typename GroundSegmentation<PointT>::Ptr& ground) {
    describer_.setGroundSegmentation(ground);
  }
  const typename GroundSegmentation<PointT>::Ptr& getGroundSegmentation() const {
    return describer_.getGroundSegmentation();
  }

  /// What clusters the objects; voxel contact if not set.
  void setClusterer(const Clusterer& clusterer) { describer_.setClusterer(clusterer); }
  const Clusterer& getClusterer() const { return describer_.getClusterer(); }

  /// Which clusters become segments.
  void setSegmentParameters(const core::SegmentParameters& parameters) {
    describer_.setSegmentParameters(parameters);
  }
  const core::SegmentParameters& getSegmentParameters() const { return describer_.getSegmentParameters(); }

  /// How pairs are aligned, and what is refused.
  void setAlignmentParameters(const core::AlignmentParameters& parameters);
  const core::AlignmentParameters& getAlignmentParameters() const { return parameters_; }

  /** Adds a scan and describes it.
   *
   * A scan on which the segmentation cannot work is kept where navigation has it, and its pairs say why.
   * \param cloud at least one finite point
   * \param world_from_scan its pose by navigation
   * \param sigmas how far that is trusted
   * \return the number of the scan, from 0
   * \throws pcl::PCLException if the cloud has no finite point or is spread too widely, the pose is not
   * finite, or a deviation is out of range
   */
  std::size_t addScan(const PointCloudConstPtr& cloud, const Eigen::Isometry3d& world_from_scan,
                      const core::NavigationSigmas& sigmas = {});

  /// Number of scans.
  std::size_t size() const { return scans_.size(); }

  /// Aligns all pairs that were not tried yet, and solves for the poses. Pairs that are refused are a result.
  /// \throws pcl::PCLException where the pairs do not let it solve for the poses
  void align();

  /** Aligns the scans added since the last call with those before them that they overlap, and refines the
   * poses around them: for a survey under way, at the cost of the neighbourhood whatever the size of the
   * survey.
   *
   * Now and then, and where a newcomer does not fit the map, all poses are solved for at once.
   * \throws pcl::PCLException as align()
   */
  void update();

  /// Pose of a scan: by navigation before align() or update(). \throws pcl::PCLException for a number without
  /// a scan
  const Eigen::Isometry3d& getPose(std::size_t id) const;

  /// What came of the pairs, in the order in which they were tried; `method` is empty.
  const std::vector<core::PairResult>& getPairs() const { return pairs_; }

  /// The scans as the survey sees them, by their numbers: for core::poseErrors() and core::withErrors().
  const std::vector<core::SurveyScan>& getScans() const { return scans_; }

  /// The poses of all scans by navigation, along the chain, and by all pairs together: of the last
  /// time that all were solved for; `global` is that of getPose().
  const core::SurveyPoses& getPoses() const { return poses_; }

 private:
  struct Description {
    core::ScanSegments segments;
    std::string error;  ///< why there are none
  };

  void alignPair(const core::PlannedPair& pair, const Eigen::Isometry3d& guess);
  void addNewcomer(std::size_t newcomer);
  void solve();
  bool isTried(const core::SubmapPair& pair) const;

  ScanDescriber<PointT> describer_;
  core::AlignmentParameters parameters_;
  std::vector<core::SurveyScan> scans_;
  std::vector<Description> descriptions_;
  std::vector<core::PairResult> pairs_;
  core::SurveyPoses poses_;
  std::size_t updated_ = 0;  ///< scans that have been aligned with those before them
  std::size_t solved_ = 0;   ///< scans when all poses were solved for
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/survey_alignment.hpp>
#endif
