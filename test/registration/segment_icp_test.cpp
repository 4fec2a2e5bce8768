#include "pcl_fft_ground/segment_icp.h"

#include <gtest/gtest.h>
#include <pcl/exceptions.h>
#include <pcl/point_types.h>

#include <cmath>
#include <limits>
#include <optional>

#include "pcl_fft_ground/core/segments/voxel_clusters.h"
#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/kd_tree_neighbours.h"
#include "stone_site.h"

namespace pcl_fft_ground {
namespace {

using test::poseAt;
using Icp = SegmentICP<pcl::PointXYZ, pcl::PointXYZ>;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

const Eigen::Isometry3d TRUTH = poseAt(-0.7, 0, 10).inverse() * poseAt(0.8, 0.3, -20);

Cloud::Ptr cloudOf(const test::StoneScan& scan) {
  const Cloud::Ptr cloud(new Cloud);
  for (Eigen::Index n = 0; n < scan.points.cols(); ++n)
    cloud->emplace_back(scan.points(0, n), scan.points(1, n), scan.points(2, n));
  return cloud;
}

Icp::Clusters segmentsOf(const test::StoneScan& scan) {
  pcl::Indices objects;
  for (std::size_t n = 0; n < scan.labels.size(); ++n)
    if (scan.labels[n] == core::Label::OBJECT) objects.push_back(static_cast<pcl::index_t>(n));
  Icp::Clusters clusters;
  for (const auto& members : core::voxelClusters(scan.points(Eigen::all, objects), 0.02)) {
    pcl::PointIndices& cluster = clusters.emplace_back();
    for (const Eigen::Index n : members) cluster.indices.push_back(objects[static_cast<std::size_t>(n)]);
  }
  return clusters;
}

class SegmentICPTest : public testing::Test {
 protected:
  SegmentICPTest() {
    icp_.setInputSource(cloudOf(moving_));
    icp_.setInputTarget(cloudOf(reference_));
  }

  void giveSegments() {
    icp_.setSourceSegments(segmentsOf(moving_));
    icp_.setTargetSegments(segmentsOf(reference_));
  }

  double align(double shift) {
    const Eigen::Isometry3d guess = Eigen::Translation3d(shift, 0, 0) * TRUTH;
    icp_.align(aligned_, guess.matrix().cast<float>());
    return (icp_.getFinalTransformation().cast<double>() - TRUTH.matrix()).norm();
  }

  test::StoneSite site_ = test::randomStones(1);
  test::StoneScan moving_ = test::scanStones(site_, poseAt(0.8, 0.3, -20), 1);
  test::StoneScan reference_ = test::scanStones(site_, poseAt(-0.7, 0, 10), 2);
  Icp icp_;
  Cloud aligned_;
};

TEST_F(SegmentICPTest, AlignsGivenSegments) {
  giveSegments();
  EXPECT_LT(align(0.15), 0.005);
  EXPECT_TRUE(icp_.hasConverged()) << icp_.getRefusal();
  EXPECT_EQ(icp_.getMethod(), core::AlignmentMethod::SEGMENTS);
  EXPECT_GE(icp_.getMatches().size(), 3U);
  EXPECT_GT(icp_.getScore(), 0.8);
  EXPECT_GT(icp_.getCovariance().diagonal().minCoeff(), 0);
  ASSERT_EQ(aligned_.size(), icp_.getInputSource()->size());
  const Eigen::Vector4f first = icp_.getFinalTransformation() * (*icp_.getInputSource())[0].getVector4fMap();
  EXPECT_TRUE(aligned_[0].getVector4fMap().isApprox(first));
}

TEST_F(SegmentICPTest, FindsSegmentsByItself) {
  EXPECT_LT(align(0.1), 0.01);
  EXPECT_TRUE(icp_.hasConverged()) << icp_.getRefusal();
}

TEST_F(SegmentICPTest, RefusesWhatIsTooFarOffAndSaysWhy) {
  giveSegments();
  icp_.setFallback(core::Fallback::NONE);
  align(2);
  EXPECT_FALSE(icp_.hasConverged());
  EXPECT_FALSE(icp_.getRefusal().empty());
  icp_.setSearchMode(core::SearchMode::WIDE);
  EXPECT_LT(align(1.9), 0.005);
  EXPECT_TRUE(icp_.hasConverged()) << icp_.getRefusal();
}

TEST_F(SegmentICPTest, KdTreesFindTheSame) {
  giveSegments();
  const double error = align(0.1);
  icp_.setNeighbourSearch(kdTreeNeighbours);
  EXPECT_NEAR(align(0.1), error, 1e-4);
  EXPECT_TRUE(icp_.hasConverged());
}

TEST_F(SegmentICPTest, TheFitnessScoreBuildsItsTreeWhenAskedFor) {
  giveSegments();
  align(0.1);
  EXPECT_LT(icp_.getFitnessScore(0.05 * 0.05), 5e-4);
}

TEST_F(SegmentICPTest, ComputesInDoubleWhatAlignRounds) {
  const Eigen::Isometry3d guess = Eigen::Translation3d(0.1, 0, 0) * TRUTH;
  const Eigen::Matrix4d precise = icp_.computeAlignment(guess).reference_from_moving.matrix();
  EXPECT_TRUE(icp_.hasConverged()) << icp_.getRefusal();
  EXPECT_EQ(icp_.getFinalTransformation(), precise.cast<float>().eval());
  align(0.1);
  EXPECT_TRUE(icp_.getFinalTransformation().isApprox(precise.cast<float>(), 1e-4F));
}

/// Counts how often it is asked to segment.
class CountingGround : public FFTGroundSegmentation<pcl::PointXYZ> {
 public:
  int runs = 0;

