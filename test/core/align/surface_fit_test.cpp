#include "align/surface_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "align/verdict.h"
#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double VOXEL = 0.05;

/// Points evenly over a sphere or, with `lowest` above -1, over the cap of it above that height.
Points sphereAround(const Eigen::Vector3d& centre, double radius, double lowest = -1) {
  constexpr Eigen::Index COUNT = 40000;
  Points points(3, COUNT);
  for (Eigen::Index n = 0; n < COUNT; ++n) {
    const double z = lowest + (1 - lowest) * (static_cast<double>(n) + 0.5) / COUNT;
    const double angle = static_cast<double>(n) * 2.399963229728653, across = std::sqrt(1 - z * z);
    const Eigen::Vector3d direction(across * std::cos(angle), across * std::sin(angle), z);
    points.col(n) = (centre + radius * direction).cast<float>();
  }
  return points;
}

TEST(ViewField, ByRayTellsBeforeOnAndBehindASurface) {
  const Eigen::Vector3d sensor(1, 2, 3);
  const ViewField view(sphereAround(sensor, 5), sensor, 1);
  EXPECT_FALSE(view.isFromAbove());
  std::mt19937 random(1);
  for (int n = 0; n < 200; ++n) {
    const Eigen::Vector3d way =
        test::randomBox(1, {-1, -1, -1}, {1, 1, 1}, random).cast<double>().normalized();
    EXPECT_EQ(view.at(sensor + 3 * way, 0.1), Sight::EMPTY) << way.transpose();
    EXPECT_EQ(view.at(sensor + 5 * way, 0.1), Sight::SURFACE) << way.transpose();
    EXPECT_EQ(view.at(sensor + 8 * way, 0.1), Sight::UNSEEN) << way.transpose();
  }
  EXPECT_EQ(view.at(sensor, 0.1), Sight::UNSEEN);
}

TEST(ViewField, ByRayHasNotSeenWhereItDidNotLook) {
  const Eigen::Vector3d sensor(0, 0, 0);
  const ViewField view(sphereAround(sensor, 5, 0), sensor, 1);
  EXPECT_EQ(view.at({0, 0, 3}, 0.1), Sight::EMPTY);
  EXPECT_EQ(view.at({0, 0, -3}, 0.1), Sight::UNSEEN);
}

TEST(ViewField, RaysSpreadInProportionToTheDistance) {
  const ViewField view(sphereAround(Eigen::Vector3d::Zero(), 5), Eigen::Vector3d(0, 0, 0), 1);
  EXPECT_GT(view.spacingAt({3, 0, 0}), 0);
  EXPECT_DOUBLE_EQ(view.spacingAt({0, 6, 0}), 2 * view.spacingAt({3, 0, 0}));
}

/// Two level sheets one above the other, x and y from 0 to 10.
Points sheets(double upper, double lower) {
  std::mt19937 random(2);
  Points points = test::randomBox(20000, {0, 0, 0}, {10, 10, 0}, random);
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    points(2, n) = static_cast<float>(n % 2 == 0 ? upper : lower);
  return points;
}

TEST(ViewField, FromAboveTellsAboveOnAndBelowASurface) {
  const ViewField view(sheets(0, 0), std::nullopt, 0.5);
  EXPECT_TRUE(view.isFromAbove());
  EXPECT_EQ(view.at({5, 5, 1}, 0.1), Sight::EMPTY);
  EXPECT_EQ(view.at({5, 5, 0}, 0.1), Sight::SURFACE);
  EXPECT_EQ(view.at({5, 5, -1}, 0.1), Sight::UNSEEN);
  EXPECT_EQ(view.at({25, 5, 0}, 0.1), Sight::UNSEEN);
  EXPECT_EQ(view.spacingAt({5, 5, 0}), 0);
}

TEST(ViewField, IsUnclearWhereItSawThingsAtManyDistances) {
  EXPECT_EQ(ViewField(sheets(3, 0), std::nullopt, 0.5).at({5, 5, 1.5}, 0.1), Sight::UNCLEAR);
}

/// What a scan of a yard holds besides its level floor.
struct Yard {
  bool has_walls = true;
  std::vector<Eigen::Vector2d> boxes = {};  ///< their lower corners; they are 0.6 m wide and 0.5 m high
};

/// A floor of 4 m x 4 m, walls along x = 0 and y = 0, and boxes; 2 mm of noise.
ScanSegments scanOf(const Yard& yard, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Points> parts{test::randomBox(20000, {0, 0, 0}, {4, 4, 0}, random)};
  if (yard.has_walls) {
    parts.push_back(test::randomBox(10000, {0, 0, 0}, {0, 4, 2}, random));
    parts.push_back(test::randomBox(10000, {0, 0, 0}, {4, 0, 2}, random));
  }
  for (Eigen::Index n = 0; n < parts[0].cols(); ++n)
    for (const Eigen::Vector2d& box : yard.boxes) {
      const Eigen::Array2d within = parts[0].col(n).head<2>().cast<double>().array() - box.array();
      if ((within > 0).all() && (within < 0.6).all()) parts[0](2, n) = 0.5F;
    }
  Eigen::Index total = 0;
  for (const Points& part : parts) total += part.cols();
  Points points(3, total);
  Eigen::Index first = 0;
  for (const Points& part : parts) {
    points.middleCols(first, part.cols()) = part;
    first += part.cols();
  }
  points += test::randomBox(total, {-0.002, -0.002, -0.002}, {0.002, 0.002, 0.002}, random);
  SegmentParameters parameters;
  parameters.voxel_size = VOXEL;
  return describeScan(points, Labels(static_cast<std::size_t>(total), Label::GROUND), parameters);
}

