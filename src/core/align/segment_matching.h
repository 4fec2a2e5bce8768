#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "align/scan_pair.h"

namespace pcl_fft_ground::core {

/// How one segment comes to lie on another.
struct LocalAlignment {
  Eigen::Isometry3d correction = Eigen::Isometry3d::Identity();  ///< of the initial guess: yaw and shift
  double shape_distance = 0;                                     ///< mean distance between the two [m]
  double covered = 0;  ///< share of the points that the other scan has seen, the lower of both, [0, 1]
};

/** ICP of two segments by themselves: yaw and shift, both ways, only where the other scan has looked.
 * \param start correction to begin with
 * \param max_distance largest mean distance of segments that are alike [m]
 * \return nothing if they are not alike or too little of either has been seen by the other scan
 */
std::optional<LocalAlignment> alignLocally(const ScanPair& pair, const PlacedSegment& moving,
                                           const PlacedSegment& reference, const Eigen::Isometry3d& start,
                                           double max_distance);

/// Which vertices of an undirected graph are joined; symmetric, nothing is joined to itself.
using Adjacency = std::vector<std::vector<bool>>;

/** Vertices that are all joined to each other and weigh most together, ascending.
 *
 * Branch and bound with a greedy colouring as the bound. After a great many branches the best clique so far
 * is returned; it is the same at every call.
 *
 * \param weights one per vertex, > 0
 */
std::vector<std::size_t> heaviestClique(const std::vector<double>& weights, const Adjacency& joined);

/// Two segments that may be the same, and where that would bring the one.
struct CandidateMatch {
  SegmentMatch segments;
  Eigen::Vector3d from;          ///< a place in the moving segment, as the initial guess has it [m]
  Eigen::Vector3d to;            ///< the same place on the reference segment [m]
  Eigen::Isometry3d correction;  ///< of the initial guess, if this match were all there is
  double weight = 0;             ///< how much the match counts, > 0
};

/// Pairs of segments that are near enough and of like shape: each by itself, whatever the others say.
std::vector<CandidateMatch> findCandidates(const ScanPair& pair);

/** Matches that can all be true at once, heaviest set first; disjoint.
 *
 * Plain ones hold N_seg matches at least. Others may hold fewer, as segments that one scan has in pieces do
 * not match by themselves: they are found when the rest has been aligned, and counted then.
 */
std::vector<std::vector<CandidateMatch>> findHypotheses(std::vector<CandidateMatch> candidates,
                                                        const AlignmentParameters& parameters,
                                                        double voxel_size);

/// Rivals of a pose are looked for as far off as navigation may err, times this: its errors have tails.
constexpr double RIVALS_BEYOND = 1.5;

/** Where else a pose puts segments on segments, whatever these look like: every place at which a pattern
 * repeats itself, at the same heading, is one of these.
 *
 * \param centre of what moves, as the pose has it; a place is left out if it takes that farther from where
 * the initial guess has it than navigation allows \return corrections of the initial guess, each the pose and
 * a shift of three voxels at least, at most so many, the one with the most segments on each other first
 */
std::vector<Eigen::Isometry3d> placesElsewhere(const ScanPair& pair, const Eigen::Isometry3d& pose,
                                               const Eigen::Vector3d& centre, std::size_t most);

/// Correction of the initial guess (yaw and shift) that the matches ask for.
Eigen::Isometry3d fitMatches(const std::vector<CandidateMatch>& matches);

/** Segments that lie on each other, many to many: half of what the other scan has seen of either is near the
 * other.
 *
 * Mends what one scan has in one piece and the other in two.
 */
std::vector<SegmentMatch> associateSegments(const ScanPair& pair, const Eigen::Isometry3d& correction);

}  // namespace pcl_fft_ground::core
