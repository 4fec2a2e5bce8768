#include "pcl_fft_ground/core/scan/frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>
#include <utility>

#include "pcl_fft_ground/simulation/simulation.h"
#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double DEGREE = M_PI / 180;
constexpr UpEstimation ALL_UP_ESTIMATIONS[] = {UpEstimation::AUTO, UpEstimation::PRINCIPAL_AXIS,
                                               UpEstimation::GIVEN};
constexpr Yaw ALL_YAWS[] = {Yaw::MIN_AREA_RECTANGLE, Yaw::PRINCIPAL_AXES, Yaw::NONE};

Isometry3d frameOf(const Points& points, const FrameParameters& parameters) {
  return estimateFrame(points, summarise(points), parameters);
}

/// A lattice of 11 x 11 x 11 points that fills a box: its principal axes are those of the box, exactly.
Points boxLattice(const Vector3d& half_sides) {
  Points points(3, 1331);
  for (int n = 0; n < 1331; ++n)
    points.col(n) =
        (Vector3d(n % 11 - 5, n / 11 % 11 - 5, n / 121 - 5) / 5).cwiseProduct(half_sides).cast<float>();
  return points;
}

Points rotated(const Points& points, const Matrix3d& rotation, const Vector3d& shift = Vector3d::Zero()) {
  return ((rotation * points.cast<double>()).colwise() + shift).cast<float>();
}

/// Leans by an angle towards +x.
Matrix3d leaning(double degrees) {
  return AngleAxisd(degrees * DEGREE, Vector3d::UnitY()).toRotationMatrix();
}

Vector3d upOf(const Isometry3d& frame_from_input) {
  return frame_from_input.linear().row(2).transpose();
}

void expectProper(const Isometry3d& frame) {
  EXPECT_LE((frame.linear() * frame.linear().transpose() - Matrix3d::Identity()).cwiseAbs().maxCoeff(),
            1e-14);
  EXPECT_NEAR(frame.linear().determinant(), 1, 1e-14);
  EXPECT_TRUE(frame.translation().allFinite());
}

/// Sides of the axis-aligned box around points.
Vector3d sidesOf(const Points& points) {
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).cast<double>();
}

class FrameOfPose : public testing::TestWithParam<std::tuple<int, int>> {};
INSTANTIATE_TEST_SUITE_P(TiltsAndYaws, FrameOfPose,
                         testing::Combine(testing::Values(0, 1, 15, 30, 45, 60),
                                          testing::Range(-180, 180, 24)));

TEST_P(FrameOfPose, IsRecovered) {
  const auto [tilt, yaw] = GetParam();
  const Vector3d half_sides(3, 2, 0.05);
  for (const int direction : {0, 100, 245}) {
    SCOPED_TRACE(testing::Message() << "tilt " << tilt << ", yaw " << yaw << ", towards " << direction);
    const Matrix3d pose = AngleAxisd(direction * DEGREE, Vector3d::UnitZ()) * leaning(tilt) *
                          AngleAxisd(yaw * DEGREE, Vector3d::UnitZ()).toRotationMatrix();
    const Points points = rotated(boxLattice(half_sides), pose, {7, -20, 3});
    for (const UpEstimation up : {UpEstimation::PRINCIPAL_AXIS, UpEstimation::AUTO})
      for (const Yaw in_plane : ALL_YAWS) {
        if (up == UpEstimation::AUTO && tilt >= 45) continue;
        const Isometry3d frame = frameOf(points, {Vector3d::UnitZ(), up, in_plane});
        expectProper(frame);
        EXPECT_LE((upOf(frame) - pose.col(2)).norm(), 1e-5);
        const Points level = transformed(points, frame);
        EXPECT_LE(level.cast<double>().rowwise().mean().norm(), 1e-5);
        const Vector3d sides = sidesOf(level);
        EXPECT_NEAR(sides.z(), 0.1, 1e-4);
        if (in_plane == Yaw::PRINCIPAL_AXES) {
          EXPECT_LE((sides.head<2>() - Eigen::Vector2d(6, 4)).norm(), 1e-3);
        }
        if (in_plane == Yaw::MIN_AREA_RECTANGLE) {
          EXPECT_NEAR(sides.head<2>().minCoeff(), 4, 1e-4);
          EXPECT_NEAR(sides.head<2>().maxCoeff(), 6, 1e-4);
        }
      }
  }
}

