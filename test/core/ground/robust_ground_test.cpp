#include "pcl_fft_ground/core/ground/robust_ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "analytic_worlds.h"
#include "grid/dct.h"
#include "ground/robust_fit.h"
#include "pcl_fft_ground/core/ground/butterworth.h"
#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

using test::randomGrid;
using test::scatteredOn;
using test::uniform;

constexpr double NOISE = 0.003;  // [m]

/// About normal: the sum of twelve uniform numbers.
double noise(std::mt19937& random) {
  double sum = -6;
  for (int n = 0; n < 12; ++n) sum += uniform(random, 0, 1);
  return NOISE * sum;
}

RobustParameters largestObject(double size) {
  RobustParameters parameters;
  parameters.max_object_size = size;
  return parameters;
}

RobustGround groundOf(const Points& points, const RobustParameters& parameters) {
  return estimateRobustGround(points, Eigen::Isometry3d::Identity(), parameters);
}

std::size_t objectsIn(const Labels& labels) {
  return static_cast<std::size_t>(std::count(labels.begin(), labels.end(), Label::OBJECT));
}

constexpr double FLOAT_PRECISION = 2e-6;  // of heights of about 1: corrections are computed in float

TEST(PenalisedFit, WithEqualWeightsIsTheButterworthPowerResponse) {
  std::mt19937 random(1);
  constexpr Eigen::Index ROWS = 24, COLS = 45;
  const double cell_size = 0.02, wavelength = 0.2;
  const Eigen::ArrayXXd heights = randomGrid(ROWS, COLS, random);
  Dct2d<double> transform(ROWS, COLS);
  Eigen::ArrayXXd expected = heights;
  transform.forward(expected);
  const Butterworth filter{2 * cell_size / wavelength, 2, 3.0};
  for (Eigen::Index l = 0; l < COLS; ++l)
    for (Eigen::Index k = 0; k < ROWS; ++k)
      expected(k, l) *= std::pow(
          filter.response(std::hypot(static_cast<double>(k) / ROWS, static_cast<double>(l) / COLS)), 2);
  transform.inverse(expected);

  PenalisedFit fit(ROWS, COLS, cell_size, {wavelength, 2, 3.0});
  fit.improve(Eigen::ArrayXXd::Ones(ROWS, COLS), heights, {30, 0});
  EXPECT_LE((fit.surface() - expected).abs().maxCoeff(), FLOAT_PRECISION);
  Eigen::ArrayXXd filtered = heights;
  fit.lowPass(filtered);
  EXPECT_LE((filtered - expected).abs().maxCoeff(), FLOAT_PRECISION);
}

TEST(PenalisedFit, SolvesTheNormalEquations) {
  std::mt19937 random(2);
  constexpr Eigen::Index ROWS = 12, COLS = 10;
  const BandLimit limit{0.3, 2, 3.0};
  const Eigen::ArrayXXd heights = randomGrid(ROWS, COLS, random);
  const Eigen::ArrayXXd weights = (randomGrid(ROWS, COLS, random) > 0).cast<double>();
  PenalisedFit fit(ROWS, COLS, 0.05, limit);
  const Eigen::ArrayXXd start = randomGrid(ROWS, COLS, random);
  fit.startFrom(start);
  fit.improve(weights, weights * (heights - start), {500, 0});

  const Eigen::ArrayXXd surface = fit.surface();
  Eigen::ArrayXXd bending = surface;
  Dct2d<double> transform(ROWS, COLS);
  transform.forward(bending);
  bending *= penaltyOf(limit, ROWS, COLS, 0.05);
  transform.inverse(bending);
  EXPECT_LE((weights * (heights - surface) - bending).abs().maxCoeff(), 10 * FLOAT_PRECISION);
}

struct World {
  const char* name;
  double (*height)(double, double);
};

void PrintTo(const World& world, std::ostream* stream) {
  *stream << world.name;
}

