#pragma once

#include <cstdint>
#include <vector>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/** Clusters points by voxel contact (Sec. IV-C): voxels that touch, be it at a corner, belong together.
 *
 * Voxel (i, j, k) covers [i, i + 1) x [j, j + 1) x [k, k + 1) leaf sizes of the input frame, so the voxels do
 * not depend on the other points.
 *
 * \param points finite points
 * \param leaf_size side of a voxel [m], > 0
 * \return clusters of column numbers, ascending within a cluster; larger clusters first, equal ones by their
 * first point
 * \note O(n) expected time; memory grows with the number of occupied voxels, not with the volume
 */
PCL_FFT_GROUND_CORE_EXPORT std::vector<std::vector<Eigen::Index>> voxelClusters(const PointsView& points,
                                                                                double leaf_size);

}  // namespace pcl_fft_ground::core