Eigen::Isometry3d offBy(double x, double y, double z, double degrees) {
  return Eigen::Translation3d(x, y, z) *
         Eigen::AngleAxisd(degrees * EIGEN_PI / 180, Eigen::Vector3d::UnitZ());
}

double distanceFromIdentity(const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d middle(2, 2, 0);
  return (pose * middle - middle).norm();
}

const AlignmentParameters PARAMETERS;

/// Two scans of one yard, each in the same frame.
class Yards : public testing::Test {
 protected:
  const ScanSegments moving_ = scanOf({}, 1), reference_ = scanOf({}, 2);
  const ScanPair pair_{moving_, reference_, Eigen::Isometry3d::Identity(), PARAMETERS};
  const SurfaceFit fit_{pair_};
};

TEST_F(Yards, AreApproachedFromAfar) {
  const Eigen::Isometry3d near = fit_.approach(offBy(0.3, -0.2, 0.1, 4), 0.6);
  EXPECT_LT(distanceFromIdentity(near), VOXEL);
}

TEST_F(Yards, AreRefinedToWithinTheDeviationPredicted) {
  const IcpResult result = fit_.refine(offBy(0.3 * VOXEL, -0.3 * VOXEL, 0.2 * VOXEL, 0.1));
  EXPECT_LT(distanceFromIdentity(result.correction), 0.002);
  const std::optional<Matrix6d> covariance = covarianceAboutCentre(result);
  ASSERT_TRUE(covariance);
  const Eigen::Vector3d moved = result.correction * result.centre - result.centre;
  for (Eigen::Index k = 0; k < 3; ++k) EXPECT_LT(std::abs(moved[k]), 4 * std::sqrt((*covariance)(k, k))) << k;
}

TEST_F(Yards, HaveTheMostEvidenceWhereTheyLieOnEachOther) {
  const SurfaceEvidence right = fit_.at(Eigen::Isometry3d::Identity());
  EXPECT_GT(right.share(), 0.8);
  EXPECT_GT(right.leastShare(), 0.7);
  EXPECT_GT(right.seen, 0.9);
  EXPECT_LT(right.misplaced, 0.01);
  for (const Eigen::Vector3d& way :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 0, 1)}) {
    const Eigen::Vector3d shift = 2 * VOXEL * way;
    EXPECT_LT(fit_.at(offBy(shift.x(), shift.y(), shift.z(), 0)).evidence, 0.8 * right.evidence)
        << way.transpose();
  }
}

// The floor agrees still, and so does the other wall. (Nearer than two cells of the view from above a wall
// stands in columns that hold a wall of the other scan, too: it tells nothing there.)
TEST_F(Yards, ShiftedSidewaysAgreeInTheOtherDirectionsOnly) {
  const SurfaceEvidence shifted = fit_.at(offBy(10 * VOXEL, 0, 0, 0));
  EXPECT_LT(shifted.leastShare(), 0.1);
  EXPECT_GT(shifted.share(), 0.4);
}

TEST_F(Yards, SayTheSameTheOtherWayRound) {
  const ScanPair back(reference_, moving_, Eigen::Isometry3d::Identity(), PARAMETERS);
  const SurfaceFit fit_back(back);
  const Eigen::Isometry3d pose = offBy(0.5 * VOXEL, 0.3 * VOXEL, 0, 0.3);
  const SurfaceEvidence there = fit_.at(pose), and_back = fit_back.at(pose.inverse());
  EXPECT_NEAR(and_back.evidence, there.evidence, 0.01 * std::abs(there.evidence));
  EXPECT_NEAR(and_back.share(), there.share(), 0.01);
  EXPECT_NEAR(and_back.seen, there.seen, 0.01);
}

TEST_F(Yards, AreDisplacedByWhatAShiftIs) {
  EXPECT_NEAR(fit_.displacement(offBy(0.1, 0, 0, 0), offBy(0.1, 0.3, 0, 0)), 0.3, 1e-6);
  EXPECT_EQ(fit_.displacement(offBy(0.1, 0, 0, 2), offBy(0.1, 0, 0, 2)), 0);
}

TEST(SurfaceFit, OfAFloorIsHeldInHeightOnly) {
  const ScanSegments moving = scanOf({false, {}}, 3), reference = scanOf({false, {}}, 4);
  const ScanPair pair(moving, reference, Eigen::Isometry3d::Identity(), PARAMETERS);
  const IcpResult result = SurfaceFit(pair).refine(Eigen::Isometry3d::Identity());
  ASSERT_GT(result.information(2, 2), 0);
  EXPECT_LT(result.information(0, 0), 1e-3 * result.information(2, 2));
  EXPECT_LT(result.information(1, 1), 1e-3 * result.information(2, 2));
}

TEST(SurfaceFit, CountsWhatStandsWhereTheOtherScanLookedThrough) {
  const auto misplacedOf = [](const Yard& moving_yard, const Yard& reference_yard) {
    const ScanSegments moving = scanOf(moving_yard, 5), reference = scanOf(reference_yard, 6);
    const ScanPair pair(moving, reference, Eigen::Isometry3d::Identity(), PARAMETERS);
    return SurfaceFit(pair).at(Eigen::Isometry3d::Identity()).misplaced;
  };
  const Yard here{true, {{1, 1}, {2.5, 1}}}, there{true, {{1, 2.5}, {2.5, 2.5}}}, nowhere;
  EXPECT_GT(misplacedOf(here, there), 0.01);
  EXPECT_LT(misplacedOf(here, here), 0.002);
  // What has come or gone is missing from one scan only.
  EXPECT_LT(misplacedOf(here, nowhere), 0.002);
}

}  // namespace
}  // namespace pcl_fft_ground::core
