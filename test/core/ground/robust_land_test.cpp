#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "analytic_worlds.h"
#include "pcl_fft_ground/core/ground/robust_ground.h"
#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

using test::scatteredOn;
using test::uniform;

using Height = std::function<double(double, double)>;

/// A scan of land with objects on it, all in multiples of the largest object.
struct Land {
  double side = 6;
  Eigen::Index points = 80000;
  double noise = 0.003;  ///< half the width of a uniform distribution
  Height ground = [](double, double) { return 0.0; };
  Height object = [](double, double) { return 0.0; };  ///< height above the ground, 0 for none
};

struct Scan {
  Points points;
  std::vector<double> object_heights;
};

Scan scanOf(const Land& land) {
  std::mt19937 random(5);
  Scan scan;
  scan.points = scatteredOn(
      land.points, land.side, land.side,
      [&](double x, double y) {
        scan.object_heights.push_back(land.object(x, y));
        return land.ground(x, y) + scan.object_heights.back() + uniform(random, -land.noise, land.noise);
      },
      random);
  return scan;
}

struct Rates {
  double objects_found = 0, ground_kept = 0;
};

/// Objects lower than 0.03 do not count.
Rates ratesOf(const Scan& scan, const RobustParameters& parameters) {
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

RobustParameters largestObject(double size) {
  RobustParameters parameters;
  parameters.max_object_size = size;
  return parameters;
}

/// Boxes of 0.3 x 0.3 x 0.15 on a lattice.
double boxes(double x, double y) {
  const auto offset = [](double t) { return std::abs(t - 1.1 * std::round(t / 1.1)); };
  return std::max(offset(x), offset(y)) < 0.15 ? 0.15 : 0;
}

struct SmoothLand {
  const char* name;
  double (*height)(double, double);  ///< of slope 1 and wavelength 1 at the most
  double slope, wavelength;
};

void PrintTo(const SmoothLand& land, std::ostream* stream) {
  *stream << land.name << " slope " << land.slope << " wavelength " << land.wavelength;
}

double ridge(double x, double y) {
  return std::sin(2 * M_PI * (0.8 * x + 0.6 * y) + 1) / (2 * M_PI);
}
double hills(double x, double y) {
  return std::sin(2 * M_PI * x + 1) * std::sin(2 * M_PI * y + 2) / (2 * M_PI);
}

class SmoothLandTest : public testing::TestWithParam<SmoothLand> {};
INSTANTIATE_TEST_SUITE_P(
    Lands, SmoothLandTest,
    testing::Values(SmoothLand{"ridge", ridge, 0.4, 1.5}, SmoothLand{"ridge", ridge, 0.8, 1.5},
                    SmoothLand{"ridge", ridge, 0.8, 3}, SmoothLand{"ridge", ridge, 0.8, 6},
                    SmoothLand{"hills", hills, 0.8, 1.5}, SmoothLand{"hills", hills, 0.8, 4}));

TEST_P(SmoothLandTest, KeepsItsCrestsAndGivesItsBoxesAway) {
  const SmoothLand& smooth = GetParam();
  Land land;
  land.ground = [&](double x, double y) {
    return smooth.slope * smooth.wavelength * smooth.height(x / smooth.wavelength, y / smooth.wavelength);
  };
  land.object = boxes;
  const Rates rates = ratesOf(scanOf(land), largestObject(1));
  EXPECT_GE(rates.ground_kept, 0.98);
  EXPECT_GE(rates.objects_found, 0.97);
}

TEST(RobustLand, AroundAPitNearlyAsLargeAsAnObjectIsGround) {
  Land land;
  land.side = 3;
  land.points = 20000;
  land.noise = 0.0015;
  land.ground = [](double x, double y) {
    return std::abs(x - 1.5) < 0.45 && std::abs(y - 1.4) < 0.25 ? -0.15 : 0.01 * x;
  };
  EXPECT_GE(ratesOf(scanOf(land), largestObject(1)).ground_kept, 0.995);
}

TEST(RobustLand, AWideLowHouseIsAnObjectUpToAnySlope) {
  Land land;
  land.side = 4;
  land.points = 20000;
  land.object = [](double x, double y) {
    return std::abs(x - 2) < 0.4 && std::abs(y - 2.3) < 0.4 ? 0.35 : 0.0;
  };
  const Scan scan = scanOf(land);
  for (const double slope : {0.0, 0.3, 0.7, 1.0, 2.0}) {
    SCOPED_TRACE(slope);
    RobustParameters parameters = largestObject(1);
    if (slope > 0) parameters.max_slope = slope;
    const Rates rates = ratesOf(scan, parameters);
    EXPECT_EQ(rates.objects_found, 1);
    EXPECT_GE(rates.ground_kept, 0.999);
  }
}

/// Shrubs up to 0.06 nearly everywhere: one point in eight is ground.
TEST(RobustLand, TheSurfaceSinksThroughShrubs) {
  std::mt19937 random(9);
  Land land;
  land.points = 30000;
  land.ground = [](double x, double y) { return 0.05 * std::sin(x) * std::cos(0.8 * y); };
  land.object = [&](double, double) {
    return uniform(random, 0, 1) < 0.12 ? 0.0 : 0.004 + 0.056 * std::pow(uniform(random, 0, 1), 2);
  };
  const Scan scan = scanOf(land);
  const RobustGround ground =
      estimateRobustGround(scan.points, Eigen::Isometry3d::Identity(), largestObject(1));
  double bias = 0;
  for (const double at : {1.0, 2.0, 3.0, 4.0, 5.0})
    bias += (ground.surface.heightAt(at, 6 - at) - land.ground(at, 6 - at)) / 5;
  EXPECT_NEAR(bias, 0, 0.006);  // a tenth of the height of the shrubs
}

/// Multipath under a parked car: dense, and up to ten times as deep as the tolerance.
TEST(RobustLand, DensePointsBelowAnObjectDoNotTurnTheLandAround) {
  std::mt19937 random(4);
  Land land;
  land.side = 4;
  land.points = 60000;
  land.object = [](double x, double y) {
    return std::abs(x - 2) < 0.22 && std::abs(y - 2) < 0.09 ? 0.15 : 0.0;
  };
  Scan scan = scanOf(land);
  constexpr Eigen::Index GHOSTS = 1000;
  for (Eigen::Index n = 0; n < GHOSTS; ++n) {
    scan.points.col(59 * n) = Eigen::Vector3d(uniform(random, 1.8, 2.2), uniform(random, 1.91, 2.09),
                                              uniform(random, -0.15, -0.035))
                                  .cast<float>();
    scan.object_heights[static_cast<std::size_t>(59 * n)] = 0.15;
  }
  const Rates rates = ratesOf(scan, largestObject(1));
  EXPECT_GE(rates.ground_kept, 0.999);
  EXPECT_GE(rates.objects_found, 0.95);
}

/// Points 0.3 to 0.45 below the ground are noise, whatever the unit.
TEST(RobustLand, LabelsDoNotDependOnTheUnit) {
  constexpr std::size_t DEEP = 20;
  std::mt19937 random(3);
  Land land;
  land.object = boxes;
  Scan scan = scanOf(land);
  for (std::size_t n = 0; n < DEEP; ++n)
    scan.points.col(static_cast<Eigen::Index>(1000 * n + 7)) =
        Eigen::Vector3d(uniform(random, 0.5, 5.5), uniform(random, 0.5, 5.5), uniform(random, -0.45, -0.3))
            .cast<float>();
  std::vector<Labels> labels;
  for (const float unit : {1.0F, 1024.0F, 1.0F / 1024}) {
    SCOPED_TRACE(unit);
    const Points points = unit * scan.points;
    const RobustGround ground =
        estimateRobustGround(points, Eigen::Isometry3d::Identity(), largestObject(static_cast<double>(unit)));
    const RobustLabels result = labelRobust(points, ground);
    EXPECT_EQ(result.below, DEEP);
    labels.push_back(result.labels);
  }
  for (const Labels& other : {labels[1], labels[2]}) {
    std::size_t different = 0;
    for (std::size_t n = 0; n < other.size(); ++n) different += other[n] != labels[0][n] ? 1 : 0;
    EXPECT_LE(different, other.size() / 10000);  // another sample of the points is looked at
  }
}

}  // namespace
}  // namespace pcl_fft_ground::core