TEST(PenalisedFit, GoesOnFromWhereItStopped) {
  std::mt19937 random(12);
  constexpr Eigen::Index ROWS = 20, COLS = 16;
  const Eigen::ArrayXXd heights = randomGrid(ROWS, COLS, random);
  const Eigen::ArrayXXd weights = (randomGrid(ROWS, COLS, random) > 0).cast<double>();
  PenalisedFit at_once(ROWS, COLS, 0.05, {0.3, 2, 3.0}), in_parts = at_once;
  at_once.improve(weights, weights * heights, {500, 0});
  for (int n = 0; n < 100; ++n) in_parts.improve(weights, weights * (heights - in_parts.surface()), {3, 0});
  EXPECT_LE((at_once.surface() - in_parts.surface()).abs().maxCoeff(), 1e-6);
}

class BareGround : public testing::TestWithParam<World> {};
INSTANTIATE_TEST_SUITE_P(
    Worlds, BareGround,
    testing::Values(World{"flat", [](double, double) { return 0.0; }},
                    World{"sloping", [](double x, double y) { return 0.3 * x + 0.2 * y; }},
                    World{"bowl",
                          [](double x, double y) { return 0.1 * ((x - 2) * (x - 2) + (y - 2) * (y - 2)); }}),
    [](const auto& world) { return world.param.name; });

TEST_P(BareGround, HasNoObjects) {
  std::mt19937 random(3);
  const Points points = scatteredOn(
      100000, 4, 4, [&](double x, double y) { return GetParam().height(x, y) + noise(random); }, random);
  const RobustGround ground = groundOf(points, largestObject(1));
  EXPECT_LT(objectsIn(labelRobust(points, ground).labels), 200U);
  EXPECT_TRUE(ground.surface.supported.all());
  EXPECT_NEAR(ground.scale, NOISE, 0.2 * NOISE);
  for (const double at : {0.5, 1.5, 2.5, 3.5})
    EXPECT_NEAR(ground.surface.heightAt(at, 4 - at), GetParam().height(at, 4 - at), NOISE);
}

/// A box of 0.4 m x 0.4 m x 0.15 m on a slope; every point's truth is known.
struct BoxOnSlope {
  Points points;
  std::vector<bool> is_object;
  explicit BoxOnSlope(unsigned seed, double hole = 0) {
    std::mt19937 random(seed);
    points = test::randomBox(120000, {0, 0, 0}, {4, 4, 1}, random);
    Eigen::Index kept = 0;
    for (Eigen::Index n = 0; n < points.cols(); ++n) {
      const double x = static_cast<double>(points(0, n)), y = static_cast<double>(points(1, n));
      if (std::hypot(x - 1, y - 3) < hole) continue;
      const bool object = std::abs(x - 2.5) < 0.2 && std::abs(y - 1.5) < 0.2;
      points.col(kept++) = Eigen::Vector3d(x, y, 0.1 * x + (object ? 0.15 : 0) + noise(random)).cast<float>();
      is_object.push_back(object);
    }
    points.conservativeResize(Eigen::NoChange, kept);
  }
};

TEST(RobustGround, IsNotPulledUpByABox) {
  const BoxOnSlope scene(4);
  const RobustGround ground = groundOf(scene.points, largestObject(1));
  EXPECT_NEAR(ground.surface.heightAt(2.5, 1.5), 0.25, 0.02);
  const Labels labels = labelRobust(scene.points, ground).labels;
  std::size_t wrong = 0;
  for (std::size_t n = 0; n < labels.size(); ++n)
    if ((labels[n] == Label::OBJECT) != scene.is_object[n]) ++wrong;
  EXPECT_LT(wrong, labels.size() / 200);
}

TEST(RobustGround, SpansAHoleAndSaysSo) {
  const BoxOnSlope scene(5, 0.5);
  const RobustGround ground = groundOf(scene.points, largestObject(1));
  const double cell = ground.elevation.geometry.cell_size;
  const auto i = static_cast<Eigen::Index>(1 / cell), j = static_cast<Eigen::Index>(3 / cell);
  EXPECT_FALSE(ground.surface.supported(i, j));
  EXPECT_TRUE(ground.surface.supported(i, static_cast<Eigen::Index>(1 / cell)));
  EXPECT_GE(ground.surface.uncertainty(i, j), ground.surface.uncertainty(i / 10, j / 10));
  EXPECT_LT(std::abs(ground.surface.heightAt(1, 3) - 0.1), 3 * ground.surface.uncertainty(i, j));
  EXPECT_NEAR(ground.surface.heightAt(1, 3), 0.1, 0.02);
}

