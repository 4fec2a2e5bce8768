#pragma once

#include <pcl/registration/registration.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/align/segment_alignment.h"
#include "pcl_fft_ground/ground_segmentation.h"
#include "pcl_fft_ground/registration_export.h"
#include "pcl_fft_ground/scan_describer.h"

namespace pcl_fft_ground {

/** Aligns two overlapping scans by their segments: S-ICP (Douillard et al., ICRA 2012).
 *
 * Segments are given (setSourceSegments(), setTargetSegments()) or found by a ground segmentation and a
 * clusterer. The initial guess is that of align(): where navigation puts the source, in the target's frame. A
 * pair that cannot be aligned with confidence is refused: hasConverged() is false, getRefusal() says why, and
 * the final transformation is the guess. Nothing but a setter throws: data that do not let it work are a
 * refusal, too, and getError() then says why.
 *
 * setIndices() chooses points of the source; the target is taken whole. The target is described once and kept
 * for the next sources, until setInputTarget() or a setter that concerns it is called: call one of them after
 * the cloud, or a segmentation that was set, has been changed in place.
 *
 * The convergence criteria and the correspondences of `pcl::Registration` have no influence. No tree is built
 * over the target unless getFitnessScore() asks for one.
 */
template <typename PointSource, typename PointTarget>
class SegmentICP : public pcl::Registration<PointSource, PointTarget> {
 public:
  using Base = pcl::Registration<PointSource, PointTarget>;
  using Matrix4 = typename Base::Matrix4;
  using PointCloudSource = typename Base::PointCloudSource;
  using Ptr = pcl::shared_ptr<SegmentICP<PointSource, PointTarget>>;
  using ConstPtr = pcl::shared_ptr<const SegmentICP<PointSource, PointTarget>>;
  using PointCloudTargetConstPtr = typename Base::PointCloudTargetConstPtr;
  using Clusters = std::vector<pcl::PointIndices>;

  /// Finds the clusters of the object points of a cloud.
  template <typename PointT>
  using Clusterer = typename ScanDescriber<PointT>::Clusterer;

  SegmentICP();

  void setInputTarget(const PointCloudTargetConstPtr& cloud) override;

  /// Clusters of object points of the source, as indices into it; an empty list lets them be found again.
  void setSourceSegments(const Clusters& segments) { source_describer_.setClusters(segments); }
  const Clusters& getSourceSegments() const { return source_describer_.getClusters(); }
  /// Clusters of object points of the target; an empty list lets them be found again.
  void setTargetSegments(const Clusters& segments);
  const Clusters& getTargetSegments() const { return target_describer_.getClusters(); }

  /// What finds the objects where no segments are given; FFTGroundSegmentation with its defaults if not set.
  void setGroundSegmentation(const typename GroundSegmentation<PointSource>::Ptr& source,
                             const typename GroundSegmentation<PointTarget>::Ptr& target);

  /// What clusters the objects where no segments are given; voxel contact if not set.
  void setClusterer(const Clusterer<PointSource>& source, const Clusterer<PointTarget>& target);

  /// All settings of the alignment at once. Setters throw `pcl::PCLException` on values out of range.
  void setAlignmentParameters(const core::AlignmentParameters& parameters);
  const core::AlignmentParameters& getAlignmentParameters() const { return parameters_; }

  /// How far off the initial guess may be; sets the gates that belong to it.
  void setSearchMode(core::SearchMode mode) { parameters_.gates = core::gatesOf(mode); }
  /// Limits of the correction of the initial guess.
  void setGates(const core::SearchGates& gates);
  const core::SearchGates& getGates() const { return parameters_.gates; }

  /// N_seg: fewer matched segments give no alignment, at least 1. Default 3.
  void setMinMatches(std::size_t matches);
  std::size_t getMinMatches() const { return parameters_.min_matches; }

  /// Least share of the object points seen by both scans that must agree, 0 to 1; for the dense fallback
  /// three quarters of it, of what the surfaces tell that both could see. Default 0.8.
  void setMinScore(double score);
  double getMinScore() const { return parameters_.min_score; }

  /// Precision asked for [m], above 0: what is predicted to be worse, or leaves more than this between the
  /// surfaces of segments, is refused. If it is not set, 0.05, or 0.12 of the side of a voxel if that is
  /// more.
  void setMaxSigma(double sigma);
  /// 0 if it was not set.
  double getMaxSigma() const { return parameters_.max_sigma.value_or(0); }

