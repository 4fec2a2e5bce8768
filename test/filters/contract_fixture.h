#pragma once

#include <gtest/gtest.h>
#include <pcl/filters/filter_indices.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "clouds.h"
#include "low_pass_segmentation.h"
#include "output_capture.h"

namespace pcl_fft_ground::test {

/// What the contract has to know of a segmenter: one specialisation for each.
template <template <typename> class SegmenterT>
struct SegmenterTraits;

/// Both estimators suited to boxScene().
struct FFTTraits {
  static constexpr const char* NAME = "FFTGroundSegmentation";

  template <typename PointT>
  static void setUp(FFTGroundSegmentation<PointT>& segmenter) {
    segmenter.setCellSize(0.05);
    segmenter.setMaximumObjectSize(0.8);
  }

  /// True where rounding alone may decide about the label: at the tolerance, which grows with the slope.
  template <typename FilteredT, typename PointT>
  static bool isAtSurface(const FFTGroundSegmentation<FilteredT>& segmenter, const PointT& p) {
    const double height = segmenter.getGroundSurface().heightAbove(Eigen::Vector3d(p.x, p.y, p.z));
    const double slack = segmenter.getEstimator() == Estimator::LOW_PASS ? 1e-6 : 1e-4;
    return std::abs(height - segmenter.getHeightTolerance()) < slack;
  }
};

template <>
struct SegmenterTraits<FFTGroundSegmentation> : FFTTraits {};

template <>
struct SegmenterTraits<LowPassSegmentation> : FFTTraits {};

/// A segmenter on a point type: the parameter of the suite.
/// \tparam FilteredT what the segmenter is instantiated for, if that is not the type of the points
template <template <typename> class SegmenterT, typename PointT, typename FilteredT = PointT>
struct Subject {
  using Point = PointT;
  using Filtered = FilteredT;
  using Segmenter = SegmenterT<FilteredT>;
  template <typename OtherPointT>
  using SegmenterOf = SegmenterT<OtherPointT>;
  using Traits = SegmenterTraits<SegmenterT>;
};

/// Gives a test access to what a filter keeps to itself, and its class name.
template <typename SegmenterT>
struct Opened : SegmenterT {
  using SegmenterT::getClassName;
  using SegmenterT::SegmenterT;
};

inline pcl::Indices sorted(pcl::Indices indices) {
  std::sort(indices.begin(), indices.end());
  return indices;
}

inline pcl::Indices joined(pcl::Indices a, const pcl::Indices& b) {
  a.insert(a.end(), b.begin(), b.end());
  return sorted(a);
}

inline pcl::Indices allIndices(std::size_t size) {
  pcl::Indices indices(size);
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

/// Indices out of order, with gaps and with every eleventh one twice.
inline pcl::IndicesPtr shuffledIndices(std::size_t size) {
  pcl::IndicesPtr indices(new pcl::Indices);
  for (std::size_t n = 0; n < size; n += 1 + n % 2) {
    indices->push_back(static_cast<pcl::index_t>((n * 2741) % size));
    if (n % 11 == 0) indices->push_back(indices->back());
  }
  return indices;
}

/// FILTER_CONTRACT: what every ground segmenter owes as a pcl::FilterIndices. Each test carries its line.
template <typename SubjectT>
class FilterContract : public testing::Test {
 protected:
  using PointT = typename SubjectT::Point;
  using CloudT = CloudOf<PointT>;
  using SegmenterT = typename SubjectT::Segmenter;
  using Traits = typename SubjectT::Traits;

  FilterContract() { Traits::setUp(segmenter_); }

  /// A segmenter with removed indices on, working on a cloud.
  static SegmenterT recording(const typename CloudT::ConstPtr& cloud) {
    SegmenterT segmenter(true);
    Traits::setUp(segmenter);
    segmenter.setInputCloud(cloud);
    return segmenter;
  }

  static pcl::Indices filterIndices(SegmenterT& segmenter) {
    pcl::Indices indices;
    segmenter.filter(indices);
    return indices;
  }

  static CloudT filterCloud(SegmenterT& segmenter) {
    CloudT cloud;
    segmenter.filter(cloud);
    return cloud;
  }

  /// Labels of segment(), 1 for an object, 0 for ground, 2 for neither.
  static std::vector<int> labels(SegmenterT& segmenter) {
    pcl::PointIndices ground, objects;
    segmenter.segment(ground, objects);
    const auto cloud = segmenter.getInputCloud();
    std::vector<int> labels(cloud->width * cloud->height, 2);
    for (const pcl::index_t i : ground.indices) labels[static_cast<std::size_t>(i)] = 0;
    for (const pcl::index_t i : objects.indices) labels[static_cast<std::size_t>(i)] = 1;
    return labels;
  }

  static pcl::Indices finiteOf(const CloudT& cloud, const pcl::Indices& indices) {
    pcl::Indices finite;
    for (const pcl::index_t i : indices)
      if (isFinitePoint(cloud[static_cast<std::size_t>(i)])) finite.push_back(i);
    return finite;
  }

  /// What must hold whatever the points are: no throw, a partition of the points, the same one each time.
  static void expectDefinedResult(const typename CloudT::Ptr& cloud) {
    const CloudT before = *cloud;
    SegmenterT segmenter = recording(cloud);
    for (const bool negative : {false, true}) {
      segmenter.setNegative(negative);
      pcl::Indices kept;
      ASSERT_NO_THROW(segmenter.filter(kept));
      EXPECT_EQ(joined(kept, *segmenter.getRemovedIndices()), allIndices(cloud->size()));
      EXPECT_EQ(filterIndices(segmenter), kept);
      EXPECT_EQ(filterCloud(segmenter).size(), kept.size());
    }
    pcl::PointIndices ground, objects;
    ASSERT_NO_THROW(segmenter.segment(ground, objects));
    EXPECT_EQ(joined(ground.indices, objects.indices), finiteOf(*cloud, allIndices(cloud->size())));
    EXPECT_TRUE(sameClouds(*cloud, before));
  }

  const Scene scene_ = boxScene();
  const typename CloudT::Ptr scan_ = cloudOf<PointT>(scene_);  ///< organised and dense
  const typename CloudT::Ptr spoilt_ = [this] {                ///< the same with points that are not finite
    const auto cloud = cloudOf<PointT>(scene_);
    spoilPoints(*cloud);
    return cloud;
  }();
  SegmenterT segmenter_;  ///< set up for the scene, without an input
};

TYPED_TEST_SUITE_P(FilterContract);

}  // namespace pcl_fft_ground::test
