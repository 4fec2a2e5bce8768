#include "pcl_fft_ground/voxel_cluster_extraction.h"

#include <gtest/gtest.h>
#include <pcl/exceptions.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "clouds.h"
#include "euclidean_clusters.h"
#include "output_capture.h"

namespace pcl_fft_ground::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Clusters = std::vector<pcl::PointIndices>;

Clusters extract(const Cloud::ConstPtr& cloud, double leaf_size, const pcl::IndicesPtr& indices = nullptr) {
  VoxelClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setInputCloud(cloud);
  if (indices) extraction.setIndices(indices);
  extraction.setLeafSize(leaf_size);
  Clusters clusters;
  extraction.extract(clusters);
  return clusters;
}

std::vector<pcl::Indices> indicesOf(const Clusters& clusters) {
  std::vector<pcl::Indices> lists;
  for (const pcl::PointIndices& cluster : clusters) lists.push_back(cluster.indices);
  return lists;
}

Cloud::Ptr cloudOfPoints(const std::vector<Eigen::Vector3f>& places) {
  Eigen::Matrix3Xf points(3, static_cast<Eigen::Index>(places.size()));
  for (std::size_t n = 0; n < places.size(); ++n) points.col(static_cast<Eigen::Index>(n)) = places[n];
  return cloudOf<pcl::PointXYZ>(points);
}

/// True if the voxels of two points are the same or touch.
bool inContact(const pcl::PointXYZ& a, const pcl::PointXYZ& b, double leaf_size) {
  const auto near = [leaf_size](float p, float q) {
    return std::abs(std::floor(p / leaf_size) - std::floor(q / leaf_size)) <= 1;
  };
  return near(a.x, b.x) && near(a.y, b.y) && near(a.z, b.z);
}

/// The same clusters by comparing all pairs: grows each from its first point.
std::vector<pcl::Indices> bruteForceClusters(const Cloud& cloud, const pcl::Indices& indices,
                                             double leaf_size) {
  std::vector<pcl::Indices> clusters;
  std::vector<bool> taken(indices.size(), false);
  for (std::size_t seed = 0; seed < indices.size(); ++seed) {
    if (taken[seed] || !isFinitePoint(cloud[static_cast<std::size_t>(indices[seed])])) continue;
    std::vector<std::size_t> members = {seed};
    taken[seed] = true;
    for (std::size_t next = 0; next < members.size(); ++next)
      for (std::size_t n = 0; n < indices.size(); ++n) {
        const auto& p = cloud[static_cast<std::size_t>(indices[members[next]])];
        const auto& q = cloud[static_cast<std::size_t>(indices[n])];
        if (taken[n] || !isFinitePoint(q) || !inContact(p, q, leaf_size)) continue;
        taken[n] = true;
        members.push_back(n);
      }
    std::sort(members.begin(), members.end());  // into the order of the list
    pcl::Indices& cluster = clusters.emplace_back();
    for (const std::size_t n : members) cluster.push_back(indices[n]);
  }
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return clusters;
}

/// Points scattered about the origin, so that all octants are met; some of them not finite.
Cloud::Ptr randomCloud(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<float>(random() % 20001) / 10000.0f - 1.0f; };
  std::vector<Eigen::Vector3f> places;
  for (int n = 0; n < 400; ++n) places.emplace_back(uniform(), uniform(), 0.5f * uniform());
  const Cloud::Ptr cloud = cloudOfPoints(places);
  if (seed % 2 == 1) spoilPoints(*cloud);
  return cloud;
}

class VoxelClusterExtractionRandom : public testing::TestWithParam<std::uint32_t> {};

TEST_P(VoxelClusterExtractionRandom, AgreesWithTheComparisonOfAllPairs) {
  SCOPED_TRACE("seed " + std::to_string(GetParam()));
  const Cloud::Ptr cloud = randomCloud(GetParam());
  pcl::Indices all(cloud->size());
  for (std::size_t n = 0; n < all.size(); ++n) all[n] = static_cast<pcl::index_t>(n);
  for (const double leaf_size : {0.02, 0.07, 0.1, 0.15, 0.5, 10.0})
    EXPECT_EQ(indicesOf(extract(cloud, leaf_size)), bruteForceClusters(*cloud, all, leaf_size))
        << "leaf size " << leaf_size;
}

