#include "pcl_fft_ground/core/segments/voxel_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

using Cluster = std::vector<Eigen::Index>;
using Clusters = std::vector<Cluster>;

/// Compares every point with every other.
Clusters slowClusters(const Points& points, double leaf_size) {
  const Eigen::Array3Xd voxels = (points.cast<double>().array() / leaf_size).floor();
  std::vector<bool> taken(static_cast<std::size_t>(points.cols()), false);
  Clusters clusters;
  for (Eigen::Index first = 0; first < points.cols(); ++first) {
    if (taken[static_cast<std::size_t>(first)]) continue;
    taken[static_cast<std::size_t>(first)] = true;
    Cluster cluster = {first};
    for (std::size_t next = 0; next < cluster.size(); ++next)
      for (Eigen::Index n = 0; n < points.cols(); ++n) {
        const bool touches = ((voxels.col(n) - voxels.col(cluster[next])).abs() <= 1).all();
        if (!touches || taken[static_cast<std::size_t>(n)]) continue;
        taken[static_cast<std::size_t>(n)] = true;
        cluster.push_back(n);
      }
    std::sort(cluster.begin(), cluster.end());
    clusters.push_back(cluster);
  }
  std::sort(clusters.begin(), clusters.end(), [](const Cluster& a, const Cluster& b) {
    return a.size() != b.size() ? a.size() > b.size() : a.front() < b.front();
  });
  return clusters;
}

TEST(VoxelClusters, TouchAtCornersAndNotAcrossAVoxel) {
  const Eigen::Vector3f centre(0.5F, 0.5F, 0.5F);
  for (int n = 0; n < 125; ++n) {
    const Eigen::Vector3f offset(static_cast<float>(n % 5 - 2), static_cast<float>(n / 5 % 5 - 2),
                                 static_cast<float>(n / 25 - 2));
    SCOPED_TRACE(testing::Message() << offset.transpose());
    Points points(3, 2);
    points << centre, centre + offset;
    const bool touch = offset.cwiseAbs().maxCoeff() <= 1;
    EXPECT_EQ(voxelClusters(points, 1), touch ? (Clusters{{0, 1}}) : (Clusters{{0}, {1}}));
  }
}

TEST(VoxelClusters, APointOnABorderBelongsToTheUpperVoxel) {
  Points points = Points::Zero(3, 2);
  points.row(0) << 2, 0.5F;  // voxels 2 and 0
  EXPECT_EQ(voxelClusters(points, 1).size(), 2U);
  points(0, 0) = std::nextafter(2.0F, 0.0F);  // voxels 1 and 0
  EXPECT_EQ(voxelClusters(points, 1).size(), 1U);
  points.row(0) << -1, 1;  // voxels -1 and 1: voxel 0 is between them
  EXPECT_EQ(voxelClusters(points, 1).size(), 2U);
}

TEST(VoxelClusters, AreSortedBySizeThenByTheirFirstPoint) {
  Points points = Points::Zero(3, 7);
  points.row(0) << 50, 0, 10, 20, 10, 20, 10;
  EXPECT_EQ(voxelClusters(points, 1), (Clusters{{2, 4, 6}, {3, 5}, {0}, {1}}));
}

TEST(VoxelClusters, OfFewPoints) {
  EXPECT_TRUE(voxelClusters(Points(3, 0), 1).empty());
  EXPECT_EQ(voxelClusters(Eigen::Vector3f(1, 2, 3), 0.02), (Clusters{{0}}));
  EXPECT_EQ(voxelClusters(Eigen::Vector3f(1, 2, 3).replicate(1, 3), 0.02), (Clusters{{0, 1, 2}}));
}

TEST(VoxelClusters, AChainIsOneCluster) {
  constexpr Eigen::Index LENGTH = 50000;
  Points chain = Points::Zero(3, LENGTH);
  std::mt19937 random(4);
  const std::vector<Eigen::Index> order = test::randomOrder(LENGTH, random);
  for (Eigen::Index n = 0; n < LENGTH; ++n)
    chain(0, n) = chain(1, n) = static_cast<float>(order[static_cast<std::size_t>(n)]) + 0.5F;
  EXPECT_EQ(voxelClusters(chain, 1).size(), 1U);
  EXPECT_EQ(voxelClusters(chain, 0.5).size(), static_cast<std::size_t>(LENGTH));
}

class VoxelClustersOfSeed : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, VoxelClustersOfSeed, testing::Range(1U, 6U));

TEST_P(VoxelClustersOfSeed, AgreeWithBruteForce) {
  std::mt19937 random(GetParam());
  for (const double leaf_size : {0.02, 0.07, 0.2, 0.5, 3.0, 100.0}) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", leaf size " << leaf_size);
    const Points points = test::randomBox(1500, {-3, -2, 10}, {3, 2, 12}, random);
    EXPECT_EQ(voxelClusters(points, leaf_size), slowClusters(points, leaf_size));
  }
}

TEST_P(VoxelClustersOfSeed, DoNotChangeWhenAllMovesByWholeVoxels) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  // Multiples of 2^-10 m, so that the moves are exact in float.
  Points points = test::randomBox(2000, {-2, -2, -1}, {2, 2, 1}, random);
  points = (points.array() * 1024).floor() / 1024;
  const Clusters expected = voxelClusters(points, 0.125);
  EXPECT_GT(expected.size(), 1U);
  for (const Eigen::Vector3f& voxels :
       {Eigen::Vector3f(8, 0, 0), Eigen::Vector3f(-80, 17, 5), Eigen::Vector3f(8000, -8000, 800)}) {
    const Points moved = points.colwise() + 0.125F * voxels;
    EXPECT_EQ(voxelClusters(moved, 0.125), expected) << voxels.transpose();
  }
}

TEST_P(VoxelClustersOfSeed, AreTheSameSetsInAnyOrderOfThePoints) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  const Points points = test::randomBox(2000, {0, 0, 0}, {4, 4, 1}, random);
  const std::vector<Eigen::Index> order = test::randomOrder(points.cols(), random);
  Clusters clusters = voxelClusters(points(Eigen::all, order), 0.15), expected = voxelClusters(points, 0.15);
  for (Cluster& cluster : clusters) {
    for (Eigen::Index& n : cluster) n = order[static_cast<std::size_t>(n)];
    std::sort(cluster.begin(), cluster.end());
  }
  std::sort(clusters.begin(), clusters.end());
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(clusters, expected);
}

// Quotients beyond all integers: whatever the voxels are, every point is in one cluster.
TEST(VoxelClusters, OfAbsurdSizesAndPlacesArePartitions) {
  Points points(3, 6);
  points << 0, 1, -1, 3e38F, -3e38F, 1e-45F,  //
      0, 1, 2, 3e38F, 3e38F, 1e-45F,          //
      0, 1, 3, -3e38F, 1, -1e-45F;
  for (const double leaf_size : {std::numeric_limits<double>::min(), 1e-30, 1e-9, 1.0, 1e30, 1e300}) {
    SCOPED_TRACE(leaf_size);
    Cluster all;
    for (const Cluster& cluster : voxelClusters(points, leaf_size))
      all.insert(all.end(), cluster.begin(), cluster.end());
    std::sort(all.begin(), all.end());
    EXPECT_EQ(all, (Cluster{0, 1, 2, 3, 4, 5}));
  }
  EXPECT_EQ(voxelClusters(points.cwiseAbs(), 1e300).size(), 1U);
}

}  // namespace
}  // namespace pcl_fft_ground::core
