#include "pcl_fft_ground/core/ground/ground_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

using test::uniform;

constexpr double CELL = 0.25;

/// A surface of these heights whose first cell centre lies at (10, -3).
GroundSurface surfaceOf(const Eigen::ArrayXXd& height) {
  const Eigen::Vector2d origin(10 - CELL / 2, -3 - CELL / 2);
  return {Eigen::Isometry3d::Identity(), {origin, CELL, height.rows(), height.cols()}, height};
}

double plane(double x, double y) {
  return 3 + 0.7 * x - 0.2 * y;
}

GroundSurface planeSurface(Eigen::Index rows, Eigen::Index cols) {
  Eigen::ArrayXXd height(rows, cols);
  for (Eigen::Index j = 0; j < cols; ++j)
    for (Eigen::Index i = 0; i < rows; ++i)
      height(i, j) = plane(10 + CELL * static_cast<double>(i), -3 + CELL * static_cast<double>(j));
  return surfaceOf(height);
}

/// The weighted sum over all cell centres; a centre weighs by its nearness in units of cells.
double slowHeightAt(const GroundSurface& surface, double x, double y) {
  const Eigen::Index rows = surface.height.rows(), cols = surface.height.cols();
  const double u = std::min(std::max((x - 10) / CELL, 0.0), static_cast<double>(rows - 1));
  const double v = std::min(std::max((y + 3) / CELL, 0.0), static_cast<double>(cols - 1));
  double height = 0;
  for (Eigen::Index j = 0; j < cols; ++j)
    for (Eigen::Index i = 0; i < rows; ++i)
      height += std::max(0.0, 1 - std::abs(u - static_cast<double>(i))) *
                std::max(0.0, 1 - std::abs(v - static_cast<double>(j))) * surface.height(i, j);
  return height;
}

TEST(GroundSurface, IsExactForPlanesAndContinuesItsBorder) {
  constexpr Eigen::Index ROWS = 7, COLS = 5;
  const GroundSurface surface = planeSurface(ROWS, COLS);
  constexpr double X_LAST = 10 + CELL * (ROWS - 1), Y_LAST = -3 + CELL * (COLS - 1);
  for (double x = 9.5; x < 12.5; x += 0.11)
    for (double y = -3.6; y < -1; y += 0.13)
      EXPECT_NEAR(surface.heightAt(x, y), plane(std::clamp(x, 10.0, X_LAST), std::clamp(y, -3.0, Y_LAST)),
                  1e-13)
          << x << ", " << y;
  EXPECT_NEAR(surface.heightAt(-1e6, 1e6), plane(10, Y_LAST), 1e-13);
  EXPECT_NEAR(surface.heightAt(1e30, -1e30), plane(X_LAST, -3), 1e-13);
}

TEST(GroundSurface, OfOneCellIsLevel) {
  const GroundSurface surface = surfaceOf(Eigen::ArrayXXd::Constant(1, 1, 4.5));
  for (const double x : {-100.0, 10.0, 10.1, 500.0}) EXPECT_EQ(surface.heightAt(x, 2 * x), 4.5);
}

TEST(GroundSurface, OfOneLineOfCellsVariesAlongIt) {
  for (const double across : {-50.0, 0.0, 50.0}) {
    EXPECT_NEAR(planeSurface(6, 1).heightAt(10.6, -3 + across), plane(10.6, -3), 1e-13);
    EXPECT_NEAR(planeSurface(1, 6).heightAt(10 + across, -2.3), plane(10, -2.3), 1e-13);
  }
}

class GroundSurfaceOfSeed : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, GroundSurfaceOfSeed, testing::Range(1U, 6U));

TEST_P(GroundSurfaceOfSeed, IsBilinear) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  for (const Eigen::Index rows : {1, 2, 3, 9})
    for (const Eigen::Index cols : {1, 2, 8}) {
      SCOPED_TRACE(testing::Message() << rows << " x " << cols);
      const GroundSurface surface = surfaceOf(test::randomGrid(rows, cols, random));
      for (int n = 0; n < 50; ++n) {
        const double x = uniform(random, 9, 13), y = uniform(random, -4, 0);
        ASSERT_NEAR(surface.heightAt(x, y), slowHeightAt(surface, x, y), 1e-13) << x << ", " << y;
      }
      EXPECT_NEAR(surface.heightAt(10, -3), surface.height(0, 0), 1e-15);
    }
}

TEST_P(GroundSurfaceOfSeed, HeightIsMeasuredAlongTheTiltedUp) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  GroundSurface surface = planeSurface(9, 9);
  const Eigen::Vector3d axis(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
  surface.frame_from_input = Eigen::Translation3d(4, -7, 2) * Eigen::AngleAxisd(1.1, axis.normalized());
  for (int n = 0; n < 20; ++n) {
    const double x = uniform(random, 10, 12), y = uniform(random, -3, -1), height = uniform(random, -2, 2);
    const Eigen::Vector3d level(x, y, plane(x, y) + height);
    EXPECT_NEAR(surface.heightAbove(surface.frame_from_input.inverse() * level), height, 1e-12);
  }
}

