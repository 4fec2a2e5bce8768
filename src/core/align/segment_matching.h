#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "align/scan_pair.h"

namespace pcl_fft_ground::core {

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

/// Correction of the initial guess (yaw and shift) that the matches ask for.
Eigen::Isometry3d fitMatches(const std::vector<CandidateMatch>& matches);

}  // namespace pcl_fft_ground::core
