#pragma once

#include <cmath>

#include "pcl_fft_ground/graph_cut_ground_segmentation.h"
#include "pcl_fft_ground/impl/ground_segmentation.hpp"

namespace pcl_fft_ground {

template <typename PointT>
GraphCutGroundSegmentation<PointT>::GraphCutGroundSegmentation(bool extract_removed_indices)
    : GroundSegmentation<PointT>("GraphCutGroundSegmentation", core::FrameParameters(),
                                 extract_removed_indices) {
  this->setDefaultUpEstimation(UpEstimation::AUTO);
  this->setHeightTolerance(0.02);
}

template <typename PointT>
void GraphCutGroundSegmentation<PointT>::setCellSize(double cell_size) {
  this->requireLength("cell size", cell_size);
  parameters_.cell_size = cell_size;
}

template <typename PointT>
void GraphCutGroundSegmentation<PointT>::setMaximumObjectSize(double size) {
  this->requireLength("maximum object size", size);
  parameters_.max_object_size = size;
}

template <typename PointT>
void GraphCutGroundSegmentation<PointT>::setObjectHeight(double height) {
  this->requireLength("object height", height);
  parameters_.object_height = height;
}

template <typename PointT>
void GraphCutGroundSegmentation<PointT>::setStepHeight(double height) {
  this->requireLength("step height", height);
  parameters_.step_height = height;
}

template <typename PointT>
void GraphCutGroundSegmentation<PointT>::setSmoothness(double smoothness) {
  this->requireParameter(std::isfinite(smoothness) && smoothness >= 0, "smoothness", smoothness,
                         "a finite number of at least 0");
  parameters_.smoothness = smoothness;
}

template <typename PointT>
core::Labels GraphCutGroundSegmentation<PointT>::labelPoints(const core::Points& points,
                                                             const Eigen::Isometry3d& frame_from_input) {
  ground_ = core::GraphCutGround();
  ground_ = core::estimateGraphCutGround(points, frame_from_input, parameters_);
  return core::labelByHeight(points, ground_.surface, this->getHeightTolerance());
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_GraphCutGroundSegmentation(T) \
  template class PCL_FFT_GROUND_FILTERS_EXPORT pcl_fft_ground::GraphCutGroundSegmentation<T>;
