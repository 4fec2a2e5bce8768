#include "pcl_fft_ground/core/scan/far_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

using test::randomBox;
using test::randomOrder;
using test::uniform;
using FarPoints = std::vector<Eigen::Index>;

FarPoints farPoints(const Points& points) {
  return findFarPoints(points, summarise(points));
}

/// The rule as documented, by sorting each axis.
FarPoints slowFarPoints(const Points& points) {
  const Eigen::Index n = points.cols();
  if (n < 8) return {};
  const Eigen::Index cut = std::max<Eigen::Index>(1, n / 2000);
  Eigen::Array3d low, high;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (Eigen::Index i = 0; i < n; ++i) values.push_back(static_cast<double>(points(axis, i)));
    std::sort(values.begin(), values.end());
    low[axis] = values[static_cast<std::size_t>(cut)];
    high[axis] = values[static_cast<std::size_t>(n - 1 - cut)];
  }
  const double longest_side = (high - low).maxCoeff();
  FarPoints far;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto value = static_cast<double>(points(axis, i));
      const double outside = std::max(low[axis] - value, value - high[axis]);
      if (outside > 3 * longest_side && (far.empty() || far.back() != i)) far.push_back(i);
    }
  return far;
}

/// Points at 0, 1 .. 9 on one axis and one at `stray`: the trimmed box is [1, 9], so 33 is the last near
/// place.
Points lineWithStray(Eigen::Index axis, float stray) {
  Points points = Points::Zero(3, 11);
  for (Eigen::Index n = 0; n < 10; ++n) points(axis, n) = static_cast<float>(n);
  points(axis, 10) = stray;
  return points;
}

TEST(FarPoints, ReachIsThreeSidesOfTheTrimmedBox) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    SCOPED_TRACE(axis);
    EXPECT_EQ(farPoints(lineWithStray(axis, 33.0F)), FarPoints());
    EXPECT_EQ(farPoints(lineWithStray(axis, std::nextafter(33.0F, 100.0F))), FarPoints{10});
    // At the lower end the stray point takes the place of 0: the box is [0, 8].
    EXPECT_EQ(farPoints(lineWithStray(axis, -24.0F)), FarPoints());
    EXPECT_EQ(farPoints(lineWithStray(axis, std::nextafter(-24.0F, -100.0F))), FarPoints{10});
  }
}

TEST(FarPoints, FewerThanEightPointsHaveNone) {
  std::mt19937 random(1);
  for (Eigen::Index count = 0; count <= 9; ++count) {
    SCOPED_TRACE(count);
    Points points = randomBox(count, {0, 0, 0}, {1, 1, 1}, random);
    if (count > 0) points.col(count - 1).setConstant(1e6F);
    EXPECT_EQ(farPoints(points), count < 8 ? FarPoints() : FarPoints{count - 1});
  }
}

TEST(FarPoints, OneInTwoThousandMayBeFarAtEitherEnd) {
  std::mt19937 random(2);
  Points points = randomBox(6000, {-1, -2, 0}, {1, 2, 0.5}, random);
  const FarPoints strays = {0, 17, 999, 3000, 4242, 5999};
  for (std::size_t n = 0; n < strays.size(); ++n) points(0, strays[n]) = n % 2 == 0 ? 1e4F : -1e5F;
  EXPECT_EQ(farPoints(points), strays);
}

TEST(FarPoints, AreTheSameHoweverFar) {
  std::mt19937 random(3);
  for (const Eigen::Index count : {8, 500, 5000}) {
    Points points = randomBox(count, {0, 0, 0}, {4, 4, 1}, random);
    for (const float distance : {20.0F, 1e3F, 1e6F, 1e12F, 3e38F}) {
      SCOPED_TRACE(testing::Message() << count << " points, one at " << distance);
      points.col(5) << 1, distance, 0.5F;
      EXPECT_EQ(farPoints(points), FarPoints{5});
      points.col(5) << -distance, distance, -distance;
      EXPECT_EQ(farPoints(points), FarPoints{5});
    }
  }
}

