#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "pcl_fft_ground/core/scan/frame.h"
#include "scan/up_evidence.h"

namespace pcl_fft_ground::core {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

UpDirection upOf(const Points& points, FrameParameters parameters = {}) {
  parameters.up_estimation = UpEstimation::AUTO;
  return estimateUp(points, summarise(points), parameters);
}

double degreesBetween(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI;
}

Points turned(const Points& points, const Matrix3d& rotation) {
  return rotation.cast<float>() * points;
}

/// A rolling land of 60 m x 40 m, seen from above, with a box of 4 m x 3 m in each square of 10 m.
Points landWithBoxes(double height, std::uint32_t seed = 3) {
  constexpr Eigen::Index COUNT = 12000;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> noise(0, 0.03);
  Points points(3, COUNT);
  for (Eigen::Index n = 0; n < COUNT; ++n) {
    const double x = 60 * share(random), y = 40 * share(random);
    const bool on_box = std::fmod(x, 10) < 4 && std::fmod(y, 10) < 3;
    const double ground = std::sin(x / 15) + 0.5 * std::cos(y / 9);
    const double top = height * (0.7 + 0.3 * std::sin(13 * std::floor(x / 10) + 5 * std::floor(y / 10)));
    points.col(n) = Vector3d(x, y, ground + (on_box ? top : 0) + noise(random)).cast<float>();
  }
  return points;
}

/// What a rotating laser of 32 beams sees of an even floor 1.7 m below it.
Points floorSeenByLaser() {
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0, 0.01);
  std::vector<Vector3d> hits;
  for (int beam = 0; beam < 32; ++beam)
    for (int turn = 0; turn < 720; ++turn) {
      const double elevation = -(3 + 0.8 * beam) * M_PI / 180, azimuth = turn * 0.5 * M_PI / 180;
      const double range = 1.7 / std::sin(-elevation) + noise(random);
      hits.push_back(range * Vector3d(std::cos(elevation) * std::cos(azimuth),
                                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation)));
    }
  Points points(3, static_cast<Eigen::Index>(hits.size()));
  for (std::size_t n = 0; n < hits.size(); ++n)
    points.col(static_cast<Eigen::Index>(n)) = hits[n].cast<float>();
  return points;
}

/// An even floor of 30 m x 20 m.
Points bareFloor() {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> share(0, 1);
  std::normal_distribution<float> noise(0, 0.01F);
  Points points(3, 6000);
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    points.col(n) = Eigen::Vector3f(30 * share(random), 20 * share(random), noise(random));
  return points;
}

