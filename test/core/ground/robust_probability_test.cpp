#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "analytic_worlds.h"
#include "pcl_fft_ground/core/ground/robust_ground.h"
#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

using test::scatteredOn;
using test::uniform;

constexpr std::size_t STEPS = ClearanceCounts::STEPS;

/// A ground whose points spread by so many steps.
RobustGround groundSpreadBy(double steps) {
  RobustGround ground;
  ground.depth_tolerance = 1;
  ground.scale = steps / STEPS;
  return ground;
}

/// Counts of ground that lies normally about the middle of a step above the surface, and of objects.
ClearanceCounts countsOf(double middle, double spread, double objects_per_step) {
  ClearanceCounts counts;
  const auto ground = [&](double step) {
    return 1e5 * std::exp(-0.5 * std::pow((step - middle) / spread, 2));
  };
  for (std::size_t n = 0; n < STEPS; ++n) {
    const double step = static_cast<double>(n) + 0.5;
    counts.above[n] = static_cast<std::uint64_t>(ground(step) + objects_per_step);
    counts.below[n] = static_cast<std::uint64_t>(ground(-step));
  }
  return counts;
}

TEST(GroundShares, AreThoseOfAKnownMixture) {
  constexpr double SPREAD = 20, OBJECTS = 800;
  for (const double middle : {-4.0, 0.0, 5.0}) {
    const GroundShares shares = groundShares(countsOf(middle, SPREAD, OBJECTS), groundSpreadBy(SPREAD));
    for (std::size_t n = 0; n < STEPS; ++n) {
      const double ground =
          1e5 * std::exp(-0.5 * std::pow((static_cast<double>(n) + 0.5 - middle) / SPREAD, 2));
      EXPECT_NEAR(shares[n], ground / (ground + OBJECTS), 0.05) << middle << ' ' << n;
    }
  }
}

TEST(GroundShares, FallWithTheHeightHoweverTheCountsAre) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 200; ++trial) {
    ClearanceCounts counts;
    for (std::size_t n = 0; n < STEPS; n += 1 + random() % 4) {
      counts.above[n] = random() % 50;
      counts.below[n] = random() % (STEPS / (n + 1) + 1);
    }
    const GroundShares shares = groundShares(counts, groundSpreadBy(1 + random() % 100));
    EXPECT_TRUE(std::is_sorted(shares.rbegin(), shares.rend()));
    EXPECT_GE(shares.back(), 0.0F);
    EXPECT_LE(shares.front(), 1.0F);
  }
}

TEST(GroundShares, AreNoneOfNothing) {
  for (const float share : groundShares(ClearanceCounts(), groundSpreadBy(10))) EXPECT_EQ(share, 0.0F);
  for (const float share : groundShares(ClearanceCounts(), RobustGround())) EXPECT_EQ(share, 0.0F);
}

TEST(GroundProbability, IsTheShareOfThePointsThatAreGround) {
  constexpr double NOISE = 0.01, BIN = 0.1;
  std::mt19937 random(9);
  std::normal_distribution<double> noise(0, NOISE);
  std::vector<bool> is_ground;
  const Points points = scatteredOn(
      200000, 6, 6,
      [&](double x, double y) {
        const bool on_object = std::hypot(std::remainder(x, 1.5), std::remainder(y, 1.5)) < 0.4;
        is_ground.push_back(!on_object);
        return noise(random) + (on_object ? uniform(random, 0, 0.3) : 0);  // a heap, solid in height
      },
      random);
  RobustParameters parameters;
  parameters.max_object_size = 1;
  const RobustGround ground = estimateRobustGround(points, Eigen::Isometry3d::Identity(), parameters);
  const std::vector<float> probability = groundProbability(points, ground);
  std::vector<double> count(10, 0), found(10, 0), expected(10, 0);
  for (std::size_t n = 0; n < probability.size(); ++n) {
    const auto bin =
        std::min<std::size_t>(9, static_cast<std::size_t>(static_cast<double>(probability[n]) / BIN));
    count[bin] += 1, found[bin] += is_ground[n] ? 1 : 0, expected[bin] += static_cast<double>(probability[n]);
  }
  for (std::size_t bin = 0; bin < count.size(); ++bin) {
    if (count[bin] < 500) continue;
    EXPECT_NEAR(found[bin] / count[bin], expected[bin] / count[bin], 0.1) << bin;
  }
  EXPECT_GT(count[0], 10000);
  EXPECT_GT(count[9], 100000);
}

TEST(GroundProbability, IsOneBelowTheGroundAndNoneDeepBelow) {
  std::mt19937 random(2);
  Points points = scatteredOn(
      20000, 4, 4, [&](double, double) { return uniform(random, -0.002, 0.002); }, random);
  points.col(77).z() = -0.01F;
  points.col(78).z() = -1;
  points.col(79).z() = 1;
  RobustParameters parameters;
  parameters.max_object_size = 1;
  const std::vector<float> probability =
      groundProbability(points, estimateRobustGround(points, Eigen::Isometry3d::Identity(), parameters));
  EXPECT_EQ(probability[77], 1.0F);
  EXPECT_EQ(probability[78], 0.0F);
  EXPECT_EQ(probability[79], 0.0F);
}

}  // namespace
}  // namespace pcl_fft_ground::core