TEST(Frame, UpPointsAlongTheReference) {
  const Points points = rotated(boxLattice({3, 2, 0.05}), leaning(20));
  for (const Vector3d& reference :
       {Vector3d(0, 0, 1), Vector3d(0, 0, -5), Vector3d(1, 0, 0.1), Vector3d(-2, 0, 0.1)}) {
    const Isometry3d frame = frameOf(points, {reference, UpEstimation::PRINCIPAL_AXIS, Yaw::NONE});
    expectProper(frame);
    EXPECT_GT(upOf(frame).dot(reference), 0) << reference.transpose();
    EXPECT_NEAR(std::abs(upOf(frame).dot(leaning(20).col(2))), 1, 1e-9);
  }
}

TEST(Frame, OfTheGivenVerticalIsExactlyTheInput) {
  std::mt19937 random(1);
  const Points points = test::randomBox(1000, {0, 0, 0}, {4, 3, 5}, random);
  for (const double length : {1.0, 0.3, 7.0}) {
    const Isometry3d frame = frameOf(points, {Vector3d(0, 0, length), UpEstimation::GIVEN, Yaw::NONE});
    EXPECT_EQ(frame.linear(), Matrix3d(Matrix3d::Identity()));
    EXPECT_EQ(frame.translation(), Vector3d(-summarise(points).mean));
  }
}

TEST(Frame, TheGivenUpIsReachedByTheSmallestRotation) {
  std::mt19937 random(2);
  const Points points = test::randomBox(100, {0, 0, 0}, {4, 3, 5}, random);
  for (int n = 0; n < 50; ++n) {
    const Vector3d up(test::uniform(random, -1, 1), test::uniform(random, -1, 1),
                      test::uniform(random, -1, 1));
    const Isometry3d frame = frameOf(points, {up, UpEstimation::GIVEN, Yaw::NONE});
    expectProper(frame);
    EXPECT_LE((frame.linear() * up.normalized() - Vector3d::UnitZ()).norm(), 1e-14);
    EXPECT_NEAR(AngleAxisd(frame.linear()).angle(), std::acos(up.normalized().z()), 1e-7);
  }
}

TEST(Frame, UpMayPointDown) {
  std::mt19937 random(3);
  const Points points = test::randomBox(100, {0, 0, 0}, {4, 3, 5}, random);
  for (const double lean : {0.0, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-3}) {
    SCOPED_TRACE(lean);
    const Vector3d up(lean, -lean, -1);
    const Isometry3d frame = frameOf(points, {up, UpEstimation::GIVEN, Yaw::NONE});
    expectProper(frame);
    EXPECT_LE((frame.linear() * up.normalized() - Vector3d::UnitZ()).norm(), 1e-14);
  }
}

// A fifth: the box is as thick as it is wide along its shorter horizontal axis, times this ratio.
TEST(Frame, AutoTrustsFlatClouds) {
  for (const auto& [ratio, trusted] : {std::pair(0.05, true), {0.195, true}, {0.205, false}, {0.9, false}}) {
    SCOPED_TRACE(ratio);
    const Points points = rotated(boxLattice({3, 2, 2 * ratio}), leaning(30));
    const Vector3d up = upOf(frameOf(points, {Vector3d::UnitZ(), UpEstimation::AUTO, Yaw::NONE}));
    // The flattest half of a thick box, which AUTO goes by, need not lie quite along its sides.
    const double tolerance = trusted && ratio > 0.1 ? 0.1 : 1e-5;
    EXPECT_LE((up - (trusted ? Vector3d(leaning(30).col(2)) : Vector3d(0, 0, 1))).norm(), tolerance);
    const Vector3d axis = upOf(frameOf(points, {Vector3d::UnitZ(), UpEstimation::PRINCIPAL_AXIS, Yaw::NONE}));
    EXPECT_LE((axis - leaning(30).col(2)).norm(), 1e-5);
  }
}