Matrix3d upsideDown() {
  return Vector3d(1, -1, -1).asDiagonal();
}
Matrix3d depthsDown() {
  return Vector3d(1, 1, -1).asDiagonal();
}
Matrix3d yUp() {
  return (Matrix3d() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished();
}
Matrix3d zForward() {
  return (Matrix3d() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished();
}
Matrix3d pitchedCamera() {
  return Eigen::AngleAxisd(-0.6, Vector3d::UnitX()).toRotationMatrix() * zForward();
}

class UpInAnyFrame : public testing::TestWithParam<Matrix3d (*)()> {};
INSTANTIATE_TEST_SUITE_P(Frames, UpInAnyFrame,
                         testing::Values([]() -> Matrix3d { return Matrix3d::Identity(); }, upsideDown,
                                         depthsDown, yUp, zForward, pitchedCamera));

TEST_P(UpInAnyFrame, IsWhereThingsStandOut) {
  const Matrix3d input_from_land = GetParam()();
  for (const double height : {1.0, 3.0, 8.0}) {
    SCOPED_TRACE(height);
    const UpDirection up = upOf(turned(landWithBoxes(height), input_from_land));
    EXPECT_LT(degreesBetween(up.axis, input_from_land * Vector3d::UnitZ()), 6);
    EXPECT_EQ(up.side_from, SideSource::OBJECTS);
    EXPECT_GT(up.axis_confidence, 0.8);
    EXPECT_GT(up.side_confidence, 0.7);
    EXPECT_FALSE(up.reasons.empty());
    EXPECT_TRUE(up.warnings.empty()) << up.warnings.front();
  }
}

TEST_P(UpInAnyFrame, IsOnTheSideOfTheSensorThatTheRaysShow) {
  const Matrix3d input_from_floor = GetParam()();
  const Points points = turned(floorSeenByLaser(), input_from_floor);
  EXPECT_TRUE(showsSensorAtOrigin(points));
  const UpDirection up = upOf(points);
  EXPECT_LT(degreesBetween(up.axis, input_from_floor * Vector3d::UnitZ()), 3);
  EXPECT_EQ(up.side_from, SideSource::SENSOR);
  EXPECT_TRUE(up.warnings.empty()) << up.warnings.front();
}

TEST_P(UpInAnyFrame, IsOnTheSideOfTheSensorGiven) {
  const Matrix3d input_from_floor = GetParam()();
  FrameParameters parameters;
  parameters.sensor_position = input_from_floor * Vector3d(15, 10, 3);
  const UpDirection up = upOf(turned(bareFloor(), input_from_floor), parameters);
  EXPECT_LT(degreesBetween(up.axis, input_from_floor * Vector3d::UnitZ()), 3);
  EXPECT_EQ(up.side_from, SideSource::SENSOR);
  EXPECT_GT(up.side_confidence, 0.9);
}

TEST_P(UpInAnyFrame, StaysAsGiven) {
  const Vector3d given = GetParam()() * Vector3d::UnitZ();
  FrameParameters parameters;
  parameters.up_direction = given;
  const UpDirection up = upOf(turned(landWithBoxes(3), GetParam()()), parameters);
  EXPECT_LT(degreesBetween(up.axis, given), 6);
  EXPECT_EQ(up.side_from, SideSource::GIVEN);
  EXPECT_TRUE(up.warnings.empty()) << up.warnings.front();
  parameters.up_direction = -given;
  const UpDirection wrong = upOf(turned(landWithBoxes(3), GetParam()()), parameters);
  EXPECT_LT(degreesBetween(wrong.axis, -given), 6);
  EXPECT_LT(wrong.side_confidence, 0.3);
  EXPECT_EQ(wrong.warnings.size(), 1U);
}

TEST(Up, IsZWhereNothingTells) {
  const UpDirection up = upOf(bareFloor());
  EXPECT_LT(degreesBetween(up.axis, Vector3d::UnitZ()), 1);
  EXPECT_EQ(up.side_from, SideSource::PRIOR);
  EXPECT_NEAR(up.side_confidence, 0.5, 0.15);
  EXPECT_TRUE(up.warnings.empty());
}

TEST(Up, DoesNotTakeTheOriginOfAMapForASensor) {
  for (const double below : {20.0, 100.0, 780.0}) {
    SCOPED_TRACE(below);
    Points land = landWithBoxes(0.1);  // hardly anything stands out
    land.row(2).array() += static_cast<float>(below);
    EXPECT_FALSE(showsSensorAtOrigin(land));
    const UpDirection up = upOf(land);
    EXPECT_LT(degreesBetween(up.axis, Vector3d::UnitZ()), 6);
    EXPECT_TRUE(up.warnings.empty());
  }
}

TEST(Up, IsZBetweenFloorAndCeiling) {
  const Points floor = bareFloor();
  Points room(3, 2 * floor.cols());
  room << floor, floor;
  room.rightCols(floor.cols()).row(2).array() += 2.6F;
  const UpDirection up = upOf(room);
  EXPECT_LT(degreesBetween(up.axis, Vector3d::UnitZ()), 1);
  EXPECT_EQ(up.side_from, SideSource::PRIOR);
  EXPECT_TRUE(up.warnings.empty());
}

TEST(Up, DoesNotDependOnTheOrderOfThePoints) {
  for (const Points& points :
       {turned(landWithBoxes(2), zForward()), turned(floorSeenByLaser(), upsideDown())}) {
    Points reversed = points.rowwise().reverse();
    const UpDirection a = upOf(points), b = upOf(reversed);
    EXPECT_EQ(a.axis, b.axis);
    EXPECT_EQ(a.side_confidence, b.side_confidence);
    EXPECT_EQ(a.axis_confidence, b.axis_confidence);
  }
}

TEST(Up, OfThePublishedEstimationsIsNotLookedFor) {
  const Points land = turned(landWithBoxes(3), upsideDown());
  for (const UpEstimation estimation : {UpEstimation::PRINCIPAL_AXIS, UpEstimation::GIVEN}) {
    FrameParameters parameters;
    parameters.up_estimation = estimation;
    const UpDirection up = estimateUp(land, summarise(land), parameters);
    EXPECT_LT(degreesBetween(up.axis, Vector3d::UnitZ()), 6);
    EXPECT_EQ(up.side_from, SideSource::GIVEN);
    EXPECT_TRUE(up.warnings.empty());
  }
}

class StripBesideAPit : public testing::TestWithParam<std::tuple<double, double, double>> {};
INSTANTIATE_TEST_SUITE_P(Strips, StripBesideAPit,
                         testing::Combine(testing::Values(2.0, 4.0, 8.0), testing::Values(0.15, 0.3, 0.45),
                                          testing::Values(0.3, 1.0, 3.0)));

TEST_P(StripBesideAPit, DoesNotLeanIntoIt) {
  const auto [width, share_of_width, depth] = GetParam();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> noise(0, 0.02);
  Points points(3, 20000);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const double x = 20 * share(random), y = width * share(random);
    const bool in_pit = y < share_of_width * width && std::abs(x - 10) < 3;
    points.col(n) = Vector3d(x, y, noise(random) - (in_pit ? depth : 0)).cast<float>();
  }
  EXPECT_LT(degreesBetween(upOf(points).axis, Vector3d::UnitZ()), 4);
}

class CrowdedStrip : public testing::TestWithParam<std::tuple<double, double>> {};
INSTANTIATE_TEST_SUITE_P(Strips, CrowdedStrip,
                         testing::Combine(testing::Values(-33.0, -10.0, 0.0, 25.0),
                                          testing::Values(0.3, 0.55, 0.7)));

/// A strip of 6 m x 1.5 m, a share of whose points lies on round heaps that cover one side of it.
TEST_P(CrowdedStrip, StandsOnItsGround) {
  const auto [tilt, on_heaps] = GetParam();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> noise(0, 0.004);
  Points points(3, 20000);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const double x = 6 * share(random), across = on_heaps * share(random);
    const double height = share(random) < 0.9 ? 0.7 * std::sqrt(across) * (1 + 0.3 * std::sin(4 * x)) : 0.0;
    const bool is_heap = share(random) < on_heaps;
    const double y = is_heap ? 1.5 * across : 1.5 * share(random);
    points.col(n) = Vector3d(x, y, noise(random) + (is_heap ? height : 0)).cast<float>();
  }
  const Matrix3d rotation = Eigen::AngleAxisd(tilt * M_PI / 180, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_LT(degreesBetween(upOf(turned(points, rotation)).axis, rotation.col(2)), 4);
}

}  // namespace
}  // namespace pcl_fft_ground::core
