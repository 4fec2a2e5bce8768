#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/grid/scan_coverage.h"

namespace pcl_fft_ground::core {

/// Two sub-maps of a survey that are to be aligned.
struct SubmapPair {
  std::size_t reference = 0;  ///< index of the sub-map that stays
  std::size_t moving = 0;     ///< index of the sub-map that is moved on to it
};

/** Pairs of neighbours by the paper's rule (Sec. V-D).
 *
 * From the first sub-map on, each is paired with the nearest one not yet in a pair, which is then the next to
 * be paired. The last one has none left; as Table II counts as many pairs as sub-maps, it is paired with the
 * nearest of all but its predecessor. Of equally near sub-maps the first is taken.
 *
 * \param centroids centroid of each sub-map [m], in one frame
 * \return as many pairs as sub-maps, along the chain; a single one for two sub-maps, none for fewer
 */
PCL_FFT_GROUND_CORE_EXPORT std::vector<SubmapPair> chainPairs(const std::vector<Eigen::Vector3d>& centroids);

/// False for scans that are too far apart to overlap, seen from above: cheaper to tell than by how much they
/// do.
PCL_FFT_GROUND_CORE_EXPORT bool mayOverlap(const ScanCoverage& a, const Eigen::Isometry3d& world_from_a,
                                           const ScanCoverage& b, const Eigen::Isometry3d& world_from_b);

/** All pairs of sub-maps that overlap, but those that are listed already, whichever way round.
 * \param coverages what each sub-map covers, in its own frame
 * \param world_from_submap poses of the sub-maps; as many
 * \param least least overlapShare(), in (0, 1]
 * \throws std::invalid_argument if the numbers of coverages and poses differ
 */
PCL_FFT_GROUND_CORE_EXPORT std::vector<SubmapPair> otherOverlappingPairs(
    const std::vector<ScanCoverage>& coverages, const std::vector<Eigen::Isometry3d>& world_from_submap,
    const std::vector<SubmapPair>& listed, double least);

}  // namespace pcl_fft_ground::core