TEST_P(VoxelClusterExtractionRandom, AgreesOnAnIndexListWithDoubles) {
  SCOPED_TRACE("seed " + std::to_string(GetParam()));
  const Cloud::Ptr cloud = randomCloud(GetParam());
  const pcl::IndicesPtr indices(new pcl::Indices);
  for (int n = 0; n < 250; ++n) indices->push_back(n * 7 % 300);
  EXPECT_EQ(indicesOf(extract(cloud, 0.1, indices)), bruteForceClusters(*cloud, *indices, 0.1));
}

INSTANTIATE_TEST_SUITE_P(Seeds, VoxelClusterExtractionRandom, testing::Range(1U, 9U));

TEST(VoxelClusterExtraction, VoxelsTouchAtACorner) {
  const Cloud::Ptr corner = cloudOfPoints({{0.05f, 0.05f, 0.05f}, {0.15f, 0.15f, 0.15f}});
  EXPECT_EQ(extract(corner, 0.1).size(), 1U);
  const Cloud::Ptr anticorner = cloudOfPoints({{0.05f, 0.15f, 0.05f}, {0.15f, 0.05f, 0.15f}});
  EXPECT_EQ(extract(anticorner, 0.1).size(), 1U);
  const Cloud::Ptr gap = cloudOfPoints({{0.05f, 0.05f, 0.05f}, {0.25f, 0.05f, 0.05f}});
  EXPECT_EQ(extract(gap, 0.1).size(), 2U);
}

TEST(VoxelClusterExtraction, VoxelsDoNotDoubleUpAtTheOrigin) {
  // Rounding towards zero would make one voxel of (-0.1, 0.1), and these three a single cluster.
  const Cloud::Ptr cloud = cloudOfPoints({{-0.15f, 0, 0}, {0.05f, 0, 0}});
  EXPECT_EQ(extract(cloud, 0.1).size(), 2U);
  const Cloud::Ptr across = cloudOfPoints({{-0.05f, -0.05f, -0.05f}, {0.05f, 0.05f, 0.05f}});
  EXPECT_EQ(extract(across, 0.1).size(), 1U);
}

TEST(VoxelClusterExtraction, ClustersFallInSizeEqualOnesStandByTheirFirstPoint) {
  const Cloud::Ptr cloud =
      cloudOfPoints({{9, 0, 0}, {0, 0, 0}, {5, 0, 0}, {5, 0, 0}, {0, 0, 0}, {5, 0, 0}, {-9, 0, 0}});
  const std::vector<pcl::Indices> expected = {{2, 3, 5}, {1, 4}, {0}, {6}};
  EXPECT_EQ(indicesOf(extract(cloud, 0.1)), expected);
}

TEST(VoxelClusterExtraction, SizeLimitsAreInclusive) {
  const Cloud::Ptr cloud = cloudOfPoints({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 0, 0}});
  VoxelClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setInputCloud(cloud);
  extraction.setLeafSize(0.1);
  extraction.setMinClusterSize(2);
  Clusters clusters(5);  // old content
  extraction.extract(clusters);
  EXPECT_EQ(indicesOf(clusters), (std::vector<pcl::Indices>{{3, 4, 5}, {1, 2}}));
  extraction.setMaxClusterSize(2);
  extraction.extract(clusters);
  EXPECT_EQ(indicesOf(clusters), (std::vector<pcl::Indices>{{1, 2}}));
  EXPECT_EQ(extraction.getMinClusterSize(), 2U);
  EXPECT_EQ(extraction.getMaxClusterSize(), 2U);
}

TEST(VoxelClusterExtraction, FarPointsAreClustersOfTheirOwn) {
  const Cloud::Ptr cloud = cloudOfPoints({{0, 0, 0}, {1e6f, 0, 0}, {0.001f, 0, 0}, {3e38f, -3e38f, 0}});
  const std::vector<pcl::Indices> expected = {{0, 2}, {1}, {3}};
  EXPECT_EQ(indicesOf(extract(cloud, 0.02)), expected);
}

