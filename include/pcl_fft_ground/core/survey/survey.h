#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/align/dense_alignment.h"
#include "pcl_fft_ground/core/align/segment_alignment.h"
#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/scan/points.h"
#include "pcl_fft_ground/core/survey/pairing.h"
#include "pcl_fft_ground/core/survey/pose_graph.h"

namespace pcl_fft_ground::core {

/// How well navigation knows the pose of a scan: standard deviations, each finite and above 0.
struct NavigationSigmas {
  double horizontal = 0.1;  ///< of its place along x and y [m]
  double heading = 2.0;     ///< of its turn about the vertical [degrees]
  double vertical = 0.05;   ///< of its height [m], which pressure tells
  double tilt = 0.5;        ///< of its vertical [degrees], which gravity tells
};

/// A scan of a survey, without its points. \f$ z \f$ is up in its own frame and in the world's.
struct SurveyScan {
  Eigen::Isometry3d world_from_scan = Eigen::Isometry3d::Identity();  ///< its pose by navigation
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();                 ///< of its points, in its own frame [m]
  ScanCoverage coverage;                                              ///< in its own frame
  NavigationSigmas sigmas;                                            ///< how far the pose is trusted
};

/// \throws std::invalid_argument naming the one that is no finite number above 0
PCL_FFT_GROUND_CORE_EXPORT void validate(const NavigationSigmas& sigmas);

/// What a survey has to know of a scan with at least one point.
/// \throws std::length_error if the points are spread too widely
PCL_FFT_GROUND_CORE_EXPORT SurveyScan surveyScan(const PointsView& points,
                                                 const Eigen::Isometry3d& world_from_scan,
                                                 const NavigationSigmas& sigmas = {});

/// Which list a pair is from.
enum class PairKind {
  CHAIN,  ///< by the paper's rule, chainPairs(): what Table II counts
  OTHER,  ///< any other two that overlap
};

/// Two scans of a survey that are to be aligned.
struct PlannedPair {
  SubmapPair scans;
  PairKind kind = PairKind::CHAIN;
};

/// Share of the smaller of two scans' areas that both cover, from which on they overlap.
constexpr double LEAST_OVERLAP = 0.1;

/// The pairs of a survey as navigation has it: the chain, then all others that overlap.
PCL_FFT_GROUND_CORE_EXPORT std::vector<PlannedPair> planPairs(const std::vector<SurveyScan>& scans);

/// What became of a pair.
enum class PairStatus {
  ALIGNED,
  REFUSED,      ///< not computed, or computed and rejected
  UNPROCESSED,  ///< a scan without segments
  NOT_RUN,      ///< the method cannot work on one of the scans
};

/// One method on one pair of scans.
struct PairResult {
  std::string method;  ///< any name: results are told apart by it
  PairKind kind = PairKind::CHAIN;
  std::size_t reference = 0;  ///< index of the scan
  std::size_t moving = 0;     ///< index of the scan
  PairStatus status = PairStatus::UNPROCESSED;
  std::string refusal;        ///< why it was not aligned
  std::size_t matches = 0;    ///< matched segments
  double score = 0;           ///< share of object points that agree, [0, 1]
  double overlap = 0;         ///< share of the smaller scan, by the truth if known, else by navigation
  std::size_t nx_before = 0;  ///< occupiedVoxels() as navigation has the pair
  std::size_t nx_after = 0;   ///< after the alignment; nx_before if not aligned
  std::optional<double> crispness_before;   ///< overlapCrispness() of the same
  std::optional<double> crispness_after;    ///< likewise
  std::optional<double> translation_error;  ///< of the moving scan's centroid [m], if the truth is known
  std::optional<double> rotation_error;     ///< [degrees]
  double seconds = 0;                       ///< of the alignment after segmentation
  Eigen::Isometry3d reference_from_moving = Eigen::Isometry3d::Identity();  ///< the guess if not aligned
  MotionCovariance covariance = MotionCovariance::Zero();                   ///< of the above, if aligned

