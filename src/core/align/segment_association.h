#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "align/scan_pair.h"

namespace pcl_fft_ground::core {

/** Segments that lie on each other, many to many: half of what the other scan has seen of either is near the
 * other.
 *
 * Mends what one scan has in one piece and the other in two.
 */
std::vector<SegmentMatch> associateSegments(const ScanPair& pair, const Eigen::Isometry3d& correction);

}  // namespace pcl_fft_ground::core
