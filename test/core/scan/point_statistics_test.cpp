#include "pcl_fft_ground/core/scan/point_statistics.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

using test::randomBox;
using test::shuffled;

bool equal(const Bounds& a, const Bounds& b) {
  return (a.low == b.low).all() && (a.high == b.high).all();
}

/// Mean and covariance in double, one term after the other.
PointStatistics slowStatistics(const Points& points) {
  PointStatistics result;
  const auto n = static_cast<double>(points.cols());
  for (const auto& point : points.colwise()) result.mean += point.cast<double>() / n;
  for (const auto& point : points.colwise()) {
    const Eigen::Vector3d d = point.cast<double>() - result.mean;
    result.covariance += d * d.transpose() / n;
  }
  return result;
}

TEST(PointStatistics, OfNoPointsAreZero) {
  const PointStatistics statistics = summarise(Points(3, 0));
  EXPECT_TRUE(equal(statistics.bounds, Bounds()));
  EXPECT_TRUE(equal(boundsOf(Points(3, 0)), Bounds()));
  EXPECT_EQ(statistics.mean, Eigen::Vector3d::Zero());
  EXPECT_EQ(statistics.covariance, Eigen::Matrix3d::Zero());
}

TEST(PointStatistics, OfEqualPointsAreExact) {
  for (const Eigen::Index count : {1, 2, 7, 100}) {
    SCOPED_TRACE(count);
    const Eigen::Vector3f place(1.7F, -3e5F, 0.1F);
    const PointStatistics statistics = summarise(place.replicate(1, count));
    EXPECT_EQ(statistics.mean, place.cast<double>());
    EXPECT_EQ(statistics.covariance, Eigen::Matrix3d::Zero());
    EXPECT_TRUE((statistics.bounds.low == statistics.bounds.high).all());
  }
}

TEST(PointStatistics, OfTwoPoints) {
  Points points(3, 2);
  points << 1, 3,  //
      10, 6,       //
      -1, -1;
  const PointStatistics statistics = summarise(points);
  Eigen::Matrix3d covariance;
  covariance << 1, -2, 0,  //
      -2, 4, 0,            //
      0, 0, 0;
  EXPECT_LE((statistics.mean - Eigen::Vector3d(2, 8, -1)).cwiseAbs().maxCoeff(), 4e-6);
  EXPECT_LE((statistics.covariance - covariance).cwiseAbs().maxCoeff(), 2e-5);
}

class StatisticsOfSeed : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, StatisticsOfSeed, testing::Range(1U, 6U));

TEST_P(StatisticsOfSeed, BoundsAreReachedAndHoldAllPoints) {
  std::mt19937 random(GetParam());
  for (Eigen::Index count = 1; count <= 21; ++count) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", " << count << " points");
    const Points points = randomBox(count, {-9, 5, -2}, {-3, 9, 2}, random);
    const Bounds bounds = boundsOf(points);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      float low = points(axis, 0), high = low;
      for (const float value : points.row(axis)) {
        low = std::min(low, value);
        high = std::max(high, value);
      }
      EXPECT_EQ(bounds.low[axis], static_cast<double>(low));
      EXPECT_EQ(bounds.high[axis], static_cast<double>(high));
    }
    EXPECT_TRUE(equal(summarise(points).bounds, bounds));
  }
}

TEST_P(StatisticsOfSeed, AgreeWithSumsInDouble) {
  std::mt19937 random(GetParam());
  for (const Eigen::Index count : {3, 50, 1001, 20000}) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", " << count << " points");
    const Eigen::Vector3d low(test::uniform(random, -1e4, 1e4), test::uniform(random, -10, 10), 0);
    const Points points = randomBox(count, low, low + Eigen::Vector3d(40, 7, 0.3), random);
    const PointStatistics fast = summarise(points), slow = slowStatistics(points);
    constexpr double STEP = 40.0 / (1 << 20);
    EXPECT_LE((fast.mean - slow.mean).cwiseAbs().maxCoeff(), STEP);
    EXPECT_LE((fast.covariance - slow.covariance).cwiseAbs().maxCoeff(), 40 * STEP);
    EXPECT_EQ(fast.covariance, Eigen::Matrix3d(fast.covariance.transpose()));
  }
}

TEST_P(StatisticsOfSeed, DoNotDependOnTheOrderOfThePoints) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  const Points points = randomBox(10001, {100, -7, 0}, {140, 0.1, 1}, random);
  const PointStatistics expected = summarise(points);
  for (int n = 0; n < 4; ++n) {
    const PointStatistics statistics = summarise(shuffled(points, random));
    EXPECT_TRUE(equal(statistics.bounds, expected.bounds));
    EXPECT_EQ(statistics.mean, expected.mean);
    EXPECT_EQ(statistics.covariance, expected.covariance);
  }
}

TEST(PointStatistics, OfTheWidestPointsAreFinite) {
  Points points(3, 3);
  points << -3e38F, 3e38F, 0,  //
      1, 2, 3,                 //
      0, 1e-40F, 0;
  const PointStatistics statistics = summarise(points);
  EXPECT_NEAR(statistics.mean.x(), 0, 1e34);
  EXPECT_NEAR(statistics.covariance(0, 0), 6e76, 1e73);
  EXPECT_TRUE(statistics.mean.allFinite());
  EXPECT_TRUE(statistics.covariance.allFinite());
  EXPECT_EQ(statistics.bounds.high.x(), static_cast<double>(3e38F));
}

TEST(WholeOrigin, IsTheRoundedMedianOfLargeCoordinatesOnly) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(wholeOrigin({}), 0);
  EXPECT_EQ(wholeOrigin({nan, nan}), 0);
  EXPECT_EQ(wholeOrigin({1, 2, 9999}), 0);
  EXPECT_EQ(wholeOrigin({500000.4, nan, 500001.6, 500002.0}), 500002);
  EXPECT_EQ(wholeOrigin({-4100000.4, -4100000.4, 1e30}), -4100000);
}

}  // namespace
}  // namespace pcl_fft_ground::core