  /// What is done where the segments do not suffice. Default: ICP of all surfaces.
  void setFallback(core::Fallback fallback) { parameters_.fallback = fallback; }
  core::Fallback getFallback() const { return parameters_.fallback; }

  /// Which version of the matching; PLAIN is S-ICP at its plainest.
  void setMatching(core::Matching matching) { parameters_.matching = matching; }
  core::Matching getMatching() const { return parameters_.matching; }

  /// Which clusters become segments.
  void setSegmentParameters(const core::SegmentParameters& parameters);
  const core::SegmentParameters& getSegmentParameters() const {
    return source_describer_.getSegmentParameters();
  }

  /// How neighbours are searched; the default is core::columnNeighbours.
  void setNeighbourSearch(const core::NearestNeighboursFactory& factory) { parameters_.neighbours = factory; }

  /// Direction of positive elevation in both frames, any finite length above 0. Default +z.
  void setUpDirection(const Eigen::Vector3d& up);
  Eigen::Vector3d getUpDirection() const { return source_describer_.getUpDirection(); }

  /// Where the sensors stood, each in the frame of its cloud [m]; nothing: what ScanDescriber says of it.
  void setSensorPosition(const std::optional<Eigen::Vector3d>& source,
                         const std::optional<Eigen::Vector3d>& target);
  const std::optional<Eigen::Vector3d>& getSourceSensorPosition() const {
    return source_describer_.getSensorPosition();
  }
  const std::optional<Eigen::Vector3d>& getTargetSensorPosition() const {
    return target_describer_.getSensorPosition();
  }

  /** How many threads share the work: 0 is one for each core. Default 1: that which calls, or those that it
   * gives by a core::Threads. The results are the same for every number.
   */
  void setNumberOfThreads(unsigned threads) { number_of_threads_ = threads; }
  unsigned getNumberOfThreads() const { return number_of_threads_; }

  /** Aligns in double precision and moves no points: align() but for the rounding of its floats.
   * \param target_from_source the initial guess, a rigid motion
   * \return what getAlignment() returns from then on
   */
  const core::Alignment& computeAlignment(const Eigen::Isometry3d& target_from_source);

  /// All that the last pair came to, source moving and target reference, in the frames of the clouds.
  const core::Alignment& getAlignment() const { return alignment_; }
  /// Why the last pair was refused; empty if it was not.
  const std::string& getRefusal() const { return alignment_.refusal; }
  /// What kept the last source from being worked on; empty if nothing did.
  const std::string& getSourceError() const { return source_describer_.getError(); }
  /// What kept the last target from being worked on; empty if nothing did.
  const std::string& getTargetError() const { return target_describer_.getError(); }
  /// What the last transform comes from.
  core::AlignmentMethod getMethod() const { return alignment_.method; }
  /// Matched segments (moving: source, reference: target), as indices into the segments of getSourceScan()
  /// and getTargetScan().
  const std::vector<core::SegmentMatch>& getMatches() const { return alignment_.matches; }
  /// The last source as it was aligned, in a frame whose z axis is up.
  const core::ScanSegments& getSourceScan() const { return source_scan_; }
  /// The last target, likewise; no segments before the first pair.
  const core::ScanSegments& getTargetScan() const { return target_scan_; }
  /// Share of the object points seen by both scans that agree, 0 to 1.
  double getScore() const { return alignment_.score; }
  /// Covariance of (translation [m], rotation vector [rad]) of a small motion after the transform, in the
  /// target's frame.
  const core::Matrix6d& getCovariance() const { return alignment_.covariance; }

 protected:
  void computeTransformation(PointCloudSource& output, const Matrix4& guess) override;

 private:
  using Base::converged_;
  using Base::fake_indices_;
  using Base::final_transformation_;
  using Base::indices_;
  using Base::input_;
  using Base::reg_name_;
  using Base::target_;
  using Base::transformation_;

  void forgetTarget() { target_voxel_size_.reset(); }
  std::string describeScans();
  void alignFrom(const Eigen::Isometry3d& guess);

  core::AlignmentParameters parameters_;
  unsigned number_of_threads_ = 1;
  ScanDescriber<PointSource> source_describer_;
  ScanDescriber<PointTarget> target_describer_;
  core::ScanSegments source_scan_;
  core::ScanSegments target_scan_;
  std::optional<double>
      target_voxel_size_;  ///< asked for when the target was described; none: it was not yet
  core::Alignment alignment_;
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/segment_icp.hpp>
#endif