TEST(VoxelClusterExtraction, HeaderIsThatOfTheCloud) {
  const Clusters clusters = extract(cloudOfPoints({{0, 0, 0}}), 0.02);
  ASSERT_EQ(clusters.size(), 1U);
  EXPECT_EQ(clusters[0].header.frame_id, "sonar");
  EXPECT_EQ(clusters[0].header.stamp, 1234567U);
}

TEST(VoxelClusterExtraction, NothingToClusterGivesNoClusters) {
  Clusters clusters(3);
  VoxelClusterExtraction<pcl::PointXYZ> extraction;
  const OutputCapture capture;
  extraction.extract(clusters);
  EXPECT_TRUE(clusters.empty());
  EXPECT_NE(capture.standard_error.text().find("No input set"), std::string::npos);
  EXPECT_TRUE(extract(cloudOfPoints({}), 0.1).empty());
  EXPECT_TRUE(extract(cloudOfPoints({Eigen::Vector3f::Constant(NOT_A_NUMBER)}), 0.1).empty());
  EXPECT_TRUE(extract(cloudOfPoints({{0, 0, 0}}), 0.1, pcl::IndicesPtr(new pcl::Indices)).empty());
}

TEST(VoxelClusterExtraction, InvalidIndexIsAnError) {
  for (const pcl::index_t invalid : {-1, 2}) {
    const OutputCapture capture;
    const pcl::IndicesPtr indices(new pcl::Indices{0, invalid});
    EXPECT_TRUE(extract(cloudOfPoints({{0, 0, 0}, {1, 0, 0}}), 0.1, indices).empty());
    EXPECT_NE(capture.standard_error.text().find("VoxelClusterExtraction"), std::string::npos);
    EXPECT_EQ(capture.standard_output.text(), "");
  }
}

TEST(VoxelClusterExtraction, InvalidLeafSizeIsNamedWithItsRange) {
  VoxelClusterExtraction<pcl::PointXYZ> extraction;
  EXPECT_EQ(extraction.getLeafSize(), 0.02);
  extraction.setLeafSize(0.25);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const auto& [value, text] : std::vector<std::pair<double, std::string>>{
           {0.0, "0"}, {-0.5, "-0.5"}, {-1e-9, "-1e-09"}, {infinity, "inf"}, {std::nan(""), "nan"}}) {
    try {
      extraction.setLeafSize(value);
      ADD_FAILURE() << "accepted " << value;
    } catch (const pcl::PCLException& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("leaf size"), std::string::npos) << message;
      EXPECT_NE(message.find(text), std::string::npos) << message;
      EXPECT_NE(message.find("above 0"), std::string::npos) << message;
    }
  }
  EXPECT_EQ(extraction.getLeafSize(), 0.25);
}

TEST(VoxelClusterExtraction, FindsTheBlobsThatPclFinds) {
  std::mt19937 random(3);
  std::vector<Eigen::Vector3f> places;
  for (int n = 0; n < 3000; ++n) {  // three blobs, 0.2 m wide and 1 m apart, their points mixed
    const auto blob = static_cast<float>(n % 6 == 0 ? 0 : n % 6 < 3 ? 1 : 2);
    const auto in_blob = [&] { return static_cast<float>(random() % 1000) * 2e-4f; };
    places.emplace_back(blob - 1 + in_blob(), in_blob(), in_blob());
  }
  const Cloud::Ptr cloud = cloudOfPoints(places);
  std::vector<pcl::Indices> expected = indicesOf(euclideanClusters(cloud, nullptr, 0.1, 10));
  for (pcl::Indices& cluster : expected) std::sort(cluster.begin(), cluster.end());
  ASSERT_EQ(expected.size(), 3U);
  EXPECT_EQ(indicesOf(extract(cloud, 0.1)), expected);
}

}  // namespace
}  // namespace pcl_fft_ground::test