  /// delta Nx of Sec. V-D2 [%]; 0 if not aligned
  PCL_FFT_GROUND_CORE_EXPORT double crispnessChange() const;
  bool isOverlapping() const { return overlap >= LEAST_OVERLAP; }
};

/// How the scans of a pair are brought on to each other.
enum class PairAlignment {
  SEGMENTS,  ///< alignScans(), with the fallback that its parameters name
  DENSE,     ///< alignDensely() of all points: what the paper warns of
};

/// Where navigation has the moving scan of a pair, in the frame of the reference.
PCL_FFT_GROUND_CORE_EXPORT Eigen::Isometry3d guessOf(const SubmapPair& pair,
                                                     const std::vector<SurveyScan>& scans);

/** Aligns a pair from a guess. The result has no method, no crispness and no errors yet.
 * \param moving,reference descriptions of the two scans
 * \param guess reference_from_moving
 * \throws std::invalid_argument as alignScans()
 */
PCL_FFT_GROUND_CORE_EXPORT PairResult alignPair(const PlannedPair& pair, const std::vector<SurveyScan>& scans,
                                                const ScanSegments& moving, const ScanSegments& reference,
                                                const Eigen::Isometry3d& guess,
                                                const AlignmentParameters& parameters,
                                                PairAlignment how = PairAlignment::SEGMENTS);

/// The result for a pair on which a method cannot work: the guess, and why.
PCL_FFT_GROUND_CORE_EXPORT PairResult notRun(const PlannedPair& pair, const std::vector<SurveyScan>& scans,
                                             const std::string& reason);

/// The result with its crispness before and after, measured on the points of the two scans.
PCL_FFT_GROUND_CORE_EXPORT PairResult withCrispness(PairResult result, const Eigen::Isometry3d& guess,
                                                    const PointsView& moving, const PointsView& reference);

/// The result with its overlap and its errors by true poses, one per scan.
PCL_FFT_GROUND_CORE_EXPORT PairResult withErrors(PairResult result, const std::vector<SurveyScan>& scans,
                                                 const std::vector<Eigen::Isometry3d>& world_from_scan);

/// Poses of all scans of a survey, found in different ways.
struct SurveyPoses {
  std::vector<Eigen::Isometry3d> navigation;
  std::vector<Eigen::Isometry3d> chained;  ///< one pair of the chain after the other
  std::vector<Eigen::Isometry3d> global;   ///< all pairs and the navigation as one
  std::size_t edges = 0;                   ///< aligned pairs that the global poses rest on
  /// Of these, such as contradict the others: false. By consistentEdges(), or counting less than a quarter.
  std::size_t rejected_edges = 0;
};

/** Poses from the aligned pairs of one method: a pose graph of these and of the navigation.
 * \param results those of all methods; refused pairs have no say
 * \param method the one whose pairs are used
 * \throws std::invalid_argument,std::runtime_error as solvePoseGraph()
 */
PCL_FFT_GROUND_CORE_EXPORT SurveyPoses solveSurvey(const std::vector<SurveyScan>& scans,
                                                   const std::vector<PairResult>& results,
                                                   const std::string& method);

/** The pairs that a newcomer makes with scans before it that it overlaps: the widest overlap first, which is
 * the pair of the chain, and no more than a few of them, so that a newcomer to a large survey is no more
 * work. \param poses where the scans are taken to be, one for each
 */
PCL_FFT_GROUND_CORE_EXPORT std::vector<PlannedPair> pairsOfNewcomer(
    std::size_t newcomer, const std::vector<SurveyScan>& scans, const std::vector<Eigen::Isometry3d>& poses);

/// Poses after a newcomer has come.
struct RefinedPoses {
  std::vector<Eigen::Isometry3d> poses;  ///< one for each scan
  bool contradicted = false;  ///< an edge of the newcomer does not fit what stayed: solve for all poses
};

/** Refines the poses around a newcomer: those of the scans two edges from it or nearer are solved for by a
 * pose graph; the others stay. \param results of the pairs aligned so far, those of the newcomer among them,
 * all of one method \param poses where the scans are taken to be, one for each \throws
 * std::invalid_argument,std::runtime_error as solvePoseGraph()
 */
PCL_FFT_GROUND_CORE_EXPORT RefinedPoses refineAround(std::size_t newcomer,
                                                     const std::vector<SurveyScan>& scans,
                                                     const std::vector<PairResult>& results,
                                                     const std::vector<Eigen::Isometry3d>& poses);

/// How far poses are from the truth, once they are laid on it as a whole.
struct PoseErrors {
  std::size_t scans = 0;
  double rms_translation = 0;  ///< root mean square over the middles of the scans [m]
  double max_translation = 0;  ///< [m]
  double median_rotation = 0;  ///< [degrees]
};

/// The errors of poses of at least one scan. \param truth,poses one per scan
PCL_FFT_GROUND_CORE_EXPORT PoseErrors poseErrors(const std::vector<SurveyScan>& scans,
                                                 const std::vector<Eigen::Isometry3d>& truth,
                                                 const std::vector<Eigen::Isometry3d>& poses);

/// Those of several surveys together: the root mean square over all scans, the largest, and the median of the
/// surveys' medians. \param errors one or more
PCL_FFT_GROUND_CORE_EXPORT PoseErrors pooled(const std::vector<PoseErrors>& errors);

}  // namespace pcl_fft_ground::core
