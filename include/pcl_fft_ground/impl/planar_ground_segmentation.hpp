#pragma once

#include <cmath>

#include "pcl_fft_ground/impl/ground_segmentation.hpp"
#include "pcl_fft_ground/planar_ground_segmentation.h"

namespace pcl_fft_ground {

template <typename PointT>
PlanarGroundSegmentation<PointT>::PlanarGroundSegmentation(bool extract_removed_indices)
    : GroundSegmentation<PointT>("PlanarGroundSegmentation", {{}, UpEstimation::GIVEN, Yaw::NONE, {}},
                                 extract_removed_indices) {}

template <typename PointT>
void PlanarGroundSegmentation<PointT>::setDistanceThreshold(double threshold) {
  this->requireLength("distance threshold", threshold);
  parameters_.distance_threshold = threshold;
}

template <typename PointT>
void PlanarGroundSegmentation<PointT>::setMaxIterations(int iterations) {
  this->requireParameter(iterations >= 1, "number of iterations", iterations, "at least 1");
  parameters_.max_iterations = iterations;
}

template <typename PointT>
void PlanarGroundSegmentation<PointT>::setProbability(double probability) {
  this->requireParameter(probability > 0 && probability < 1, "probability", probability, "in (0, 1)");
  parameters_.probability = probability;
}

template <typename PointT>
core::Labels PlanarGroundSegmentation<PointT>::labelPoints(const core::Points& points,
                                                           const Eigen::Isometry3d& frame_from_input) {
  const core::Bounds bounds = core::boundsOf(points);
  const std::optional<core::Plane> plane = fitPlane(points, parameters_);
  if (!plane) {
    if (points.cols() > 0) this->warn("no plane was found: every point counts as ground");
    surface_ = core::planeSurface(frame_from_input, bounds, {Eigen::Vector2d::Zero(), bounds.high.z()});
    return core::Labels(static_cast<std::size_t>(points.cols()), core::Label::GROUND);
  }
  surface_ = core::planeSurface(frame_from_input, bounds, *plane);
  // The threshold is a distance from the plane, heights are taken along up.
  const double threshold = parameters_.distance_threshold * std::sqrt(1 + plane->slope.squaredNorm());
  return core::labelByHeight(points, surface_, threshold + this->getHeightTolerance());
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_PlanarGroundSegmentation(T) \
  template class PCL_FFT_GROUND_FILTERS_EXPORT pcl_fft_ground::PlanarGroundSegmentation<T>;
