#pragma once

#include <cmath>
#include <limits>
#include <sstream>

#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/impl/ground_segmentation.hpp"

namespace pcl_fft_ground {

template <typename PointT>
FFTGroundSegmentation<PointT>::FFTGroundSegmentation(bool extract_removed_indices)
    : GroundSegmentation<PointT>("FFTGroundSegmentation", core::FrameParameters(), extract_removed_indices) {}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setCellSize(double cell_size) {
  this->requireLength("cell size", cell_size);
  parameters_.cell_size = cell_size;
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setMaximumObjectSize(double size) {
  this->requireLength("maximum object size", size);
  parameters_.max_object_size = size;
}

template <typename PointT>
double FFTGroundSegmentation<PointT>::getMaximumObjectSize() const {
  return parameters_.max_object_size.value_or(std::numeric_limits<double>::quiet_NaN());
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setRelativeMaximumObjectSize(double share) {
  this->requireParameter(share > 0 && share <= 1, "relative maximum object size", share, "in (0, 1]");
  parameters_.relative_max_object_size = share;
  parameters_.max_object_size.reset();
}

template <typename PointT>
double FFTGroundSegmentation<PointT>::getRelativeMaximumObjectSize() const {
  return parameters_.max_object_size ? std::numeric_limits<double>::quiet_NaN()
                                     : parameters_.relative_max_object_size;
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setCutoffFrequency(double cutoff) {
  this->requireParameter(cutoff >= 0 && cutoff <= M_SQRT2, "cut-off frequency", cutoff,
                         "in (0, 1.41421], or 0 for automatic");
  parameters_.cutoff_frequency = cutoff > 0 ? std::optional<double>(cutoff) : std::nullopt;
  ground_.cutoff = core::Cutoff();
}

template <typename PointT>
double FFTGroundSegmentation<PointT>::getCutoffFrequency() const {
  return parameters_.cutoff_frequency.value_or(ground_.cutoff.frequency);
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setFilterOrder(unsigned order) {
  this->requireParameter(order >= 1 && order <= 100, "filter order", order, "in [1, 100]");
  parameters_.filter_order = order;
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setPassbandRipple(double ripple) {
  this->requireParameter(ripple > 0 && ripple <= 100, "passband ripple", ripple, "in (0, 100] dB");
  parameters_.passband_ripple = ripple;
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setPeakWindow(unsigned half_window) {
  this->requireParameter(half_window >= 1 && half_window <= 1000, "peak window", half_window,
                         "in [1, 1000] bins");
  parameters_.peaks.half_window = half_window;
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setPeakThreshold(double threshold) {
  this->requireParameter(std::isfinite(threshold) && threshold >= 0, "peak threshold", threshold,
                         "a finite number of at least 0");
  parameters_.peaks.threshold = threshold;
}

template <typename PointT>
core::Labels FFTGroundSegmentation<PointT>::labelPoints(const core::Points& points,
                                                        const Eigen::Isometry3d& frame_from_input) {
  ground_ = core::LowPassGround();
  if (points.cols() == 0) return {};
  ground_ = core::estimateLowPassGround(points, frame_from_input, parameters_);
  warnOfDoubts();
  return core::labelByHeight(points, ground_.surface, this->getHeightTolerance());
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::warnOfDoubts() {
  constexpr double MOST_EMPTY = 0.1;  // what the paper allows (Sec. IV-A)
  std::ostringstream sentence;
  sentence.precision(3);
  if (getEmptyCellShare() > MOST_EMPTY) {
    sentence << 100 * getEmptyCellShare()
             << " % of the elevation cells hold no point: the method is meant for at most "
             << 100 * MOST_EMPTY << " %; larger cells may help";
    this->warn(sentence.str());
  }
  if (parameters_.max_object_size && *parameters_.max_object_size > ground_.extent) {
    sentence.str("");
    sentence << "the maximum object size of " << *parameters_.max_object_size
             << " m exceeds the extent of the scan, " << ground_.extent << " m";
    this->warn(sentence.str());
  }
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_FFTGroundSegmentation(T) \
  template class PCL_FFT_GROUND_FILTERS_EXPORT pcl_fft_ground::FFTGroundSegmentation<T>;
