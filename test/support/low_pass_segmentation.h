#pragma once

#include "pcl_fft_ground/fft_ground_segmentation.h"

namespace pcl_fft_ground::test {

/// FFTGroundSegmentation as published, for suites that make their segmenters themselves.
template <typename PointT>
struct LowPassSegmentation : FFTGroundSegmentation<PointT> {
  using Ptr = pcl::shared_ptr<LowPassSegmentation<PointT>>;
  using ConstPtr = pcl::shared_ptr<const LowPassSegmentation<PointT>>;

  explicit LowPassSegmentation(bool extract_removed_indices = false)
      : FFTGroundSegmentation<PointT>(extract_removed_indices) {
    this->setEstimator(Estimator::LOW_PASS);
  }
};

}  // namespace pcl_fft_ground::test
