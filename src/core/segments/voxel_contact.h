#pragma once

#include <vector>

#include "pcl_fft_ground/core/scan/points.h"
#include "segments/voxel_set.h"

namespace pcl_fft_ground::core {

/// Which voxels points occupy, and which of these hang together (26 neighbours).
struct VoxelContact {
  VoxelSet occupied;
  std::vector<VoxelIndex> voxel_of_point;
  std::vector<VoxelIndex> root_of_voxel;  ///< the lowest number among the voxels of the same cluster
};

/// \param points finite points \param leaf_size side of a voxel [m], > 0
VoxelContact contactOf(const PointsView& points, double leaf_size);

}  // namespace pcl_fft_ground::core