TEST(Frame, AutoTrustsUprightClouds) {
  for (const auto& [lean, trusted] : {std::pair(10.0, true), {44.5, true}, {45.5, false}, {85.0, false}}) {
    SCOPED_TRACE(lean);
    const Points points = rotated(boxLattice({3, 2, 0.05}), leaning(lean));
    const Vector3d up = upOf(frameOf(points, {Vector3d::UnitZ(), UpEstimation::AUTO, Yaw::NONE}));
    EXPECT_LE((up - (trusted ? Vector3d(leaning(lean).col(2)) : Vector3d(0, 0, 1))).norm(), 1e-5);
    // What counts is the angle from the given direction, not from z.
    const Vector3d reference = leaning(lean - 30).col(2);
    EXPECT_LE(
        (upOf(frameOf(points, {reference, UpEstimation::AUTO, Yaw::NONE})) - leaning(lean).col(2)).norm(),
        1e-5);
  }
}

/// 63 % of the points of a strip 1.5 m wide lie on pipes: the flattest half lies askew on them.
TEST(Frame, AutoLevelsANarrowStripByWhatLiesBelowTheObjects) {
  SimulationParameters parameters;
  parameters.scene = SceneKind::PIPES;
  parameters.seed = 106;
  parameters.points = 100000;
  parameters.object_share = 0.634;
  parameters.tilt_degrees = -8.4;
  parameters.gap_share = 0.08;
  parameters.outlier_share = 0.008;
  const SimulatedScan scan = simulateScan(parameters);
  FrameParameters frame;
  frame.up_estimation = UpEstimation::AUTO;
  const Vector3d up =
      estimateFrame(scan.points, summarise(scan.points), frame).linear().transpose() * Vector3d::UnitZ();
  const Vector3d true_up = scan.world_from_scan.linear().transpose() * Vector3d::UnitZ();
  EXPECT_GE(up.dot(true_up), std::cos(4 * M_PI / 180));
}

TEST(Frame, PointsWithoutAPlaneTakeTheGivenUp) {
  Points line(3, 500);
  for (Eigen::Index n = 0; n < line.cols(); ++n)
    line.col(n) = Eigen::Vector3f(1, 2, 3) * static_cast<float>(n);
  const Points one = Eigen::Vector3f(4, 5, 6), same = one.replicate(1, 20), two = line.leftCols(2);
  const Points vertical = Eigen::Vector3f::UnitZ() * Eigen::RowVectorXf::LinSpaced(30, 0, 3);
  const Vector3d given = Vector3d(0.1, -0.3, 1).normalized();
  for (const Points& points : {one, same, two, line, vertical})
    for (const UpEstimation up : ALL_UP_ESTIMATIONS)
      for (const Yaw yaw : ALL_YAWS) {
        SCOPED_TRACE(testing::Message() << points.cols() << " points");
        const Isometry3d frame = frameOf(points, {given, up, yaw});
        expectProper(frame);
        EXPECT_LE((upOf(frame) - given).norm(), 1e-14);
        const Vector3d middle = points.cast<double>().rowwise().mean();
        EXPECT_LE((frame * middle).norm(), 1e-5 * (1 + sidesOf(points).norm()));
      }
}

TEST(Frame, OfAVerticalWall) {
  const Points wall = boxLattice({3, 0.01, 2});
  EXPECT_LE(
      (upOf(frameOf(wall, {Vector3d::UnitZ(), UpEstimation::AUTO, Yaw::NONE})) - Vector3d::UnitZ()).norm(),
      0);
  const Isometry3d principal = frameOf(wall, {Vector3d::UnitZ(), UpEstimation::PRINCIPAL_AXIS, Yaw::NONE});
  expectProper(principal);
  EXPECT_NEAR(std::abs(upOf(principal).y()), 1, 1e-9);
}

