#include "pcl_fft_ground/object_cluster_extraction.h"

#include <gtest/gtest.h>
#include <pcl/exceptions.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "clouds.h"
#include "output_capture.h"

namespace pcl_fft_ground::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Clusters = std::vector<pcl::PointIndices>;
using Extraction = ObjectClusterExtraction<pcl::PointXYZ>;

/// Two half balls of 0.2 m and 0.15 m that touch, and a third one apart, seen from above.
Eigen::Matrix3Xf balls() {
  const Eigen::Array3Xd centres = (Eigen::Array3Xd(3, 3) << 0, 0.34, 1, 0, 0, 0, 0.2, 0.15, 0.1).finished();
  std::vector<Eigen::Vector3f> points;
  for (double x = -0.3; x < 1.2; x += 0.007)
    for (double y = -0.3; y < 0.3; y += 0.007) {
      double height = 0;
      for (Eigen::Index b = 0; b < 3; ++b) {
        const double square = std::pow(centres(2, b), 2) - std::pow(x - centres(0, b), 2) - y * y;
        if (square > 0) height = std::max(height, std::sqrt(square));
      }
      if (height > 0.01) points.emplace_back(x, y, height);
    }
  Eigen::Matrix3Xf matrix(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n) matrix.col(static_cast<Eigen::Index>(n)) = points[n];
  return matrix;
}

Extraction extractionOf(const Cloud::ConstPtr& cloud) {
  Extraction extraction;
  extraction.setInputCloud(cloud);
  extraction.setLeafSize(0.028);
  extraction.setMinimumObjectSize(0.1);
  return extraction;
}

Clusters extract(Extraction extraction) {
  Clusters clusters(3);  // old content
  extraction.extract(clusters);
  return clusters;
}

TEST(ObjectClusterExtraction, TellsTouchingThingsApart) {
  const Cloud::Ptr cloud = cloudOf<pcl::PointXYZ>(balls());
  const Clusters clusters = extract(extractionOf(cloud));
  ASSERT_EQ(clusters.size(), 3U);
  std::size_t total = 0;
  for (const pcl::PointIndices& cluster : clusters) {
    EXPECT_EQ(cluster.header.frame_id, cloud->header.frame_id);
    total += cluster.indices.size();
  }
  EXPECT_EQ(total, cloud->size());
  EXPECT_LT((*cloud)[static_cast<std::size_t>(clusters[0].indices[0])].x, 0.2F) << "the largest first";
}

TEST(ObjectClusterExtraction, KeepsToIndicesAndFinitePoints) {
  Eigen::Matrix3Xf points = balls();
  points(2, 10) = std::numeric_limits<float>::quiet_NaN();
  const Cloud::Ptr cloud = cloudOf<pcl::PointXYZ>(points);
  pcl::IndicesPtr indices(new pcl::Indices);
  for (pcl::index_t n = static_cast<pcl::index_t>(cloud->size()) - 1; n >= 5; --n) indices->push_back(n);
  Extraction extraction = extractionOf(cloud);
  extraction.setIndices(indices);
  std::vector<int> times(cloud->size(), 0);
  for (const pcl::PointIndices& cluster : extract(extraction)) {
    EXPECT_TRUE(std::is_sorted(cluster.indices.rbegin(), cluster.indices.rend()))
        << "not in the list's order";
    for (const pcl::index_t n : cluster.indices) ++times[static_cast<std::size_t>(n)];
  }
  for (std::size_t n = 0; n < times.size(); ++n) EXPECT_EQ(times[n], n >= 5 && n != 10 ? 1 : 0) << n;
}

TEST(ObjectClusterExtraction, LooksAlongTheGivenUp) {
  const Eigen::Matrix3f turn =
      Eigen::AngleAxisf(1.2F, Eigen::Vector3f(1, 2, 0.5F).normalized()).toRotationMatrix();
  Extraction extraction = extractionOf(cloudOf<pcl::PointXYZ>(turn * balls()));
  extraction.setUpDirection(3 * turn.col(2).cast<double>());
  EXPECT_NEAR(extraction.getUpDirection().norm(), 1, 1e-12);
  EXPECT_EQ(extract(extraction).size(), 3U);
}

TEST(ObjectClusterExtraction, LeavesOutClustersOfOtherSizes) {
  Extraction extraction = extractionOf(cloudOf<pcl::PointXYZ>(balls()));
  const Clusters all = extract(extraction);
  ASSERT_EQ(all.size(), 3U);
  extraction.setMinClusterSize(static_cast<pcl::uindex_t>(all[1].indices.size()));
  extraction.setMaxClusterSize(static_cast<pcl::uindex_t>(all[1].indices.size()));
  const Clusters middle = extract(extraction);
  ASSERT_EQ(middle.size(), 1U);
  EXPECT_EQ(middle[0].indices, all[1].indices);
}

TEST(ObjectClusterExtraction, TakesHeightsOfTheCloudOrOfTheIndicesOnly) {
  const Cloud::Ptr cloud = cloudOf<pcl::PointXYZ>(balls());
  Extraction extraction = extractionOf(cloud);
  const std::size_t clusters = extract(extraction).size();
  extraction.setHeightAboveGround(std::vector<double>(cloud->size(), 0.1));
  EXPECT_EQ(extract(extraction).size(), clusters);
  extraction.setHeightAboveGround({0.1, 0.2});
  StreamCapture capture(stderr);
  EXPECT_TRUE(extract(extraction).empty());
  EXPECT_NE(capture.text().find("2 heights"), std::string::npos);
}

TEST(ObjectClusterExtraction, HasDefaultsAndRefusesWhatIsNoLength) {
  Extraction extraction;
  EXPECT_DOUBLE_EQ(extraction.getLeafSize(), 0.02);
  EXPECT_DOUBLE_EQ(extraction.getMinimumObjectSize(), 0.09);
  extraction.setLeafSize(0.1);
  EXPECT_DOUBLE_EQ(extraction.getMinimumObjectSize(), 0.45);
  extraction.setMinimumObjectSize(0.3);
  EXPECT_DOUBLE_EQ(extraction.getMinimumObjectSize(), 0.3);
  for (const double bad : {0.0, -0.1, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(extraction.setLeafSize(bad), pcl::PCLException);
    EXPECT_THROW(extraction.setMinimumObjectSize(bad), pcl::PCLException);
  }
  EXPECT_THROW(extraction.setUpDirection(Eigen::Vector3d::Zero()), pcl::PCLException);
}

TEST(ObjectClusterExtraction, OfNothingIsNothing) {
  StreamCapture capture(stderr);
  EXPECT_TRUE(extract(Extraction()).empty());
  EXPECT_TRUE(extract(extractionOf(Cloud::Ptr(new Cloud))).empty());
  Extraction extraction = extractionOf(cloudOf<pcl::PointXYZ>(balls()));
  extraction.setIndices(pcl::IndicesPtr(new pcl::Indices{0, 1000000}));
  EXPECT_TRUE(extract(extraction).empty());
}

}  // namespace
}  // namespace pcl_fft_ground::test
