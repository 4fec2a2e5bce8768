#include "ground/robust_uncertainty.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

namespace pcl_fft_ground::core {
namespace {

constexpr double CELL = 0.1, SEEN_WITHIN = 0.2, SPREAD = 0.01;
constexpr Eigen::Index ROWS = 90, COLS = 70;

Eigen::ArrayXXd heightsOf(double (*height)(double, double)) {
  Eigen::ArrayXXd heights(ROWS, COLS);
  for (Eigen::Index j = 0; j < COLS; ++j)
    for (Eigen::Index i = 0; i < ROWS; ++i)
      heights(i, j) = height(CELL * static_cast<double>(i), CELL * static_cast<double>(j));
  return heights;
}

/// Distance from the nearest row with ground, where the rows from `first` to `last` hold none.
Eigen::ArrayXXd distanceAcross(Eigen::Index first, Eigen::Index last) {
  Eigen::ArrayXXd distance = Eigen::ArrayXXd::Zero(ROWS, COLS);
  for (Eigen::Index i = first; i <= last; ++i) {
    const Eigen::Index below = first > 0 ? i - first + 1 : ROWS,
                       above = last + 1 < ROWS ? last + 1 - i : ROWS;
    distance.row(i) = CELL * static_cast<double>(std::min(below, above));
  }
  return distance;
}

Eigen::ArrayXXd uncertaintyOf(const Eigen::ArrayXXd& heights, const Eigen::ArrayXXd& distance) {
  return surfaceUncertainty(heights, distance, CELL, SEEN_WITHIN, SPREAD);
}

TEST(RobustUncertainty, TheDeviationOfNormalValuesIsTheirs) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal(0, 0.3F);
  std::vector<float> values(100000);
  for (float& value : values) value = normal(random);
  EXPECT_NEAR(deviationOf(values), 0.3, 0.005);
  values.clear();
  EXPECT_EQ(deviationOf(values), 0);
}

TEST(RobustUncertainty, APlaneIsAsSureInAGapAsBesideIt) {
  const Eigen::ArrayXXd plane = heightsOf([](double x, double y) { return 1 + 0.3 * x - 0.2 * y; });
  const Eigen::ArrayXXd uncertainty = uncertaintyOf(plane, distanceAcross(40, 59));
  EXPECT_NEAR(uncertainty.minCoeff(), SPREAD, 1e-9);
  EXPECT_NEAR(uncertainty.maxCoeff(), SPREAD, 1e-9);
}

TEST(RobustUncertainty, AcrossAGapItGrowsWithTheCurvature) {
  constexpr double CURVATURE = 0.4;
  constexpr Eigen::Index FIRST = 40, LAST = 59;
  const Eigen::ArrayXXd bent =
      heightsOf([](double x, double y) { return 0.5 * CURVATURE * (x * x + y * y); });
  const Eigen::ArrayXXd uncertainty = uncertaintyOf(bent, distanceAcross(FIRST, LAST));
  for (Eigen::Index i = FIRST + 2; i <= LAST - 2; ++i) {
    SCOPED_TRACE(i);
    const double a = CELL * static_cast<double>(i - FIRST + 1), b = CELL * static_cast<double>(LAST + 1 - i);
    const double expected = 0.5 * CURVATURE * a * b / 1.96;  // 1.96 of them reach what all have
    // Linear between lags that double it lies at most an eighth above the parabola.
    EXPECT_GT(uncertainty(i, 30), 0.95 * std::hypot(SPREAD, expected));
    EXPECT_LT(uncertainty(i, 30), 1.2 * std::hypot(SPREAD, expected));
  }
  EXPECT_NEAR(uncertainty(10, 10), SPREAD, 1e-4);
}

TEST(RobustUncertainty, BeyondTheLastGroundItIsGreaterThanBetween) {
  const Eigen::ArrayXXd rolling =
      heightsOf([](double x, double y) { return 0.2 * std::sin(2 * x) * std::cos(1.5 * y); });
  const Eigen::ArrayXXd between = uncertaintyOf(rolling, distanceAcross(40, 59));
  const Eigen::ArrayXXd beyond = uncertaintyOf(rolling, distanceAcross(70, ROWS - 1));
  EXPECT_GT(beyond(79, 30), 1.2 * between(49, 30));  // as far from the nearest ground
  EXPECT_GT(between(49, 30), 3 * SPREAD);
}

TEST(RobustUncertainty, RowsAndColumnsAreAlike) {
  const Eigen::ArrayXXd rolling =
      heightsOf([](double x, double y) { return 0.2 * std::sin(2 * x) * std::cos(1.5 * y); });
  const Eigen::ArrayXXd distance = distanceAcross(40, 59);
  const Eigen::ArrayXXd across = uncertaintyOf(rolling.transpose(), distance.transpose());
  EXPECT_LT((across.transpose() - uncertaintyOf(rolling, distance)).abs().maxCoeff(), 1e-12);
}

TEST(RobustUncertainty, IsFiniteWithoutEnoughGround) {
  const Eigen::ArrayXXd one_cell = Eigen::ArrayXXd::Constant(1, 1, 2.0);
  EXPECT_EQ(uncertaintyOf(one_cell, Eigen::ArrayXXd::Zero(1, 1))(0, 0), SPREAD);
  const Eigen::ArrayXXd far =
      uncertaintyOf(heightsOf([](double x, double) { return x * x; }), distanceAcross(0, ROWS - 2));
  EXPECT_TRUE(far.isFinite().all());
  EXPECT_GE(far.minCoeff(), SPREAD);
}

}  // namespace
}  // namespace pcl_fft_ground::core
