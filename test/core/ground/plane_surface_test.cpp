#include "pcl_fft_ground/core/ground/plane_surface.h"

#include <gtest/gtest.h>

#include <random>

#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

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