TEST_P(GroundSurfaceOfSeed, LabelsFollowFromTheHeight) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  const GroundSurface surface = surfaceOf(test::randomGrid(8, 12, random));
  const Points points = test::randomBox(500, {9, -4, -1}, {13, 1, 1}, random);
  for (const double tolerance : {0.0, 0.3}) {
    const Labels labels = labelByHeight(points, surface, tolerance);
    ASSERT_EQ(labels.size(), 500U);
    std::size_t objects = 0;
    for (Eigen::Index n = 0; n < points.cols(); ++n) {
      const Eigen::Vector3d p = points.col(n).cast<double>();
      const bool is_object = p.z() - slowHeightAt(surface, p.x(), p.y()) > tolerance;
      objects += is_object ? 1U : 0U;
      EXPECT_EQ(labels[static_cast<std::size_t>(n)], is_object ? Label::OBJECT : Label::GROUND) << n;
    }
    EXPECT_GT(objects, 50U);
    EXPECT_LT(objects, 450U);
  }
}

TEST(LabelByHeight, APointAtTheToleranceIsGround) {
  const GroundSurface surface = surfaceOf(Eigen::ArrayXXd::Constant(3, 4, 1.5));
  for (const float tolerance : {0.0F, 0.25F}) {
    SCOPED_TRACE(tolerance);
    const float height = 1.5F + tolerance;
    Points points(3, 4);
    points.row(0).setConstant(10.4F);
    points.row(1).setConstant(-2.7F);
    points.row(2) << height, std::nextafter(height, 9.0F), std::nextafter(height, 0.0F), -1e30F;
    const Labels expected = {Label::GROUND, Label::OBJECT, Label::GROUND, Label::GROUND};
    EXPECT_EQ(labelByHeight(points, surface, static_cast<double>(tolerance)), expected);
  }
}

TEST(LabelByHeight, OfNoPoints) {
  EXPECT_TRUE(labelByHeight(Points(3, 0), planeSurface(3, 3), 0).empty());
  EXPECT_TRUE(labelByHeight(Points(3, 0), GroundSurface(), 0).empty());
}

const Plane SLOPE{{0.5, -0.25}, 3};

double heightOf(const Plane& plane, double x, double y) {
  return plane.slope.x() * x + plane.slope.y() * y + plane.offset;
}

GroundSurface surfaceOver(double x_low, double y_low, double x_high, double y_high) {
  return planeSurface(Eigen::Isometry3d::Identity(), {{x_low, y_low, 0}, {x_high, y_high, 1}}, SLOPE);
}

TEST(PlaneSurface, IsThePlaneAllOverTheBounds) {
  std::mt19937 random(1);
  for (const double depth : {0.0, 2.0, 9.0}) {
    SCOPED_TRACE(depth);
    const GroundSurface surface = surfaceOver(-1, 4, 3, 4 + depth);
    for (int n = 0; n < 100; ++n) {
      const double x = test::uniform(random, -1, 3), y = test::uniform(random, 4, 4 + depth);
      EXPECT_NEAR(surface.heightAt(x, y), heightOf(SLOPE, x, y), 1e-12);
    }
  }
}

TEST(PlaneSurface, IsFlatBeyondTheBounds) {
  const GroundSurface surface = surfaceOver(-1, 4, 3, 8);
  EXPECT_NEAR(surface.heightAt(-50, 5), heightOf(SLOPE, -1, 5), 1e-12);
  EXPECT_NEAR(surface.heightAt(50, 5), heightOf(SLOPE, 3, 5), 1e-12);
  EXPECT_NEAR(surface.heightAt(0, -50), heightOf(SLOPE, 0, 4), 1e-12);
  EXPECT_NEAR(surface.heightAt(0, 50), heightOf(SLOPE, 0, 8), 1e-12);
}

TEST(PlaneSurface, BoundsOfOnePlace) {
  const GroundSurface surface = surfaceOver(2, 5, 2, 5);
  EXPECT_NEAR(surface.heightAt(2, 5), heightOf(SLOPE, 2, 5), 1e-12);
}

TEST(PlaneSurface, StandsInTheLevelFrame) {
  Eigen::Isometry3d frame_from_input = Eigen::Isometry3d::Identity();
  frame_from_input.translate(Eigen::Vector3d(1, 2, -7)).rotate(Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5));
  const GroundSurface surface = planeSurface(frame_from_input, {{-1, 4, 0}, {3, 8, 1}}, SLOPE);
  const Eigen::Vector3d above(0, 5, heightOf(SLOPE, 0, 5) + 0.3);
  EXPECT_NEAR(surface.heightAbove(frame_from_input.inverse() * above), 0.3, 1e-12);
}

}  // namespace
}  // namespace pcl_fft_ground::core
