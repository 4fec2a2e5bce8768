#include "pcl_fft_ground/core/scan/convex_hull.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

using test::uniform;
using Polygon = std::vector<Eigen::Vector2d>;

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d ab = b - a, ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x();
}

Polygon turned(const Polygon& polygon, double angle) {
  Polygon result;
  for (const Eigen::Vector2d& corner : polygon) result.push_back(Eigen::Rotation2Dd(angle) * corner);
  return result;
}

Polygon regularPolygon(int corners) {
  Polygon polygon;
  for (int n = 0; n < corners; ++n)
    polygon.push_back(Eigen::Rotation2Dd(2 * M_PI * n / corners) * Eigen::Vector2d(1, 0));
  return polygon;
}

/// Area of the rectangle around points, its sides along axes turned by the angle.
double areaAt(const Polygon& polygon, double angle) {
  Eigen::Array2d low(std::numeric_limits<double>::max(), std::numeric_limits<double>::max()), high = -low;
  for (const Eigen::Vector2d& corner : turned(polygon, -angle)) {
    low = low.min(corner.array());
    high = high.max(corner.array());
  }
  return (high - low).prod();
}

Polygon randomCloud(int count, std::mt19937& random) {
  Polygon points;
  for (int n = 0; n < count; ++n) points.emplace_back(uniform(random, -3, 5), uniform(random, 10, 12));
  return points;
}

TEST(ConvexHull, IsCounterClockwiseFromTheLowestX) {
  const Polygon square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  EXPECT_EQ(convexHull({{2, 2}, {1, 1}, {0, 2}, {0.5, 1.5}, {2, 0}, {0, 0}}), square);
}

TEST(ConvexHull, LeavesOutDuplicatesAndPointsOnEdges) {
  const Polygon triangle = {{0, 0}, {4, 0}, {0, 4}};
  EXPECT_EQ(convexHull({{0, 0}, {1, 0}, {4, 0}, {4, 0}, {2, 2}, {3, 1}, {0, 4}, {0, 2}, {0, 0}}), triangle);
}

TEST(ConvexHull, OfDegenerateSets) {
  EXPECT_EQ(convexHull({}), Polygon());
  EXPECT_EQ(convexHull({{1, 2}}), (Polygon{{1, 2}}));
  EXPECT_EQ(convexHull({{1, 2}, {1, 2}, {1, 2}}), (Polygon{{1, 2}}));
  EXPECT_EQ(convexHull({{3, 4}, {1, 2}}), (Polygon{{1, 2}, {3, 4}}));
  EXPECT_EQ(convexHull({{2, 3}, {5, 6}, {1, 2}, {3, 4}, {5, 6}}), (Polygon{{1, 2}, {5, 6}}));
  EXPECT_EQ(convexHull({{1, 7}, {1, 2}, {1, 5}}), (Polygon{{1, 2}, {1, 7}}));
}

class ConvexHullOfSeed : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, ConvexHullOfSeed, testing::Range(1U, 9U));

// A point is a corner exactly if some line through it has all other points strictly on one side: an edge i ->
// j of the hull is a pair with all others on its left.
TEST_P(ConvexHullOfSeed, HasTheEdgesThatLeaveAllPointsOnTheLeft) {
  std::mt19937 random(GetParam());
  for (const int count : {3, 4, 7, 30, 80}) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", " << count << " points");
    const Polygon points = randomCloud(count, random);
    const Polygon hull = convexHull(points);
    std::size_t edges = 0;
    for (const Eigen::Vector2d& a : points)
      for (const Eigen::Vector2d& b : points) {
        const bool is_edge = a != b && std::all_of(points.begin(), points.end(), [&](const auto& p) {
                               return p == a || p == b || turn(a, b, p) > 0;
                             });
        if (!is_edge) continue;
        ++edges;
        const auto corner = std::find(hull.begin(), hull.end(), a);
        ASSERT_NE(corner, hull.end());
        EXPECT_EQ(corner + 1 == hull.end() ? hull.front() : *(corner + 1), b);
      }
    EXPECT_EQ(hull.size(), edges);
  }
}

TEST_P(ConvexHullOfSeed, HasNoSmallerRectangle) {
  std::mt19937 random(GetParam());
  for (const int count : {3, 5, 20, 200}) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", " << count << " points");
    const Polygon hull = convexHull(randomCloud(count, random));
    const double angle = minimumAreaRectangleAngle(hull);
    EXPECT_GT(angle, -M_PI_4);
    EXPECT_LE(angle, M_PI_4);
    const double area = areaAt(hull, angle);
    for (int n = 0; n < 3000; ++n) ASSERT_LE(area, areaAt(hull, n * M_PI_2 / 3000) * (1 + 1e-9)) << n;
  }
}

TEST(MinimumAreaRectangle, LiesAlongATurnedRectangle) {
  const Polygon rectangle = {{-3, -1}, {3, -1}, {3, 1}, {-3, 1}};
  for (int degrees = -180; degrees <= 180; degrees += 5) {
    SCOPED_TRACE(degrees);
    const double angle = minimumAreaRectangleAngle(convexHull(turned(rectangle, degrees * M_PI / 180)));
    EXPECT_GT(angle, -M_PI_4);
    EXPECT_LE(angle, M_PI_4);
    const double difference = std::remainder(angle - degrees * M_PI / 180, M_PI_2);
    EXPECT_NEAR(difference, 0, 1e-12);
  }
}

TEST(MinimumAreaRectangle, OfEqualOnesTheLeastTurnedIsTaken) {
  constexpr double DEGREE = M_PI / 180;
  // An octagon has two directions, 45 degrees apart; a dodecagon three, 30 degrees apart.
  EXPECT_NEAR(minimumAreaRectangleAngle(convexHull(turned(regularPolygon(8), 22.5 * DEGREE))), 0, 1e-12);
  EXPECT_NEAR(minimumAreaRectangleAngle(convexHull(turned(regularPolygon(8), 32.5 * DEGREE))), 10 * DEGREE,
              1e-12);
  EXPECT_NEAR(minimumAreaRectangleAngle(convexHull(turned(regularPolygon(8), 12.5 * DEGREE))), -10 * DEGREE,
              1e-12);
  EXPECT_NEAR(minimumAreaRectangleAngle(convexHull(turned(regularPolygon(12), 35 * DEGREE))), -10 * DEGREE,
              1e-12);
}

TEST(MinimumAreaRectangle, AnEighthOfATurnIsPositive) {
  EXPECT_EQ(minimumAreaRectangleAngle(convexHull({{0, 0}, {1, 1}, {0, 2}, {-1, 1}})), M_PI_4);
}

TEST(MinimumAreaRectangle, OfFewCorners) {
  EXPECT_EQ(minimumAreaRectangleAngle({}), 0);
  EXPECT_EQ(minimumAreaRectangleAngle({{3, 4}}), 0);
  EXPECT_NEAR(minimumAreaRectangleAngle({{0, 0}, {2, 1}}), std::atan2(1, 2), 1e-15);
  EXPECT_NEAR(minimumAreaRectangleAngle({{0, 0}, {1, 2}}), -std::atan2(1, 2), 1e-15);
}

}  // namespace
}  // namespace pcl_fft_ground::core