 protected:
  core::Labels labelPoints(const core::Points& points, const Eigen::Isometry3d& frame_from_input) override {
    ++runs;
    return FFTGroundSegmentation::labelPoints(points, frame_from_input);
  }
};

TEST_F(SegmentICPTest, TheTargetIsDescribedOnceForManySources) {
  const pcl::shared_ptr<CountingGround> source(new CountingGround), target(new CountingGround);
  icp_.setGroundSegmentation(source, target);
  align(0.1);
  const Icp::Matrix4 first = icp_.getFinalTransformation();
  align(0.1);
  EXPECT_EQ(icp_.getFinalTransformation(), first);
  EXPECT_EQ(source->runs, 2);
  EXPECT_EQ(target->runs, 1);
  icp_.setInputTarget(cloudOf(reference_));
  align(0.1);
  EXPECT_EQ(target->runs, 2);
  icp_.setSegmentParameters(icp_.getSegmentParameters());
  align(0.1);
  EXPECT_EQ(target->runs, 3);
}

TEST_F(SegmentICPTest, OnlyTheIndexedPointsOfTheSourceTakePart) {
  const pcl::IndicesPtr left(new pcl::Indices);
  const Cloud& cloud = *icp_.getInputSource();
  for (std::size_t n = 0; n < cloud.size(); ++n)
    if (cloud[n].x < 0.3F) left->push_back(static_cast<pcl::index_t>(n));
  icp_.setIndices(left);
  align(0.1);
  EXPECT_EQ(aligned_.size(), left->size());
  EXPECT_LT(icp_.getSourceScan().surface.row(0).maxCoeff(), 0.3F + 0.02F);
}

TEST_F(SegmentICPTest, WhatCannotBeWorkedOnIsARefusalAndNoException) {
  Icp::Clusters beyond(1);
  beyond[0].indices = {1000000000};
  icp_.setSourceSegments(beyond);
  align(0.1);
  EXPECT_FALSE(icp_.hasConverged());
  EXPECT_NE(icp_.getSourceError(), "");
  EXPECT_NE(icp_.getRefusal().find(icp_.getSourceError()), std::string::npos);
  EXPECT_EQ(icp_.getTargetError(), "");

  icp_.setSourceSegments({});
  align(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(icp_.hasConverged());
  EXPECT_NE(icp_.getRefusal(), "");

  icp_.setInputTarget(Cloud::Ptr(new Cloud(1, 1, {NAN, NAN, NAN})));
  align(0.1);
  EXPECT_FALSE(icp_.hasConverged());
  EXPECT_NE(icp_.getTargetError(), "");
  EXPECT_FALSE(Icp().computeAlignment(TRUTH).accepted);
}

TEST_F(SegmentICPTest, TellsTheScansWhereTheirSensorsStood) {
  const Eigen::Vector3d here(0.2, 0.1, 4), there(-0.3, 0, 5);
  icp_.setUpDirection({0, 0, 1});
  icp_.setSensorPosition(here, there);
  align(0.1);
  ASSERT_TRUE(icp_.getSourceScan().sensor && icp_.getTargetScan().sensor);
  EXPECT_TRUE(icp_.getSourceScan().sensor->isApprox(here));
  EXPECT_TRUE(icp_.getTargetScan().sensor->isApprox(there));
  icp_.setSensorPosition(std::nullopt, std::nullopt);
  align(0.1);
  EXPECT_FALSE(icp_.getSourceScan().sensor || icp_.getTargetScan().sensor);
  EXPECT_THROW(icp_.setSensorPosition(Eigen::Vector3d(0, 0, NAN), there), pcl::PCLException);
}

TEST_F(SegmentICPTest, RejectsParametersOutOfRange) {
  core::SearchGates gates = icp_.getGates();
  gates.max_rise = 0;
  EXPECT_THROW(icp_.setGates(gates), pcl::PCLException);
  gates.max_rise = std::numeric_limits<double>::infinity();
  EXPECT_THROW(icp_.setGates(gates), pcl::PCLException);
  core::SegmentParameters segments;
  segments.voxel_size = -1;
  EXPECT_THROW(icp_.setSegmentParameters(segments), pcl::PCLException);
  EXPECT_FALSE(icp_.getSegmentParameters().voxel_size);
  core::AlignmentParameters parameters;
  parameters.min_matches = 0;
  EXPECT_THROW(icp_.setAlignmentParameters(parameters), pcl::PCLException);

  EXPECT_THROW(icp_.setMinMatches(0), pcl::PCLException);
  EXPECT_THROW(icp_.setMinScore(1.5), pcl::PCLException);
  EXPECT_THROW(icp_.setMaxSigma(0), pcl::PCLException);
  EXPECT_THROW(icp_.setUpDirection(Eigen::Vector3d::Zero()), pcl::PCLException);
}

}  // namespace
}  // namespace pcl_fft_ground
