#pragma once

#include <gtest/gtest.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "clouds.h"
#include "low_pass_segmentation.h"

namespace pcl_fft_ground::test {

using Segmenter = LowPassSegmentation<pcl::PointXYZ>;

inline constexpr double CELL = 0.05;

/// A segmenter suited to boxScene(), with an input.
inline Segmenter segmenterOn(const Eigen::Matrix3Xf& points) {
  Segmenter segmenter;
  segmenter.setCellSize(CELL);
  segmenter.setMaximumObjectSize(0.8);
  segmenter.setInputCloud(cloudOf<pcl::PointXYZ>(points));
  return segmenter;
}

struct Parts {
  pcl::PointIndices ground, objects;
};

inline Parts segment(Segmenter& segmenter) {
  Parts parts;
  segmenter.segment(parts.ground, parts.objects);
  return parts;
}

inline std::vector<bool> objectFlags(Segmenter& segmenter) {
  std::vector<bool> flags(segmenter.getInputCloud()->size(), false);
  for (const pcl::index_t i : segment(segmenter).objects.indices) flags[static_cast<std::size_t>(i)] = true;
  return flags;
}

inline double heightAbove(const Segmenter& segmenter, std::size_t n) {
  return segmenter.getGroundSurface().heightAbove(
      (*segmenter.getInputCloud())[n].getVector3fMap().cast<double>());
}

/// Expects the labels of two runs to be equal but for points within 1e-6 m of the surface.
inline void expectSameLabels(Segmenter& first, Segmenter& second) {
  const std::vector<bool> a = objectFlags(first), b = objectFlags(second);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_GT(std::count(a.begin(), a.end(), true), 100);
  for (std::size_t n = 0; n < a.size(); ++n)
    EXPECT_TRUE(a[n] == b[n] || std::abs(heightAbove(first, n)) <= 1e-6)
        << "point " << n << " at " << heightAbove(first, n) << " m";
}

}  // namespace pcl_fft_ground::test
