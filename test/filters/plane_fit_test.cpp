#include "pcl_fft_ground/plane_fit.h"

#include <gtest/gtest.h>

#include <optional>
#include <random>

#include "output_capture.h"
#include "random_points.h"

namespace pcl_fft_ground {
namespace {

using core::Plane;
using core::Points;

const Plane TRUE_PLANE{{0.2, -0.1}, 1.5};

/// 2000 points within 5 mm of TRUE_PLANE over 4 m x 4 m, and 800 of a box that stands on it.
Points planeWithBox(std::mt19937& random) {
  Points points(3, 2800);
  points << test::randomBox(2000, {0, 0, -0.005}, {4, 4, 0.005}, random),
      test::randomBox(800, {1, 1, 0.3}, {2, 2, 1.3}, random);
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    points(2, n) +=
        static_cast<float>(TRUE_PLANE.slope.dot(points.col(n).head<2>().cast<double>()) + TRUE_PLANE.offset);
  return points;
}

void expectNoPlaneAndSilence(const Points& points) {
  const test::OutputCapture capture;
  EXPECT_FALSE(fitPlane(points, PlaneFitParameters()).has_value());
  EXPECT_EQ(capture.standard_output.text(), "");
  EXPECT_EQ(capture.standard_error.text(), "");
}

class PlaneFitSeed : public testing::TestWithParam<unsigned> {
 protected:
  std::mt19937 random_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Seeds, PlaneFitSeed, testing::Values(1U, 2U, 3U));

TEST_P(PlaneFitSeed, FindsThePlaneUnderABox) {
  const std::optional<Plane> plane = fitPlane(planeWithBox(random_), PlaneFitParameters());
  ASSERT_TRUE(plane.has_value());
  EXPECT_LT((plane->slope - TRUE_PLANE.slope).norm(), 0.001);
  EXPECT_NEAR(plane->offset, TRUE_PLANE.offset, 0.002);
}

TEST_P(PlaneFitSeed, PointOrderDoesNotMatter) {
  const Points points = planeWithBox(random_);
  const std::optional<Plane> plane = fitPlane(points, PlaneFitParameters());
  const std::optional<Plane> same = fitPlane(test::shuffled(points, random_), PlaneFitParameters());
  ASSERT_TRUE(plane.has_value() && same.has_value());
  EXPECT_EQ(plane->slope, same->slope);
  EXPECT_EQ(plane->offset, same->offset);
}

TEST(PlaneFit, SeedDecidesAboutTheSamples) {
  std::mt19937 random(4);
  const Points points = planeWithBox(random);
  PlaneFitParameters parameters;
  parameters.optimize_coefficients = false;  // as sampled
  const std::optional<Plane> plane = fitPlane(points, parameters);
  const std::optional<Plane> again = fitPlane(points, parameters);
  parameters.seed = 2;
  const std::optional<Plane> other = fitPlane(points, parameters);
  ASSERT_TRUE(plane.has_value() && again.has_value() && other.has_value());
  EXPECT_EQ(plane->slope, again->slope);
  EXPECT_NE(plane->slope, other->slope);
}

TEST(PlaneFit, ThreePointsGiveTheirPlaneAndNothingIsPrinted) {
  Points points(3, 3);
  points << 0, 1, 0,  //
      0, 0, 1,        //
      1, 1.5f, 0;
  const test::OutputCapture capture;
  const std::optional<Plane> plane = fitPlane(points, PlaneFitParameters());
  ASSERT_TRUE(plane.has_value());
  EXPECT_TRUE(plane->slope.isApprox(Eigen::Vector2d(0.5, -1), 1e-5));
  EXPECT_NEAR(plane->offset, 1, 1e-5);
  EXPECT_EQ(capture.standard_output.text() + capture.standard_error.text(), "");
}

TEST(PlaneFit, SamplesInOnePlaceArePassedOverInSilence) {
  std::mt19937 random(6);
  Points points(3, 500);  // many of them the same
  points << test::randomBox(300, {0, 0, 1}, {4, 4, 1}, random), Points::Constant(3, 200, 1.0f);
  const test::OutputCapture capture;
  PlaneFitParameters parameters;
  for (parameters.seed = 1; parameters.seed <= 20; ++parameters.seed) {
    const std::optional<Plane> plane = fitPlane(points, parameters);
    ASSERT_TRUE(plane.has_value()) << parameters.seed;
    EXPECT_LT(plane->slope.norm(), 1e-5);
    EXPECT_NEAR(plane->offset, 1, 1e-5);
  }
  EXPECT_EQ(capture.standard_output.text() + capture.standard_error.text(), "");
}

TEST(PlaneFit, UprightPlaneIsNone) {
  std::mt19937 random(5);
  Points wall = test::randomBox(500, {0, 0, 0}, {2, 0, 2}, random);
  wall.row(1) = 2 * wall.row(0);
  expectNoPlaneAndSilence(wall);
}

TEST(PlaneFit, PointsThatSpanNoPlaneGiveNoneAndNothingIsPrinted) {
  expectNoPlaneAndSilence(Points(3, 0));
  expectNoPlaneAndSilence(Points::Constant(3, 1, 1.0f));
  Points two(3, 2);
  two << 0, 1, 0, 1, 0, 1;
  expectNoPlaneAndSilence(two);
  expectNoPlaneAndSilence(Points::Constant(3, 300, 0.3f));
  const Eigen::RowVectorXf along = Eigen::RowVectorXf::LinSpaced(300, -2, 2);
  expectNoPlaneAndSilence(Eigen::Vector3f(1, -2, 0.5f) * along);
}

TEST(PlaneFit, TheUnitDoesNotMatter) {
  std::mt19937 random(7);
  const Points points = test::randomBox(300, {0, 0, 0}, {0.5, 0.375, 0.01}, random);
  PlaneFitParameters parameters;
  parameters.distance_threshold = 0.005;
  const std::optional<Plane> plane = fitPlane(points, parameters);
  ASSERT_TRUE(plane);
  for (const float scale : {1.0F / 1024, 1024.0F}) {  // nothing is rounded
    parameters.distance_threshold = 0.005 * static_cast<double>(scale);
    const std::optional<Plane> scaled = fitPlane(points * scale, parameters);
    ASSERT_TRUE(scaled) << scale;
    EXPECT_EQ(scaled->slope, plane->slope) << scale;
    EXPECT_EQ(scaled->offset, plane->offset * static_cast<double>(scale)) << scale;
  }
}

}  // namespace
}  // namespace pcl_fft_ground
