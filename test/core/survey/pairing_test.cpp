#include "pcl_fft_ground/core/survey/pairing.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <utility>

namespace pcl_fft_ground::core {
namespace {

using Indices = std::vector<std::pair<std::size_t, std::size_t>>;

Indices indicesOf(const std::vector<SubmapPair>& pairs) {
  Indices result;
  for (const SubmapPair& pair : pairs) result.emplace_back(pair.reference, pair.moving);
  return result;
}

std::vector<Eigen::Vector3d> onALine(const std::vector<double>& places) {
  std::vector<Eigen::Vector3d> centroids;
  for (const double x : places) centroids.emplace_back(x, 0, 0);
  return centroids;
}

Eigen::Isometry3d at(double x, double y, double yaw = 0) {
  return Eigen::Translation3d(x, y, 0) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
}

/// What a scan of 4 m x 2 m covers.
ScanCoverage rectangle() {
  Points points(3, 161 * 81);
  Eigen::Index n = 0;
  for (int i = 0; i <= 160; ++i)
    for (int j = 0; j <= 80; ++j)
      points.col(n++) =
          Eigen::Vector3f(0.025F * static_cast<float>(i) - 2, 0.025F * static_cast<float>(j) - 1, 0);
  return coverageOf(points, 0.05);
}

TEST(ChainPairs, FollowTheNearestThatIsNotInAPair) {
  // What was passed over at -1.5 comes last; its nearest, but for its predecessor at 3, is the first.
  EXPECT_EQ(indicesOf(chainPairs(onALine({0, 1, -1.5, 3}))), (Indices{{0, 1}, {1, 3}, {3, 2}, {2, 0}}));
}

TEST(ChainPairs, AreAsManyAsSubmapsAndTakeEachInOnce) {
  std::vector<Eigen::Vector3d> centroids;
  for (int i = 0; i < 42; ++i) centroids.emplace_back((i * 37) % 41, (i * 11) % 17, 0.1 * i);
  const Indices pairs = indicesOf(chainPairs(centroids));
  ASSERT_EQ(pairs.size(), 42u);
  std::set<std::size_t> moved;
  for (std::size_t k = 0; k + 1 < pairs.size(); ++k) {
    EXPECT_TRUE(moved.insert(pairs[k].second).second);
    EXPECT_EQ(pairs[k + 1].first, pairs[k].second);
  }
  EXPECT_EQ(moved.count(0), 0u);
}

TEST(ChainPairs, OfEquallyNearOnesTakeTheFirst) {
  EXPECT_EQ(indicesOf(chainPairs(onALine({0, 1, -1})))[0], (std::pair<std::size_t, std::size_t>(0, 1)));
}

TEST(ChainPairs, FewSubmapsGiveFewPairs) {
  EXPECT_TRUE(chainPairs({}).empty());
  EXPECT_TRUE(chainPairs(onALine({1})).empty());
  EXPECT_EQ(indicesOf(chainPairs(onALine({1, 2}))), (Indices{{0, 1}}));
}

TEST(OverlapShare, IsThatOfTheAreas) {
  const ScanCoverage scan = rectangle();
  EXPECT_NEAR(overlapShare(scan, scan, at(0, 0)), 1.0, 0.01);
  EXPECT_NEAR(overlapShare(scan, scan, at(1, 0)), 0.75, 0.03);
  EXPECT_NEAR(overlapShare(scan, scan, at(0, 0, EIGEN_PI / 2)), 0.5, 0.03);
  EXPECT_EQ(overlapShare(scan, scan, at(5, 0)), 0.0);
  EXPECT_EQ(overlapShare(scan, ScanCoverage(), at(0, 0)), 0.0);
}

TEST(OtherOverlappingPairs, AreThoseNotListed) {
  const std::vector<ScanCoverage> coverages(4, rectangle());
  const std::vector<Eigen::Isometry3d> poses = {at(0, 0), at(2, 0), at(4.5, 0), at(0, 1, EIGEN_PI)};
  EXPECT_EQ(indicesOf(otherOverlappingPairs(coverages, poses, {{1, 0}}, 0.2)),
            (Indices{{0, 3}, {1, 2}, {1, 3}}));
  EXPECT_EQ(indicesOf(otherOverlappingPairs(coverages, poses, {}, 0.45)), (Indices{{0, 1}, {0, 3}}));
  EXPECT_THROW(otherOverlappingPairs(coverages, {}, {}, 0.2), std::invalid_argument);
}

TEST(OtherOverlappingPairs, AreThoseThatALookAtAllPairsFinds) {
  std::vector<Eigen::Isometry3d> poses;
  for (int n = 0; n < 60; ++n) poses.push_back(at((n * 37) % 41, (n * 11) % 17, 0.3 * n));
  const std::vector<ScanCoverage> coverages(poses.size(), rectangle());
  Indices expected;
  for (std::size_t a = 0; a < poses.size(); ++a)
    for (std::size_t b = a + 1; b < poses.size(); ++b)
      if (overlapShare(coverages[a], coverages[b], poses[a].inverse() * poses[b]) >= 0.05)
        expected.emplace_back(a, b);
  ASSERT_GT(expected.size(), 20U);
  EXPECT_EQ(indicesOf(otherOverlappingPairs(coverages, poses, {}, 0.05)), expected);
}

}  // namespace
}  // namespace pcl_fft_ground::core
