#pragma once

#include <cmath>

#include "pcl_fft_ground/core/ground/column_ground.h"
#include "pcl_fft_ground/grid_ground_segmentation.h"
#include "pcl_fft_ground/impl/ground_segmentation.hpp"

namespace pcl_fft_ground {

template <typename PointT>
GridGroundSegmentation<PointT>::GridGroundSegmentation(bool extract_removed_indices)
    : GroundSegmentation<PointT>("GridGroundSegmentation", {{}, UpEstimation::GIVEN, Yaw::NONE, {}},
                                 extract_removed_indices) {}

template <typename PointT>
void GridGroundSegmentation<PointT>::setCellSize(double cell_size) {
  this->requireLength("cell size", cell_size);
  cell_size_ = cell_size;
}

template <typename PointT>
void GridGroundSegmentation<PointT>::setVoxelHeight(double voxel_height) {
  this->requireLength("voxel height", voxel_height);
  voxel_height_ = voxel_height;
}

template <typename PointT>
core::Labels GridGroundSegmentation<PointT>::labelPoints(const core::Points& points,
                                                         const Eigen::Isometry3d& frame_from_input) {
  surface_ = core::GroundSurface();
  surface_ = core::bottomVoxelSurface(points, frame_from_input, cell_size_, voxel_height_);
  return core::labelByColumn(points, surface_, this->getHeightTolerance());
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_GridGroundSegmentation(T) \
  template class PCL_FFT_GROUND_FILTERS_EXPORT pcl_fft_ground::GridGroundSegmentation<T>;