TEST(FarPoints, DoNotDependOnTheOrderOfThePoints) {
  std::mt19937 random(4);
  Points points = randomBox(3000, {0, 0, 0}, {4, 4, 1}, random);
  points.col(100) << 100, 0, 0;
  const std::vector<Eigen::Index> order = randomOrder(points.cols(), random);
  const FarPoints far = farPoints(points(Eigen::all, order));
  ASSERT_EQ(far.size(), 1U);
  EXPECT_EQ(order[static_cast<std::size_t>(far[0])], 100);
}

class FarPointsOfSeed : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, FarPointsOfSeed, testing::Range(1U, 9U));

TEST_P(FarPointsOfSeed, UsualScansHaveNone) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  for (const Eigen::Index count : {10, 300, 3000, 20000}) {
    SCOPED_TRACE(count);
    EXPECT_EQ(farPoints(randomBox(count, {-50, 3, 0}, {50, 4, 1}, random)), FarPoints());

    Points polar(3, count), log_normal(3, count);
    std::normal_distribution<double> normal;
    for (Eigen::Index n = 0; n < count; ++n) {
      const double angle = uniform(random, 0, 2 * M_PI), range = uniform(random, 0, 30);
      const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0.1);
      polar.col(n) = (range * direction).cast<float>();
      log_normal.col(n) = (std::exp(0.5 * normal(random)) * direction).cast<float>();
    }
    EXPECT_EQ(farPoints(polar), FarPoints());
    EXPECT_EQ(farPoints(log_normal), FarPoints());
  }
}

TEST_P(FarPointsOfSeed, AgreeWithSortedAxes) {
  std::mt19937 random(GetParam());
  for (const Eigen::Index count : {8, 9, 20, 150, 999, 1000, 1001, 1999, 2000, 4001})
    for (Eigen::Index strays = 0; strays <= 5; ++strays) {
      SCOPED_TRACE(testing::Message()
                   << "seed " << GetParam() << ", " << count << " points, " << strays << " strays");
      Points points = randomBox(count, {-1, 0, 5}, {1, 3, 5.1}, random);
      for (Eigen::Index n = 0; n < strays; ++n)
        points(static_cast<Eigen::Index>(random() % 3), static_cast<Eigen::Index>(random()) % count) =
            static_cast<float>(uniform(random, -25, 25));
      EXPECT_EQ(farPoints(points), slowFarPoints(points));
    }
}

// The largest spread that a box allows: all points in two of its faces. A shortcut that looks at the standard
// deviation has the hardest time here.
TEST_P(FarPointsOfSeed, AreFoundBesideTheWidestSpread) {
  std::mt19937 random(GetParam());
  for (const Eigen::Index count : {1000, 1500, 1999, 2000, 3999, 10000})
    for (const float stray : {3.9F, 4.001F, 4.2F, 5.0F, 7.0F, -2.9F, -3.001F, -3.2F}) {
      SCOPED_TRACE(testing::Message()
                   << "seed " << GetParam() << ", " << count << " points, one at " << stray);
      Points points = Points::Zero(3, count);
      const double share = uniform(random, 0.3, 0.7);
      for (Eigen::Index n = 0; n < count; ++n)
        for (Eigen::Index axis = 0; axis < 3; ++axis)
          points(axis, n) = uniform(random, 0, 1) < share ? 1.0F : 0.0F;
      points(static_cast<Eigen::Index>(GetParam() % 3), 7) = stray;
      const bool is_far = stray > 4 || stray < -3;
      EXPECT_EQ(farPoints(points), is_far ? FarPoints{7} : FarPoints());
    }
}

TEST(FarPoints, ClustersBeyondTheCutAreTheScan) {
  Points points = Points::Zero(3, 20);
  points.rightCols(2).row(0).setConstant(50.0F);  // two of twenty: more than the one that is cut off
  points.row(1).setLinSpaced(0, 1);
  EXPECT_EQ(farPoints(points), FarPoints());
}

}  // namespace
}  // namespace pcl_fft_ground::core