TEST(RobustGround, DoesNotDependOnTheOrderOfThePoints) {
  const BoxOnSlope scene(6);
  std::mt19937 random(7);
  const RobustGround one = groundOf(scene.points, largestObject(1));
  const RobustGround other = groundOf(test::shuffled(scene.points, random), largestObject(1));
  EXPECT_TRUE((one.surface.height == other.surface.height).all());
  EXPECT_EQ(one.tolerance, other.tolerance);
}

TEST(RobustGround, KeepsTheEdgeOfATerraceWithAMaximumSlope) {
  std::mt19937 random(8);
  const Points points = scatteredOn(
      60000, 200, 200, [&](double x, double) { return (x > 100 ? 10.0 : 0.0) + 10 * noise(random); }, random);
  RobustParameters parameters = largestObject(40);
  parameters.max_slope = 0.3;
  EXPECT_LT(objectsIn(labelRobust(points, groundOf(points, parameters)).labels), 1200U);
  EXPECT_LT(objectsIn(labelRobust(points, groundOf(points, largestObject(40))).labels), 1200U);
}

TEST(RobustGround, DoesNotClimbOnCrowdedObjects) {
  std::mt19937 random(11);
  std::vector<bool> is_object;
  const auto height = [&](double x, double y) {  // flat stones on three quarters of the ground
    const double u = x / 0.5 - std::floor(x / 0.5), v = y / 0.5 - std::floor(y / 0.5);
    is_object.push_back(std::max(std::abs(u - 0.5), std::abs(v - 0.5)) < 0.43);
    return (is_object.back() ? 0.1 : 0.0) + noise(random);
  };
  const Points points = scatteredOn(150000, 4, 4, height, random);
  const Labels labels = labelRobust(points, groundOf(points, largestObject(1))).labels;
  std::size_t wrong = 0;
  for (std::size_t n = 0; n < labels.size(); ++n)
    if ((labels[n] == Label::OBJECT) != is_object[n]) ++wrong;
  EXPECT_LT(wrong, labels.size() / 100);
}

TEST(RobustGround, DoesNotClimbOnStonesOnUndulatingGround) {
  std::mt19937 random(13);
  std::vector<Eigen::Array4d> stones;  // x, y, radius, height
  for (int n = 0; n < 75; ++n)
    stones.emplace_back(uniform(random, 0, 4), uniform(random, 0, 4), uniform(random, 0.08, 0.34),
                        uniform(random, 0.1, 0.4));
  std::vector<double> above;  // the ground
  const auto height = [&](double x, double y) {
    above.push_back(0);
    for (const Eigen::Array4d& s : stones) {
      const double inside = 1 - (std::pow(x - s[0], 2) + std::pow(y - s[1], 2)) / (s[2] * s[2]);
      if (inside > 0) above.back() = std::max(above.back(), s[3] * std::sqrt(inside));
    }
    return 0.08 * std::sin(5.2 * x) * std::sin(4.8 * y) + above.back() + noise(random);
  };
  const Points points = scatteredOn(150000, 4, 4, height, random);
  const Labels labels = labelRobust(points, groundOf(points, largestObject(1))).labels;
  std::size_t wrong = 0;
  for (std::size_t n = 0; n < labels.size(); ++n)
    if (above[n] == 0 ? labels[n] == Label::OBJECT : above[n] > 0.03 && labels[n] == Label::GROUND) ++wrong;
  EXPECT_LT(wrong, labels.size() / 50);
}

TEST(RobustGround, CountsDeepOutliersApart) {
  BoxOnSlope scene(9);
  for (Eigen::Index n = 0; n < 100; ++n) scene.points(2, 1000 * n) -= 5;
  const RobustLabels result = labelRobust(scene.points, groundOf(scene.points, largestObject(1)));
  EXPECT_EQ(result.below, 100U);
  for (std::size_t n = 0; n < 100; ++n) EXPECT_EQ(result.labels[1000 * n], Label::OBJECT);
}

