#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/align/nearest_neighbours.h"
#include "pcl_fft_ground/core/align/rigid_fit.h"
#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/segments/segment.h"

namespace pcl_fft_ground::core {

/// How far off the initial guess may be.
enum class SearchMode {
  NAVIGATION,  ///< by decimetres and a few degrees: 0.6 m, 8 degrees
  WIDE,        ///< by metres: 2.5 m, 25 degrees
};

/// Which version of the matching.
enum class Matching {
  LOCAL,  ///< segments are aligned with each other one by one, then matched; the result is gated
  PLAIN,  ///< centroids and sizes, point-to-point, no gate but the number of matches: S-ICP at its plainest
};

/// What is done where the segments do not suffice.
enum class Fallback {
  NONE,   ///< the pair is refused
  DENSE,  ///< ICP of all surfaces, from the guess and from around it, judged by what both scans could see
};

/// Whether the relief of the ground is asked where segments, and their fallback, do not decide.
enum class ReliefUse {
  AUTO,  ///< alignRelief(), by the same gates, of scans with objects on at most a tenth of their voxels
  OFF,   ///< it is not
};

/// Limits of the correction of the initial guess.
struct SearchGates {
  double max_shift = 0.6;   ///< horizontally [m], > 0
  double max_rise = 0.3;    ///< vertically [m], > 0
  double max_turn = 8;      ///< about the vertical [degrees], in (0, 180]
  double max_tilt = 4;      ///< of the vertical [degrees], > 0
  unsigned hypotheses = 2;  ///< disjoint sets of matches that are tried, >= 1
};

/// The gates that belong to a way of searching.
PCL_FFT_GROUND_CORE_EXPORT SearchGates gatesOf(SearchMode mode);

/** Settings of alignScans().
 *
 * What depends on the resolution is given in voxels of the scans (2 cm for dense ones), so that thin scans
 * and large sites need no settings of their own; SearchGates are metres.
 */
struct AlignmentParameters {
  SearchGates gates;                    ///< how far off the initial guess may be
  Matching matching = Matching::LOCAL;  ///< which version
  Fallback fallback = Fallback::DENSE;  ///< what follows where segments do not suffice
  ReliefUse relief = ReliefUse::OFF;    ///< what follows where these do not suffice either
  std::size_t min_matches = 3;          ///< N_seg: fewer matched segments give no alignment, >= 1
  /// Least share of object points that must agree, [0, 1]; three quarters of it of what the surfaces tell,
  /// for the dense fallback.
  double min_score = 0.80;
  /// The precision that is asked for, whatever the resolution [m], > 0: the largest standard deviation
  /// predicted and, by segments, the largest root mean square of the distances left between the surfaces. If
  /// not set, largestSigma() of the scans' voxels. By relief never more than ReliefParameters says.
  std::optional<double> max_sigma;
  NearestNeighboursFactory neighbours = columnNeighbours;  ///< how neighbours are searched
};

/// The precision asked for of scans with voxels of such a size [m]: 5 cm, but no less than thin scans can
/// give.
PCL_FFT_GROUND_CORE_EXPORT double largestSigma(const AlignmentParameters& parameters, double voxel_size);

/// \throws std::invalid_argument naming the parameter, its value and what is allowed, if one is out of range
PCL_FFT_GROUND_CORE_EXPORT void validate(const AlignmentParameters& parameters);

/// A segment of one scan that is the same thing as one of the other.
struct SegmentMatch {
  std::size_t moving = 0;     ///< index into the segments of the moving scan
  std::size_t reference = 0;  ///< index into the segments of the reference

  bool operator==(const SegmentMatch& other) const {
    return moving == other.moving && reference == other.reference;
  }
};

/// How a transform was found.
enum class AlignmentMethod { NONE, SEGMENTS, DENSE, RELIEF };

/// "none", "segments", "dense" or "relief".
PCL_FFT_GROUND_CORE_EXPORT const char* nameOf(AlignmentMethod method);

/** The result for a pair of scans. A refusal is a result, too: the transform then is the initial guess. */
struct Alignment {
  Eigen::Isometry3d reference_from_moving = Eigen::Isometry3d::Identity();  ///< places the moving scan
  bool accepted = false;
  std::string refusal;                             ///< why not accepted; empty if it is
  AlignmentMethod method = AlignmentMethod::NONE;  ///< what the transform comes from
  std::vector<SegmentMatch> matches;               ///< matched segments, many to many
  double score = 0;    ///< share of the object points seen by both scans that agree, [0, 1]
  double overlap = 0;  ///< share of the smaller scan's area that both have seen, [0, 1]
  /** Covariance of (translation [m], rotation vector [rad]) of a small motion applied after the transform,
   * about the origin of the reference; zero if nothing was computed.
   */
  Matrix6d covariance = Matrix6d::Zero();
};

/// Share of the occupied voxels of a scan that objects have, [0, 1].
PCL_FFT_GROUND_CORE_EXPORT double shareOfObjects(const ScanSegments& scan);

/** Aligns two overlapping scans by their segments: S-ICP (Douillard et al., ICRA 2012).
 *
 * Segments that may be the same are aligned one by one; the heaviest set of pairs whose places agree is
 * fitted; ICP with correspondences in matched segments only, point-to-plane at last, makes it precise. What
 * does not pass the gates is refused.
 *
 * \param moving,reference scans whose z axes point roughly up; if their voxels differ the finer is coarsened
 * \param initial_guess reference_from_moving as far as it is known
 * \throws std::invalid_argument if a parameter is out of range or the guess is not finite
 */
PCL_FFT_GROUND_CORE_EXPORT Alignment alignScans(const ScanSegments& moving, const ScanSegments& reference,
                                                const Eigen::Isometry3d& initial_guess,
                                                const AlignmentParameters& parameters = {});

}  // namespace pcl_fft_ground::core
