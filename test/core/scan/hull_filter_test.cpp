#include "scan/hull_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "pcl_fft_ground/core/scan/convex_hull.h"
#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

using test::uniform;
using Polygon = std::vector<Eigen::Vector2d>;

/// Seen from straight above, the x axis turned by an angle.
HorizontalProjection fromAbove(const Points& points, double angle) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d centre =
      points.cols() == 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(points.cast<double>().rowwise().mean());
  return {turn.topRows<2>(), centre};
}

Polygon projected(const Points& points, const HorizontalProjection& projection) {
  Polygon result;
  for (const auto& point : points.colwise()) result.push_back(projection(point));
  return result;
}

/// The hull of the outermost points is that of all points, corner by corner.
void expectSameHull(const Points& points) {
  for (const double angle : {0.0, 0.4, 2.0}) {
    SCOPED_TRACE(testing::Message() << "turned by " << angle);
    const HorizontalProjection projection = fromAbove(points, angle);
    EXPECT_EQ(convexHull(outermostPoints(points, projection)), convexHull(projected(points, projection)));
  }
}

class HullFilterOfSeed : public testing::TestWithParam<unsigned> {
 protected:
  std::mt19937 random_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Seeds, HullFilterOfSeed, testing::Range(1U, 6U));

TEST_P(HullFilterOfSeed, SquaresKeepTheirHull) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  for (const Eigen::Index count : {1, 2, 3, 10, 5000, 40000})
    expectSameHull(test::randomBox(count, {-2, -2, 0}, {2, 2, 1}, random_));
  expectSameHull(test::randomBox(20000, {0, 0, 0}, {300, 0.2, 1}, random_));  // a narrow strip
}

TEST_P(HullFilterOfSeed, DiscsKeepTheirHull) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Points disc(3, 30000), ring(3, 30000);
  for (Eigen::Index n = 0; n < disc.cols(); ++n) {
    const double angle = uniform(random_, 0, 2 * M_PI), range = 5 * std::sqrt(uniform(random_, 0, 1));
    const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0);
    disc.col(n) = (range * direction).cast<float>();
    ring.col(n) = (5 * direction).cast<float>();  // every point is a corner, but for rounding
  }
  expectSameHull(disc);
  expectSameHull(ring);
}

TEST_P(HullFilterOfSeed, LargeCoordinatesKeepTheirHull) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  for (const double offset : {1e3, 1e5, 5e6})
    expectSameHull(test::randomBox(20000, {offset, -offset, 10}, {offset + 50, 80 - offset, 20}, random_));
}

TEST_P(HullFilterOfSeed, DuplicatesKeepTheirHull) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  const Points few = test::randomBox(50, {0, 0, 0}, {1, 1, 1}, random_);
  expectSameHull(few.replicate(1, 400));
  expectSameHull(few.col(0).replicate(1, 9000));
}

TEST_P(HullFilterOfSeed, LatticesKeepTheirExtent) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Points lattice = test::randomBox(30000, {0, 0, 0}, {41, 23, 1}, random_);
  lattice.topRows<2>() = lattice.topRows<2>().array().floor();
  const HorizontalProjection projection = fromAbove(lattice, 0.3);
  const Polygon outermost = outermostPoints(lattice, projection), all = projected(lattice, projection);
  // Points along the edges make corners of rounding errors: compare how far the points reach instead.
  for (int degree = 0; degree < 360; ++degree) {
    const Eigen::Vector2d direction(std::cos(degree * M_PI / 180), std::sin(degree * M_PI / 180));
    const auto nearer = [&](const auto& a, const auto& b) { return a.dot(direction) < b.dot(direction); };
    EXPECT_EQ(std::max_element(outermost.begin(), outermost.end(), nearer)->dot(direction),
              std::max_element(all.begin(), all.end(), nearer)->dot(direction));
  }
}

TEST(HullFilter, LinesKeepTheirEnds) {
  Points line(3, 10000);
  for (Eigen::Index n = 0; n < line.cols(); ++n)
    line.col(n) = Eigen::Vector3f(1, 2, 0.5F) * static_cast<float>(n * 7919 % 10000);
  expectSameHull(line);
}

TEST(HullFilter, OfNoPoints) {
  EXPECT_TRUE(outermostPoints(Points(3, 0), fromAbove(Points(3, 0), 0)).empty());
}

TEST(HullFilter, LeavesOutNearlyAllInnerPoints) {
  std::mt19937 random(6);
  const Points points = test::randomBox(100000, {0, 0, 0}, {4, 4, 1}, random);
  EXPECT_LT(outermostPoints(points, fromAbove(points, 0)).size(), 3000U);
}

// What the filter calls inside is inside: every edge of the polygon has it on its left.
TEST_P(HullFilterOfSeed, InsideIsInside) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  const Points corners = test::randomBox(12, {100, 50, 0}, {110, 70, 0}, random_);
  const HorizontalProjection projection = fromAbove(corners, uniform(random_, 0, 3));
  const Polygon hull = convexHull(projected(corners, projection));
  const Points points = test::randomBox(20000, {99, 49, 0}, {111, 71, 0}, random_);
  std::vector<bool> recognised(20000, true);
  for (const Eigen::Index n : HullFilter(hull, projection).outside(points))
    recognised[static_cast<std::size_t>(n)] = false;
  int inside = 0;
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    double nearest_edge = 1e30;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Eigen::Vector2d edge = (hull[(i + 1) % hull.size()] - hull[i]).normalized();
      const Eigen::Vector2d to_point = projection(points.col(n)) - hull[i];
      nearest_edge = std::min(nearest_edge, edge.x() * to_point.y() - edge.y() * to_point.x());
    }
    inside += nearest_edge > 0 ? 1 : 0;
    if (!recognised[static_cast<std::size_t>(n)]) continue;
    EXPECT_GT(nearest_edge, 0) << points.col(n).transpose();
  }
  EXPECT_GT(std::count(recognised.begin(), recognised.end(), true), 0.9 * inside);
}

}  // namespace
}  // namespace pcl_fft_ground::core
