#include "pcl_fft_ground/core/segments/object_properties.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double PI = 3.14159265358979323846;

struct Seen {
  Points points;
  std::vector<double> heights;
};

/// The upper half of a body on the plane z = 0, with noise of 1 mm. \param top height at a place, 0 beside
/// the body
template <typename Top>
Seen upperHalf(const Top& top) {
  std::mt19937 random(7);
  std::vector<Eigen::Vector3f> points;
  Seen seen;
  for (double x = -0.8; x < 0.8; x += 0.006)
    for (double y = -0.4; y < 0.4; y += 0.006) {
      const double at_x = x + test::uniform(random, 0, 0.006), at_y = y + test::uniform(random, 0, 0.006);
      const double height = top(at_x, at_y);
      if (!(height > 0)) continue;
      const double z = height + test::uniform(random, -0.001, 0.001);
      points.emplace_back(at_x, at_y, z);
      seen.heights.push_back(z);
    }
  seen.points.resize(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n) seen.points.col(static_cast<Eigen::Index>(n)) = points[n];
  return seen;
}

Seen halfPipe(double length, double radius) {
  return upperHalf([=](double x, double y) {
    return std::abs(x) < 0.5 * length ? std::sqrt(std::max(0.0, radius * radius - y * y)) : 0;
  });
}

Seen halfEllipsoid(double length, double radius) {
  return upperHalf([=](double x, double y) {
    return radius * std::sqrt(std::max(0.0, 1 - std::pow(2 * x / length, 2) - std::pow(y / radius, 2)));
  });
}

constexpr double LEAF = 0.025;

TEST(ObjectProperties, OfAHalfBuriedPipeAreKnown) {
  const Seen seen = halfPipe(1.2, 0.1);
  const ObjectProperties object = measureObject(seen.points, seen.heights, {LEAF});
  EXPECT_EQ(object.points, seen.heights.size());
  EXPECT_NEAR(object.centre.x(), 0, 0.01);
  EXPECT_NEAR(object.footing, 1.2 * 0.2, 0.05 * 1.2 * 0.2);
  EXPECT_NEAR(object.volume, 0.5 * PI * 0.01 * 1.2, 0.03 * 0.5 * PI * 0.01 * 1.2);
  EXPECT_NEAR(object.height, 0.1, 0.003);
  EXPECT_NEAR(object.lengths.x(), 1.2, 0.02);
  EXPECT_NEAR(object.lengths.y(), 0.2, 0.01);
  EXPECT_NEAR(std::abs(object.axes(0, 0)), 1, 1e-3);
  EXPECT_GT(object.steepest, 40);
  EXPECT_FALSE(object.at_border);
  ASSERT_TRUE(object.body.has_value());
  EXPECT_EQ(object.body->shape, RoundBody::Shape::CYLINDER);
  EXPECT_NEAR(object.body->radius, 0.1, 0.002);
  EXPECT_NEAR(object.body->length, 1.2, 0.02);
  EXPECT_NEAR(object.body->centre.norm(), 0, 0.01);
  EXPECT_LT(object.body->residual, 0.002);
}

TEST(ObjectProperties, OfAnEllipsoidAreKnown) {
  const Seen seen = halfEllipsoid(0.9, 0.2);
  const ObjectProperties object = measureObject(seen.points, seen.heights, {LEAF});
  const double volume = 2.0 / 3 * PI * 0.45 * 0.2 * 0.2;
  EXPECT_NEAR(object.volume, volume, 0.03 * volume);
  ASSERT_TRUE(object.body.has_value());
  EXPECT_EQ(object.body->shape, RoundBody::Shape::ELLIPSOID);
  EXPECT_NEAR(object.body->radius, 0.2, 0.005);
  EXPECT_NEAR(object.body->length, 0.9, 0.02);
}

TEST(ObjectProperties, TurnWithTheObject) {
  const Seen seen = halfPipe(1.2, 0.1);
  const Eigen::AngleAxisd turn(0.7, Eigen::Vector3d(1, 2, 0.5).normalized());
  const Eigen::Vector3d shift(3, -2, 10);
  const Points moved =
      ((turn.toRotationMatrix() * seen.points.cast<double>()).colwise() + shift).cast<float>();
  const ObjectProperties object = measureObject(moved, seen.heights, {LEAF, turn * Eigen::Vector3d::UnitZ()});
  EXPECT_NEAR(object.volume, 0.5 * PI * 0.01 * 1.2, 0.03 * 0.5 * PI * 0.01 * 1.2);
  ASSERT_TRUE(object.body.has_value());
  EXPECT_NEAR(object.body->radius, 0.1, 0.003);
  EXPECT_NEAR((object.body->centre - shift).norm(), 0, 0.01);
  EXPECT_NEAR(std::abs(object.body->axis.dot(turn * Eigen::Vector3d::UnitX())), 1, 1e-3);
}

TEST(ObjectProperties, AStepHasNoRoundBody) {
  const Seen seen = upperHalf(
      [](double x, double y) { return std::abs(x) < 0.3 && std::abs(y) < 0.3 ? (x < 0 ? 0.05 : 0.4) : 0; });
  EXPECT_FALSE(measureObject(seen.points, seen.heights, {LEAF}).body.has_value());
}

TEST(ObjectProperties, DoNotDependOnTheOrderOfThePoints) {
  const Seen seen = halfEllipsoid(0.9, 0.2);
  std::mt19937 random(3);
  const std::vector<Eigen::Index> order = test::randomOrder(seen.points.cols(), random);
  std::vector<double> heights;
  for (const Eigen::Index n : order) heights.push_back(seen.heights[static_cast<std::size_t>(n)]);
  const ObjectProperties a = measureObject(seen.points, seen.heights, {LEAF});
  const ObjectProperties b = measureObject(seen.points(Eigen::all, order), heights, {LEAF});
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.centre, b.centre);
  EXPECT_EQ(a.axes, b.axes);
  ASSERT_TRUE(a.body && b.body);
  EXPECT_EQ(a.body->radius, b.body->radius);
}

TEST(ObjectProperties, TellWhatTheBorderOfTheScanCuts) {
  std::mt19937 random(9);
  const ScanCoverage coverage =
      coverageOf(test::randomBox(40000, {-1, -0.5, 0}, {1, 0.5, 0}, random), 2.5 * LEAF);
  Seen seen = halfPipe(0.6, 0.1);
  EXPECT_FALSE(
      measureObject(seen.points, seen.heights, {LEAF, Eigen::Vector3d::UnitZ(), &coverage}).at_border);
  seen.points.row(0).array() += 0.7F;
  EXPECT_TRUE(
      measureObject(seen.points, seen.heights, {LEAF, Eigen::Vector3d::UnitZ(), &coverage}).at_border);
}

TEST(ObjectProperties, OfFewPoints) {
  EXPECT_EQ(measureObject(Points(3, 0), {}).points, 0U);
  const ObjectProperties one = measureObject(Eigen::Vector3f(1, 2, 3), {0.5});
  EXPECT_EQ(one.centre, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(one.lengths, Eigen::Vector3d::Zero());
  EXPECT_EQ(one.height, 0.5);
  EXPECT_FALSE(one.body);
  EXPECT_TRUE(std::isnan(measureObject(Eigen::Vector3f(1, 2, 3), {}).volume));
  EXPECT_THROW(measureObject(Points::Zero(3, 2), {0.1}), std::invalid_argument);
  EXPECT_THROW(measureObject(Points::Zero(3, 2), {}, {0}), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_fft_ground::core
