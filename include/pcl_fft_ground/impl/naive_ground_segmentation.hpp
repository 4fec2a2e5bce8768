#pragma once

#include "pcl_fft_ground/core/ground/ground_surface.h"
#include "pcl_fft_ground/impl/ground_segmentation.hpp"
#include "pcl_fft_ground/naive_ground_segmentation.h"

namespace pcl_fft_ground {

template <typename PointT>
NaiveGroundSegmentation<PointT>::NaiveGroundSegmentation(bool extract_removed_indices)
    : GroundSegmentation<PointT>("NaiveGroundSegmentation", {{}, UpEstimation::GIVEN, Yaw::NONE, {}},
                                 extract_removed_indices) {}

template <typename PointT>
core::Labels NaiveGroundSegmentation<PointT>::labelPoints(const core::Points& points,
                                                          const Eigen::Isometry3d& frame_from_input) {
  const core::PointStatistics statistics = core::summarise(points);
  surface_ =
      core::planeSurface(frame_from_input, statistics.bounds, {Eigen::Vector2d::Zero(), statistics.mean.z()});
  return core::labelByHeight(points, surface_, this->getHeightTolerance());
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_NaiveGroundSegmentation(T) \
  template class PCL_FFT_GROUND_FILTERS_EXPORT pcl_fft_ground::NaiveGroundSegmentation<T>;
