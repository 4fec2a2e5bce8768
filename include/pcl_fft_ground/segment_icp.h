#pragma once

#include <pcl/PointIndices.h>
#include <pcl/registration/registration.h>

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/align/segment_alignment.h"
#include "pcl_fft_ground/ground_segmentation.h"
#include "pcl_fft_ground/registration_export.h"

namespace pcl_fft_ground {

/** Aligns two overlapping scans by their segments: S-ICP (Douillard et al., ICRA 2012).
 *
 * Segments are given (setSourceSegments(), setTargetSegments()) or found by a ground segmentation and a
 * clusterer. The initial guess is that of align(): where navigation puts the source, in the target's frame. A
 * pair that cannot be aligned with confidence is refused: hasConverged() is false, getRefusal() says why, and
 * the final transformation is the guess.
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
  using Clusters = std::vector<pcl::PointIndices>;

  /// Finds the clusters of the object points of a cloud.
  template <typename PointT>
  using Clusterer = std::function<Clusters(const typename pcl::PointCloud<PointT>::ConstPtr& cloud,
                                           const pcl::IndicesConstPtr& objects)>;

  SegmentICP();

  /// Clusters of object points of the source; an empty list lets them be found again.
  void setSourceSegments(const Clusters& segments) { source_segments_ = segments; }
  /// Clusters of object points of the target; an empty list lets them be found again.
  void setTargetSegments(const Clusters& segments) { target_segments_ = segments; }

  /// What finds the objects where no segments are given; FFTGroundSegmentation with its defaults if not set.
  void setGroundSegmentation(const typename GroundSegmentation<PointSource>::Ptr& source,
                             const typename GroundSegmentation<PointTarget>::Ptr& target) {
    source_ground_ = source;
    target_ground_ = target;
  }

  /// What clusters the objects where no segments are given; voxel contact if not set.
  void setClusterer(const Clusterer<PointSource>& source, const Clusterer<PointTarget>& target) {
    source_clusterer_ = source;
    target_clusterer_ = target;
  }

  /// How far off the initial guess may be; sets the gates that belong to it.
  void setSearchMode(core::SearchMode mode) { parameters_.gates = core::gatesOf(mode); }
  /// Limits of the correction of the initial guess.
  void setGates(const core::SearchGates& gates) { parameters_.gates = gates; }
  const core::SearchGates& getGates() const { return parameters_.gates; }

  /// N_seg: fewer matched segments give no alignment, at least 1. Default 3.
  void setMinMatches(std::size_t matches);
  std::size_t getMinMatches() const { return parameters_.min_matches; }

  /// Least share of the object points seen by both scans that must agree, 0 to 1; three quarters of it
  /// do for the dense fallback. Default 0.8.
  void setMinScore(double score);
  double getMinScore() const { return parameters_.min_score; }

  /// Precision asked for [m], above 0: what is predicted to be worse horizontally, or leaves more than this
  /// between the surfaces, is refused. Default 0.05.
  void setMaxSigma(double sigma);
  double getMaxSigma() const { return parameters_.max_sigma; }

  /// What is done where the segments do not suffice. Default: dense ICP over the overlap.
  void setFallback(core::Fallback fallback) { parameters_.fallback = fallback; }
  core::Fallback getFallback() const { return parameters_.fallback; }

  /// Which version of the matching; PLAIN is S-ICP at its plainest.
  void setMatching(core::Matching matching) { parameters_.matching = matching; }
  core::Matching getMatching() const { return parameters_.matching; }

  /// Which clusters become segments.
  void setSegmentParameters(const core::SegmentParameters& parameters) { segment_parameters_ = parameters; }
  const core::SegmentParameters& getSegmentParameters() const { return segment_parameters_; }

  /// How neighbours are searched; the default is core::columnNeighbours.
  void setNeighbourSearch(const core::NearestNeighboursFactory& factory) { parameters_.neighbours = factory; }

  /// Direction of positive elevation in both frames, any finite length above 0. Default +z.
  void setUpDirection(const Eigen::Vector3d& up);
  Eigen::Vector3d getUpDirection() const { return up_direction_; }

  /// Why the last pair was refused; empty if it was not.
  const std::string& getRefusal() const { return alignment_.refusal; }
  /// What the last transform comes from.
  core::AlignmentMethod getMethod() const { return alignment_.method; }
  /// Matched segments (moving: source, reference: target), as indices into getSourceSegments() and
  /// getTargetSegments().
  const std::vector<core::SegmentMatch>& getMatches() const { return alignment_.matches; }
  /// Segments of the last source, in a frame whose z axis is up.
  const std::vector<core::Segment>& getSourceSegments() const { return source_scan_.segments; }
  /// Segments of the last target, in a frame whose z axis is up.
  const std::vector<core::Segment>& getTargetSegments() const { return target_scan_.segments; }
  /// Share of the object points seen by both scans that agree, 0 to 1.
  double getScore() const { return alignment_.score; }
  /// Covariance of (translation [m], rotation vector [rad]) of a small motion after the transform, in the
  /// target's frame.
  const Eigen::Matrix<double, 6, 6>& getCovariance() const { return alignment_.covariance; }

 protected:
  void computeTransformation(PointCloudSource& output, const Matrix4& guess) override;

 private:
  using Base::converged_;
  using Base::final_transformation_;
  using Base::indices_;
  using Base::input_;
  using Base::reg_name_;
  using Base::target_;
  using Base::transformation_;

  void describe(const Eigen::Matrix3d& level_from_input);

  core::AlignmentParameters parameters_;
  core::SegmentParameters segment_parameters_;
  Eigen::Vector3d up_direction_ = Eigen::Vector3d::UnitZ();
  Clusters source_segments_;
  Clusters target_segments_;
  typename GroundSegmentation<PointSource>::Ptr source_ground_;
  typename GroundSegmentation<PointTarget>::Ptr target_ground_;
  Clusterer<PointSource> source_clusterer_;
  Clusterer<PointTarget> target_clusterer_;
  core::ScanSegments source_scan_;
  core::ScanSegments target_scan_;
  core::Alignment alignment_;
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/segment_icp.hpp>
#endif
