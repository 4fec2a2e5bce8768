#include "pcl_fft_ground/core/segments/segment.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "stone_site.h"

namespace pcl_fft_ground::core {
namespace {

using test::poseAt;
using test::scanStones;
using test::StoneSite;

const StoneSite TWO_STONES = {{{0, 0}, {0.3, 0.1, 0.15}, 0}, {{0.8, 0.5}, {0.1, 0.1, 0.1}, 0}};

ScanSegments describe(const StoneSite& site, const SegmentParameters& parameters = {},
                      double spacing = 0.008) {
  const test::StoneScan scan = scanStones(site, poseAt(0, 0, 0), 1, spacing);
  return describeScan(scan.points, scan.labels, parameters);
}

TEST(Segments, HaveTheShapeOfTheObjects) {
  const ScanSegments scan = describe(TWO_STONES);
  ASSERT_EQ(scan.segments.size(), 2U);
  const Segment& large = scan.segments[0];
  EXPECT_NEAR(large.centroid.x(), 0, 0.01);
  EXPECT_NEAR(large.centroid.y(), 0, 0.01);
  EXPECT_NEAR(large.extents.x(), 0.6, 0.03);
  EXPECT_NEAR(large.extents.y(), 0.2, 0.03);
  EXPECT_GT(std::abs(large.axes.col(0).x()), 0.99);
  EXPECT_GT(large.spreads[0], large.spreads[1]);
  EXPECT_FALSE(large.at_border);
  EXPECT_NEAR(scan.segments[1].centroid.x(), 0.8, 0.01);
}

TEST(Segments, AtTheBorderSaySo) {
  const ScanSegments scan = describe({{{1.45, 0}, {0.2, 0.1, 0.1}, 0}});
  ASSERT_EQ(scan.segments.size(), 1U);
  EXPECT_TRUE(scan.segments[0].at_border);
}

TEST(Segments, ThatAreTooSmallAreLeftOut) {
  SegmentParameters parameters;
  parameters.min_extent = 0.4;
  EXPECT_EQ(describe(TWO_STONES, parameters).segments.size(), 1U);
  parameters = {};
  parameters.min_voxels = 100000;
  EXPECT_TRUE(describe(TWO_STONES, parameters).segments.empty());
  parameters = {};
  parameters.max_segments = 1;
  EXPECT_EQ(describe(TWO_STONES, parameters).segments.size(), 1U);
}

TEST(Segments, OfGivenClustersKnowTheirSource) {
  const test::StoneScan scan = scanStones(TWO_STONES, poseAt(0, 0, 0), 1);
  std::vector<std::vector<Eigen::Index>> clusters(3);  // the first is empty
  for (std::size_t n = 0; n < scan.labels.size(); ++n)
    if (scan.labels[n] == Label::OBJECT)
      clusters[scan.points(0, static_cast<Eigen::Index>(n)) > 0.5F ? 1 : 2].push_back(
          static_cast<Eigen::Index>(n));
  const ScanSegments described = describeScan(scan.points, clusters);
  EXPECT_EQ(described.sources, (std::vector<std::ptrdiff_t>{2, 1}));
}

TEST(Segments, VoxelsFollowTheSpacing) {
  EXPECT_DOUBLE_EQ(describe(TWO_STONES).voxel_size, 0.02);
  EXPECT_NEAR(describe(TWO_STONES, {}, 0.02).voxel_size, 0.05, 1e-9);
  EXPECT_NEAR(describe(TWO_STONES, {}, 0.1).voxel_size, 0.25, 0.031);
  EXPECT_DOUBLE_EQ(voxelSizeFor(Points(3, 0)), 0.02);
  EXPECT_DOUBLE_EQ(voxelSizeFor(Points::Zero(3, 5)), 0.02);
}

TEST(Segments, CanBeCoarsenedOnly) {
  const ScanSegments scan = describe(TWO_STONES);
  const ScanSegments coarse = coarsened(scan, 0.05);
  EXPECT_DOUBLE_EQ(coarse.voxel_size, 0.05);
  EXPECT_EQ(coarse.segments.size(), 2U);
  EXPECT_LT(coarse.surface.cols(), scan.surface.cols() / 4);
  EXPECT_DOUBLE_EQ(coarsened(scan, 0.01).voxel_size, 0.02);
}

TEST(Segments, StrayReturnsFarAwayDoNotCount) {
  const test::StoneScan scan = scanStones(TWO_STONES, poseAt(0, 0, 0), 1, 0.008);
  Points points(3, scan.points.cols() + 1);
  points << scan.points, Eigen::Vector3f(1e6F, -1e6F, 3e5F);
  Labels labels = scan.labels;
  labels.push_back(Label::OBJECT);
  const ScanSegments with = describeScan(points, labels), without = describeScan(scan.points, scan.labels);
  EXPECT_EQ(with.surface, without.surface);
  EXPECT_EQ(with.objects, without.objects);
  EXPECT_EQ(with.coverage.area(), without.coverage.area());
}

TEST(Segments, OfNoPointsAreNone) {
  const ScanSegments scan = describeScan(Points(3, 0), Labels());
  EXPECT_TRUE(scan.segments.empty());
  EXPECT_EQ(scan.coverage.area(), 0);
}

TEST(Segments, RejectWrongInput) {
  EXPECT_THROW(describeScan(Points::Zero(3, 2), Labels(1)), std::invalid_argument);
  SegmentParameters parameters;
  parameters.voxel_size = 0;
  EXPECT_THROW(describe(TWO_STONES, parameters), std::invalid_argument);
}

TEST(ScanCoverage, IsTheFootprint) {
  const ScanCoverage coverage = describe(TWO_STONES).coverage;
  EXPECT_NEAR(coverage.area(), 9, 0.4);
  EXPECT_NEAR(coverage.depthAt(0, 0), 1.5, 0.06);
  EXPECT_NEAR(coverage.depthAt(1.2, 0), 0.3, 0.06);
  EXPECT_EQ(coverage.depthAt(1.6, 0), 0);
  EXPECT_EQ(coverage.depthAt(1e9, -1e9), 0);
  EXPECT_FALSE(ScanCoverage().covers(Eigen::Vector3d::Zero(), 0));
}

TEST(ScanCoverage, FillsShadowsAndLeavesGaps) {
  const test::StoneScan scan = scanStones({}, poseAt(0, 0, 0), 1);
  const auto without = [&](float half) {
    Points kept = scan.points;
    Eigen::Index count = 0;
    for (Eigen::Index n = 0; n < kept.cols(); ++n)
      if (scan.points.col(n).head<2>().cwiseAbs().maxCoeff() > half) kept.col(count++) = scan.points.col(n);
    kept.conservativeResize(Eigen::NoChange, count);
    return coverageOf(kept, 0.05);
  };
  EXPECT_GT(without(0.1F).depthAt(0, 0), 1);
  EXPECT_EQ(without(0.4F).depthAt(0, 0), 0);
  EXPECT_NEAR(without(0.4F).depthAt(0.8, 0), 0.4, 0.06);
}

}  // namespace
}  // namespace pcl_fft_ground::core
