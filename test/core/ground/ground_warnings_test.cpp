#include "pcl_fft_ground/core/ground/ground_warnings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace pcl_fft_ground::core {
namespace {

using Height = std::function<double(double x, double y, double chance)>;

/// Noisy points at random places of a rectangle; those whose height is no number are left out.
Points scanOf(double width, double depth, Eigen::Index count, const Height& height, double noise = 0.02) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> error(0, noise);
  Points points(3, count);
  Eigen::Index kept = 0;
  for (Eigen::Index n = 0; n < count; ++n) {
    const double x = width * share(random), y = depth * share(random), z = height(x, y, share(random));
    if (std::isfinite(z)) points.col(kept++) = Eigen::Vector3d(x, y, z + error(random)).cast<float>();
  }
  points.conservativeResize(Eigen::NoChange, kept);
  return points;
}

std::vector<std::string> warningsOf(const Points& points, const RobustParameters& parameters) {
  const RobustGround ground = estimateRobustGround(points, Eigen::Isometry3d::Identity(), parameters);
  return warningsAbout(ground, points, labelRobust(points, ground).labels, parameters);
}

std::vector<std::string> warningsOf(const Points& points, double max_object_size) {
  RobustParameters parameters;
  parameters.max_object_size = max_object_size;
  return warningsOf(points, parameters);
}

/// One warning, in which all of these words stand.
void expectOne(const std::vector<std::string>& warnings, const std::vector<std::string>& words) {
  ASSERT_EQ(warnings.size(), 1U) << (warnings.empty() ? "" : warnings.back());
  for (const std::string& word : words)
    EXPECT_NE(warnings[0].find(word), std::string::npos) << word << " in: " << warnings[0];
}

/// Rolling land with boxes of 3 m x 3 m, 2 m high.
double landWithBoxes(double x, double y, double) {
  const double ground = 0.5 * std::sin(x / 8) + 0.3 * std::cos(y / 6);
  return ground + (std::fmod(x, 12) < 3 && std::fmod(y, 12) < 3 ? 2 : 0);
}

TEST(GroundWarnings, AreNoneForAnOrdinaryScan) {
  for (const double size : {5.0, 10.0, 20.0}) {
    SCOPED_TRACE(size);
    EXPECT_TRUE(warningsOf(scanOf(60, 50, 30000, landWithBoxes), size).empty());
  }
  EXPECT_TRUE(warningsOf(scanOf(60, 50, 30000, landWithBoxes), RobustParameters()).empty());
}

TEST(GroundWarnings, AreNoneForNoPointsAndForFew) {
  EXPECT_TRUE(warningsOf(Points(3, 0), 1).empty());
  EXPECT_TRUE(warningsOf(scanOf(6, 5, 20, landWithBoxes), 2).empty());
}

TEST(GroundWarnings, TellThatNoPointIsGround) {
  const Points points = scanOf(6, 5, 20, landWithBoxes);
  RobustParameters parameters;
  parameters.max_object_size = 2;
  const RobustGround ground = estimateRobustGround(points, Eigen::Isometry3d::Identity(), parameters);
  expectOne(warningsAbout(ground, points, Labels(20, Label::OBJECT), parameters),
            {"no point", "--max-object-size, 2 m", "--up-direction"});
}

TEST(GroundWarnings, TellAnotherUnit) {
  const Points metres = scanOf(60, 50, 30000, landWithBoxes);
  expectOne(warningsOf(1000 * metres, 5), {"largest object, 5 m", "metres", "--max-object-size"});
  expectOne(warningsOf(Points(metres / 1000), 5), {"5 m exceeds the extent", "0.05", "--max-object-size"});
}

TEST(GroundWarnings, TellDegrees) {
  Points degrees = scanOf(60, 50, 30000, landWithBoxes);
  degrees.topRows<2>() /= 111000;
  RobustParameters parameters;
  const std::vector<std::string> warnings = warningsOf(degrees, parameters);
  expectOne(warnings, {"degrees"});
}

TEST(GroundWarnings, TellThatMostOfTheRectangleIsEmpty) {
  const Points slivers = scanOf(300, 300, 400000, [](double x, double y, double chance) {
    return std::abs(x - y) < 2 ? landWithBoxes(x, y, chance) : NAN;
  });
  const std::vector<std::string> warnings = warningsOf(slivers, 10);
  ASSERT_FALSE(warnings.empty());
  expectOne({warnings[0]}, {"bounding rectangle", "%"});
}

TEST(GroundWarnings, TellThatNoGroundIsSeen) {
  // Boxes alone, as the ground was removed.
  const Points boxes = scanOf(80, 60, 60000, [](double x, double y, double chance) {
    return std::fmod(x, 12) < 4 && std::fmod(y, 9) < 2 ? 0.3 + 1.5 * chance : NAN;
  });
  const std::vector<std::string> warnings = warningsOf(boxes, 5);
  ASSERT_FALSE(warnings.empty());
  expectOne({warnings[0]}, {"no ground is seen", "5 m"});
}

TEST(GroundWarnings, TellThatLittleGroundIsSeen) {
  // Canopy 8 to 15 m above the land; 2 % of the points reach the ground.
  const Points wood = scanOf(60, 50, 40000, [](double x, double y, double chance) {
    return chance < 0.02 ? landWithBoxes(x, y, 0) : 8 + 7 * chance + std::sin(x) + std::cos(y);
  });
  expectOne(warningsOf(wood, 10), {"little or no ground", "%", "--height-tolerance"});
}

TEST(GroundWarnings, TellThatMuchHasNoGroundNearby) {
  const Points points = scanOf(100, 100, 60000, landWithBoxes);
  RobustParameters parameters;
  parameters.max_object_size = 10;
  const RobustGround ground = estimateRobustGround(points, Eigen::Isometry3d::Identity(), parameters);
  const auto warningsWhereGroundEndsAt = [&](float x) {
    Labels labels = labelRobust(points, ground).labels;
    for (std::size_t n = 0; n < labels.size(); ++n)
      if (points(0, static_cast<Eigen::Index>(n)) > x) labels[n] = Label::OBJECT;
    return warningsAbout(ground, points, labels, parameters);
  };
  expectOne(warningsWhereGroundEndsAt(60), {"no ground within the largest object", "10 m"});
  EXPECT_TRUE(warningsWhereGroundEndsAt(80).empty());
}

TEST(GroundWarnings, TellATooLargeTolerance) {
  // A kilometre of land, 15 % of it things eight spreads of the ground high.
  const Points tile = scanOf(
      1000, 1000, 150000,
      [](double x, double y, double) {
        const bool thing = std::fmod(x, 40) < 16 && std::fmod(y, 40) < 15;
        return 2 * std::sin(x / 150) + (thing ? 0.8 : 0);
      },
      0.1);
  expectOne(warningsOf(tile, RobustParameters()),
            {"% of the points", "half of the scan's extent", "--height-tolerance", "--max-object-size"});
  RobustParameters parameters;
  parameters.height_tolerance = 0.5;
  EXPECT_TRUE(warningsOf(tile, parameters).empty());
}

}  // namespace
}  // namespace pcl_fft_ground::core
