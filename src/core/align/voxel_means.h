#pragma once

#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// The mean of the points in each occupied voxel, in the order of the voxels' first points.
/// \param voxel_size side of a voxel [m], > 0; the voxels are counted from the origin
Points voxelMeans(const PointsView& points, double voxel_size);

}  // namespace pcl_fft_ground::core