TEST(Frame, OfNoPointsIsTheInput) {
  for (const UpEstimation up : ALL_UP_ESTIMATIONS)
    EXPECT_EQ(frameOf(Points(3, 0), {Vector3d(1, 0, 0), up, Yaw::MIN_AREA_RECTANGLE}).matrix(),
              Eigen::Matrix4d(Eigen::Matrix4d::Identity()));
}

class FrameOfSeed : public testing::TestWithParam<unsigned> {
 protected:
  std::mt19937 random_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Seeds, FrameOfSeed, testing::Range(1U, 5U));

/// Scattered points in a rectangle, its corners among them.
Points rectangle(double width, double depth, std::mt19937& random) {
  Points points = test::randomBox(20000, {-width / 2, -depth / 2, 0}, {width / 2, depth / 2, 0.3}, random);
  for (int n = 0; n < 4; ++n)
    points.col(n) = Vector3d(n % 2 == 0 ? -width : width, n < 2 ? -depth : depth, 0).cast<float>() / 2;
  return points;
}

TEST_P(FrameOfSeed, TheGridLiesAlongARectangle) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  // A square looks the same after a quarter turn: the least turn is taken for it as for any other rectangle.
  for (const double depth : {4.0, 2.5})
    for (const int degrees : {-80, -44, -30, 0, 1, 20, 44, 60, 100}) {
      SCOPED_TRACE(testing::Message() << "4 m x " << depth << " m turned by " << degrees);
      const Matrix3d turn = AngleAxisd(degrees * DEGREE, Vector3d::UnitZ()).toRotationMatrix();
      const Points points = rotated(rectangle(4, depth, random_), turn);
      const Isometry3d frame =
          frameOf(points, {Vector3d::UnitZ(), UpEstimation::GIVEN, Yaw::MIN_AREA_RECTANGLE});
      const double yaw = std::atan2(frame.linear()(1, 0), frame.linear()(0, 0));
      EXPECT_NEAR(yaw, -std::remainder(degrees, 90.0) * DEGREE, 1e-5);
      const Vector3d sides = sidesOf(transformed(points, frame));
      EXPECT_NEAR(sides.x() * sides.y(), 4 * depth, 1e-4);
    }
}

TEST_P(FrameOfSeed, DoesNotDependOnTheOrderOfThePoints) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Points lattice = test::randomBox(20000, {0, 0, 0}, {40, 23, 3}, random_);
  lattice = rotated(lattice.array().floor(), leaning(10));
  const Points scattered =
      rotated(test::randomBox(20000, {0, 0, 0}, {4, 4, 1}, random_), leaning(25), {1000, 7, 0});
  for (const Points& points : {lattice, scattered})
    for (const UpEstimation up : ALL_UP_ESTIMATIONS)
      for (const Yaw yaw : ALL_YAWS) {
        const FrameParameters parameters = {Vector3d(0.1, 0.2, 1), up, yaw};
        const Isometry3d expected = frameOf(points, parameters);
        for (int n = 0; n < 3; ++n)
          EXPECT_EQ(frameOf(test::shuffled(points, random_), parameters).matrix(), expected.matrix());
      }
}

TEST(Transformed, IsRigidAndInDouble) {
  std::mt19937 random(9);
  const Points points = test::randomBox(200, {1e5, -1e5, 0}, {1e5 + 40, 40 - 1e5, 5}, random);
  const Isometry3d frame(AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()) *
                         Eigen::Translation3d(-1e5, 1e5, 0));
  const Points result = transformed(points, frame);
  ASSERT_EQ(result.cols(), points.cols());
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    EXPECT_LE((result.col(n).cast<double>() - frame * Vector3d(points.col(n).cast<double>())).norm(), 1e-5);
  EXPECT_EQ(transformed(Points(3, 0), frame).cols(), 0);
}

}  // namespace
}  // namespace pcl_fft_ground::core
