#pragma once

#include <vector>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/** Finds the points that lie so far from all others that they cannot belong to the scan.
 *
 * Let L be the longest side of the axis-aligned box that holds the points when one in 2000 (and at least one)
 * is cut off at either end of each axis. A point is far if it lies more than 3 L outside of that box along
 * some axis. The scan proper is then bounded by 7 L, whatever the far points are: one stray return, a
 * thousand kilometres away, must not stretch the elevation grid. Clouds of fewer than 8 points have no far
 * points.
 *
 * \param points points of a scan in any frame
 * \param statistics summarise() of these points: they tell nearly every scan to be compact without another
 * look
 * \return ascending column numbers of the far points; empty for nearly every scan
 * \note O(n), and O(1) for compact scans. The result depends on the set of the points only, not on their
 * order.
 */
PCL_FFT_GROUND_CORE_EXPORT std::vector<Eigen::Index> findFarPoints(const PointsView& points,
                                                                   const PointStatistics& statistics);

/// Where the points of a scan may lie that are not far from all others, in their frame [m]; without bounds
/// for fewer than 8 points.
PCL_FFT_GROUND_CORE_EXPORT Bounds reachOfScan(const PointsView& points);

}  // namespace pcl_fft_ground::core