TEST(RobustGround, GivesAReasonForWhatItChose) {
  const BoxOnSlope scene(10);
  RobustParameters parameters = largestObject(1);
  const auto has = [](const RobustGround& ground, const std::string& name) {
    return std::any_of(ground.choices.begin(), ground.choices.end(),
                       [&](const RobustChoice& c) { return c.parameter == name && !c.reason.empty(); });
  };
  EXPECT_TRUE(has(groundOf(scene.points, parameters), "cell_size"));
  parameters.cell_size = 0.05;
  parameters.height_tolerance = 0.02;
  const RobustGround ground = groundOf(scene.points, parameters);
  EXPECT_FALSE(has(ground, "cell_size"));
  EXPECT_FALSE(has(ground, "height_tolerance"));
  EXPECT_EQ(ground.elevation.geometry.cell_size, 0.05);
  EXPECT_EQ(ground.tolerance, 0.02);
}

TEST(RobustGround, OfNoPointsHasNoCells) {
  const RobustGround ground = groundOf(Points(3, 0), {});
  EXPECT_EQ(ground.surface.height.size(), 0);
  EXPECT_TRUE(labelRobust(Points(3, 0), ground).labels.empty());
}

TEST(RobustGround, OfAStripHasNoMoreThanFourCellsToAPoint) {
  Points strip(3, 400);
  for (Eigen::Index n = 0; n < strip.cols(); ++n)
    strip.col(n) << 1e4F * static_cast<float>(n), static_cast<float>(n % 2), 0;
  EXPECT_LE(groundOf(strip, largestObject(1e-3)).elevation.observed.size(), 1610);
}

TEST(RobustGround, OfDegenerateCloudsIsFinite) {
  Points collinear(3, 50);
  for (Eigen::Index n = 0; n < 50; ++n) collinear.col(n) << 0.1F * static_cast<float>(n), 0, 0;
  const Points identical = Points::Constant(3, 20, 1.5F), many_identical = Points::Constant(3, 50000, 1.5F);
  for (const Points& points : {Points(Points::Zero(3, 1)), identical, many_identical, collinear})
    for (const bool with_slope : {false, true}) {
      SCOPED_TRACE(points.cols());
      RobustParameters parameters;
      if (with_slope) parameters.max_slope = 0.3;
      const RobustGround ground = groundOf(points, parameters);
      ASSERT_GT(ground.surface.height.size(), 0);
      EXPECT_TRUE(ground.surface.height.isFinite().all());
      EXPECT_TRUE(ground.surface.uncertainty.isFinite().all());
      EXPECT_TRUE(std::isfinite(ground.tolerance));
      EXPECT_EQ(objectsIn(labelRobust(points, ground).labels), 0U);
    }
}

/// Level ground, a fifth of whose points lie up to 0.06 m off: on both sides, or above only.
Points groundWithTail(bool is_symmetric) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> share(0, 1);
  std::normal_distribution<float> noise(0, 0.005F);
  Points points(3, 60000);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const float off = share(random) < 0.2F ? 0.06F * share(random) : 0.0F;
    const float sign = is_symmetric && share(random) < 0.5F ? -1.0F : 1.0F;
    points.col(n) = Eigen::Vector3f(10 * share(random), 10 * share(random), noise(random) + sign * off);
  }
  return points;
}

TEST(RobustTolerance, WidensWhereAsMuchLiesBelow) {
  const RobustGround ground = groundOf(groundWithTail(true), largestObject(8));
  EXPECT_GT(ground.tolerance, 0.05);
  EXPECT_LE(ground.tolerance, ground.most_tolerance);
}

TEST(RobustTolerance, StaysWhereWhatIsOffLiesAbove) {
  const RobustGround ground = groundOf(groundWithTail(false), largestObject(8));
  EXPECT_NEAR(ground.tolerance, 4.25 * ground.scale, 1e-6);
}

}  // namespace
}  // namespace pcl_fft_ground::core
