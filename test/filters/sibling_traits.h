#pragma once

// What the contract has to know of the benchmark methods and the graph cut.

#include "contract_fixture.h"
#include "pcl_fft_ground/graph_cut_ground_segmentation.h"
#include "pcl_fft_ground/grid_ground_segmentation.h"
#include "pcl_fft_ground/naive_ground_segmentation.h"
#include "pcl_fft_ground/planar_ground_segmentation.h"

namespace pcl_fft_ground::test {

/// True where rounding alone may decide whether a point is higher above the surface than that.
template <typename FilteredT, typename PointT>
bool isAtHeight(const GroundSegmentation<FilteredT>& segmenter, const PointT& p, double height) {
  const double above = segmenter.getGroundSurface().heightAbove(Eigen::Vector3d(p.x, p.y, p.z));
  return std::abs(above - height) < 1e-6;
}

template <>
struct SegmenterTraits<NaiveGroundSegmentation> {
  static constexpr const char* NAME = "NaiveGroundSegmentation";

  template <typename PointT>
  static void setUp(NaiveGroundSegmentation<PointT>& segmenter) {
    segmenter.setHeightTolerance(0.1);  // above the swell, below the boxes
  }

  template <typename FilteredT, typename PointT>
  static bool isAtSurface(const NaiveGroundSegmentation<FilteredT>& segmenter, const PointT& p) {
    return isAtHeight(segmenter, p, segmenter.getHeightTolerance());
  }
};

template <>
struct SegmenterTraits<PlanarGroundSegmentation> {
  static constexpr const char* NAME = "PlanarGroundSegmentation";

  template <typename PointT>
  static void setUp(PlanarGroundSegmentation<PointT>& segmenter) {
    segmenter.setDistanceThreshold(0.1);
    segmenter.setMaxIterations(100);
  }

  template <typename FilteredT, typename PointT>
  static bool isAtSurface(const PlanarGroundSegmentation<FilteredT>& segmenter, const PointT& p) {
    const Eigen::ArrayXXd& height = segmenter.getGroundSurface().height;
    const double side = segmenter.getGroundSurface().geometry.cell_size;
    const Eigen::Vector2d slope(height(1, 0) - height(0, 0), height(0, 1) - height(0, 0));
    const double distance = segmenter.getDistanceThreshold();
    return isAtHeight(segmenter, p, distance * std::sqrt(1 + (slope / side).squaredNorm()));
  }
};

template <>
struct SegmenterTraits<GridGroundSegmentation> {
  static constexpr const char* NAME = "GridGroundSegmentation";

  /// Columns wider than the boxes, or the tops of these were bottom voxels, too.
  template <typename PointT>
  static void setUp(GridGroundSegmentation<PointT>& segmenter) {
    segmenter.setCellSize(1.0);
    segmenter.setVoxelHeight(0.2);
  }

  /// Up is given: the points are not turned, and nothing is rounded.
  template <typename FilteredT, typename PointT>
  static bool isAtSurface(const GridGroundSegmentation<FilteredT>&, const PointT&) {
    return false;
  }
};

template <>
struct SegmenterTraits<GraphCutGroundSegmentation> {
  static constexpr const char* NAME = "GraphCutGroundSegmentation";

  template <typename PointT>
  static void setUp(GraphCutGroundSegmentation<PointT>& segmenter) {
    segmenter.setCellSize(0.05);
    segmenter.setMaximumObjectSize(0.8);
  }

  template <typename FilteredT, typename PointT>
  static bool isAtSurface(const GraphCutGroundSegmentation<FilteredT>& segmenter, const PointT& p) {
    return isAtHeight(segmenter, p, segmenter.getHeightTolerance());
  }
};

}  // namespace pcl_fft_ground::test
