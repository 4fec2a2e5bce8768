#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "analytic_worlds.h"
#include "pcl_fft_ground/core/ground/robust_ground.h"
#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

using test::scatteredOn;
using test::uniform;

constexpr double SIDE = 4;  // of a scene [m]; the largest object has 1 m

/// Boulders of 0.16 to 0.5 m on a square lattice, every other one in x shifted. \return height [m], 0 between
double boulderHeight(double x, double y) {
  constexpr double SPACING = 0.8;
  const double column = std::floor(x / SPACING);
  const double u = x - (column + 0.5) * SPACING;
  const double row = std::floor(y / SPACING + 0.5 * column);
  const double v = y - (row - 0.5 * column + 0.5) * SPACING;
  const double radius = 0.08 + 0.04 * std::abs(std::fmod(column + 2 * row, 5.0));
  const double inside = 1 - (u * u + v * v) / (radius * radius);
  return inside > 0 ? 1.5 * radius * std::sqrt(inside) : 0;
}

struct Land {
  const char* name;
  double (*height)(double, double);
};

void PrintTo(const Land& land, std::ostream* stream) {
  *stream << land.name;
}

struct LabelledScan {
  Points points;
  std::vector<double> object_heights;
};

LabelledScan scanOf(const Land& land, double (*object_height)(double, double)) {
  std::mt19937 random(1);
  LabelledScan scan;
  scan.points = scatteredOn(
      150000, SIDE, SIDE,
      [&](double x, double y) {
        scan.object_heights.push_back(object_height(x, y));
        return land.height(x, y) + scan.object_heights.back() + uniform(random, -0.004, 0.004);
      },
      random);
  return scan;
}

struct Shares {
  double objects_found, ground_kept;
};

/// The foot of an object, lower than 3 cm, does not count.
Shares sharesOf(const LabelledScan& scan) {
  RobustParameters parameters;
  parameters.max_object_size = 1;
  const RobustGround ground = estimateRobustGround(scan.points, Eigen::Isometry3d::Identity(), parameters);
  const Labels labels = labelRobust(scan.points, ground).labels;
  double objects = 0, found = 0, bare = 0, kept = 0;
  for (std::size_t n = 0; n < labels.size(); ++n) {
    const bool is_object = labels[n] == Label::OBJECT;
    if (scan.object_heights[n] > 0.03) objects += 1, found += is_object ? 1 : 0;
    if (scan.object_heights[n] == 0) bare += 1, kept += is_object ? 0 : 1;
  }
  return {found / std::max(objects, 1.0), kept / std::max(bare, 1.0)};
}

class BrokenLand : public testing::TestWithParam<Land> {};
INSTANTIATE_TEST_SUITE_P(
    Lands, BrokenLand,
    testing::Values(Land{"step", [](double x, double) { return x > 2.1 ? 1.0 : 0.0; }},
                    Land{"quayWall", [](double x, double y) { return x > 1.8 + 0.1 * y ? 3.0 : 0.02 * y; }},
                    Land{"trench", [](double x, double) { return std::abs(x - 2) < 0.35 ? -0.5 : 0.0; }},
                    Land{"channel", [](double x, double y) { return std::abs(x - y) < 1.2 ? -0.5 : 0.0; }},
                    Land{"terraces", [](double x, double) { return 0.5 * std::floor(x / 1.35); }},
                    Land{"narrowTerraces", [](double x, double) { return 0.4 * std::floor(x / 0.75); }},
                    Land{"pit",
                         [](double x, double y) { return std::hypot(x - 2, y - 2) < 0.9 ? -0.8 : 0.0; }},
                    Land{"platform",
                         [](double x, double y) {
                           return std::max(std::abs(x - 2), std::abs(y - 2)) < 1.1 ? 0.5 : 0.0;
                         }}),
    [](const auto& land) { return land.param.name; });

TEST_P(BrokenLand, IsGroundOnBothSidesOfTheBreak) {
  const Shares shares = sharesOf(scanOf(GetParam(), [](double, double) { return 0.0; }));
  EXPECT_GE(shares.ground_kept, 0.93);
}

TEST_P(BrokenLand, GivesItsBouldersAway) {
  const Shares shares = sharesOf(scanOf(GetParam(), boulderHeight));
  EXPECT_GE(shares.objects_found, 0.94);
  EXPECT_GE(shares.ground_kept, 0.92);
}

constexpr Land FLAT{"flat", [](double, double) { return 0.0; }};

TEST(BrokenLandTest, AnObjectOfTheLargestSizeIsNoTerrace) {
  const auto box = [](double x, double y) {
    return std::max(std::abs(x - 2), std::abs(y - 2)) < 0.45 ? 0.3 : 0.0;
  };
  const Shares shares = sharesOf(scanOf(FLAT, box));
  EXPECT_GE(shares.objects_found, 0.99);
  EXPECT_GE(shares.ground_kept, 0.99);
}

TEST(BrokenLandTest, ALongPipeIsNoTerrace) {
  const auto pipe = [](double x, double) {
    const double u = (x - 2) / 0.15;
    return std::abs(u) < 1 ? 0.15 + 0.15 * std::sqrt(1 - u * u) : 0.0;
  };
  EXPECT_GE(sharesOf(scanOf(FLAT, pipe)).objects_found, 0.99);
}

TEST(BrokenLandTest, CrowdedBouldersAreNoTerrace) {
  const auto boulders = [](double x, double y) {
    return std::max(boulderHeight(x, y), boulderHeight(y + 0.3, x + 0.4));
  };
  EXPECT_GE(sharesOf(scanOf(FLAT, boulders)).objects_found, 0.99);
}

}  // namespace
}  // namespace pcl_fft_ground::core
