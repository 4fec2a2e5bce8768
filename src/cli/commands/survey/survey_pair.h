#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/survey/pose_graph.h"

namespace pcl_fft_ground::cli {

/// The name under which dense point-to-plane ICP of whole clouds stands among the methods.
constexpr const char* DENSE_ICP = "dense-icp";

/// What is appended to the name of a method where dense ICP of the overlap steps in for missing segments.
constexpr const char* WITH_FALLBACK = "+dense";

/// The method that segments for this one: without WITH_FALLBACK.
std::string segmenterOf(const std::string& method);

/// Share of the smaller of two sub-maps that both cover, from which on they overlap.
constexpr double LEAST_OVERLAP = 0.1;

/// What became of a pair.
enum class PairStatus {
  ALIGNED,
  REFUSED,      ///< not computed, or computed and rejected
  UNPROCESSED,  ///< a sub-map without segments
};

/// Which list a pair is from.
enum class PairKind {
  CHAIN,  ///< by the paper's rule: what Table II counts
  OTHER   ///< any other two that overlap
};

/// One method on one pair of sub-maps: a line of pairs.csv.
struct PairResult {
  std::string method;
  PairKind kind = PairKind::CHAIN;
  std::size_t reference = 0;  ///< index of the sub-map
  std::size_t moving = 0;     ///< index of the sub-map
  PairStatus status = PairStatus::UNPROCESSED;
  std::string refusal;      ///< why it was not aligned
  std::size_t matches = 0;  ///< matched segments
  double score = 0;         ///< share of object points that agree
  double overlap = 0;       ///< share of the smaller sub-map, by truth if that is known, else by navigation
  std::size_t nx_before = 0;
  std::size_t nx_after = 0;                ///< nx_before if not aligned
  std::optional<double> crispness_before;  ///< of the overlap only
  std::optional<double> crispness_after;
  std::optional<double> translation_error;  ///< of the moving sub-map's centroid [m], if the truth is known
  std::optional<double> rotation_error;     ///< [degrees]
  double seconds = 0;                       ///< of the alignment after segmentation
  /// Of the points less their sub-maps' origins; the guess if not aligned.
  Eigen::Isometry3d reference_from_moving = Eigen::Isometry3d::Identity();
  core::MotionCovariance covariance = core::MotionCovariance::Zero();  ///< of the above, if aligned

  /// delta Nx of Sec. V-D2 [%]; 0 if not aligned
  double crispnessChange() const;
  bool isOverlapping() const;
};

/// The results as CSV, sub-maps by their names.
std::string asCsv(const std::vector<PairResult>& results, const std::vector<std::string>& names);

/** Reads what asCsv() wrote; an empty file holds no results.
 *
 * \throws WorkError naming the file, if it cannot be read or is no such table
 */
std::vector<PairResult> readPairs(const std::string& path, const std::vector<std::string>& names);

}  // namespace pcl_fft_ground::cli
