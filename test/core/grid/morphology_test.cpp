#include "grid/morphology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

ElevationGrid gridOf(const Eigen::ArrayXXd& heights) {
  ElevationGrid grid;
  grid.geometry = {{0, 0}, 1.0, heights.rows(), heights.cols()};
  grid.elevation = heights;
  grid.observed = Mask::Constant(heights.rows(), heights.cols(), true);
  return grid;
}

/// Smallest of the (2 reach + 1)^2 cells around each, cell by cell.
Eigen::ArrayXXd slowErosion(const Eigen::ArrayXXd& grid, Eigen::Index reach) {
  Eigen::ArrayXXd result = grid;
  for (Eigen::Index j = 0; j < grid.cols(); ++j)
    for (Eigen::Index i = 0; i < grid.rows(); ++i) {
      const Eigen::Index low_i = std::max<Eigen::Index>(i - reach, 0);
      const Eigen::Index low_j = std::max<Eigen::Index>(j - reach, 0);
      const Eigen::Index high_i = std::min(i + reach, grid.rows() - 1);
      const Eigen::Index high_j = std::min(j + reach, grid.cols() - 1);
      result(i, j) = grid.block(low_i, low_j, high_i - low_i + 1, high_j - low_j + 1).minCoeff();
    }
  return result;
}

TEST(RobustOpenings, CutOffWhatSlowOpeningsCutOff) {
  std::mt19937 random(1);
  const Eigen::ArrayXXd heights = test::randomGrid(31, 19, random);
  Mask expected = Mask::Constant(31, 19, true);
  Eigen::ArrayXXd surface = heights;
  for (const Eigen::Index reach : {1, 2, 3, 4, 6}) {
    const Eigen::ArrayXXd lower = -slowErosion(-slowErosion(surface, reach), reach);
    expected = expected && surface - lower <= std::max(0.12 * static_cast<double>(reach), 0.4);
    surface = lower;
  }
  EXPECT_LT(expected.count(), expected.size());
  EXPECT_TRUE(((steepnessByOpenings(gridOf(heights), {12, 0.4}) <= 0.12F) == expected).all());
}

TEST(RobustOpenings, KeepTheEdgeOfAWideTerrace) {
  Eigen::ArrayXXd heights = Eigen::ArrayXXd::Zero(40, 30);
  heights.bottomRows(15) = 5;
  heights.block(10, 10, 4, 4) = 2;
  const Mask ground = steepnessByOpenings(gridOf(heights), {12, 0.1}) <= 0.3F;
  EXPECT_EQ(ground.size() - ground.count(), 4 * 4);
  EXPECT_FALSE(ground(12, 12));
}

Mask randomMask(double share, std::mt19937& random) {
  return test::randomGrid(23, 17, random) < 2 * share - 1;
}

/// Whether a cell lies within `reach` of one that has the value, those beyond the border having `beyond`.
bool isNear(const Mask& mask, Eigen::Index i, Eigen::Index j, Eigen::Index reach, bool value, bool beyond) {
  for (Eigen::Index l = j - reach; l <= j + reach; ++l)
    for (Eigen::Index k = i - reach; k <= i + reach; ++k) {
      const bool inside = k >= 0 && l >= 0 && k < mask.rows() && l < mask.cols();
      if ((inside ? mask(k, l) : beyond) == value) return true;
    }
  return false;
}

TEST(Morphology, DilationAndErosionLookAtSquares) {
  std::mt19937 random(1);
  for (const Eigen::Index reach : {0, 1, 2, 5, 30}) {
    SCOPED_TRACE(reach);
    const Mask sparse = randomMask(0.03, random), dense = randomMask(0.97, random);
    const Mask larger = dilated(sparse, reach), smaller = eroded(dense, reach);
    for (Eigen::Index j = 0; j < sparse.cols(); ++j)
      for (Eigen::Index i = 0; i < sparse.rows(); ++i) {
        EXPECT_EQ(larger(i, j), isNear(sparse, i, j, reach, true, false));
        EXPECT_EQ(smaller(i, j), !isNear(dense, i, j, reach, false, false));
      }
  }
}

TEST(Regions, AreConnectedAlongSidesAndCorners) {
  Mask mask = Mask::Constant(20, 21, false);
  mask.block(1, 1, 3, 8).setConstant(true);
  mask(4, 9) = true;  // connected at a corner
  mask.block(10, 1, 2, 9).setConstant(true);
  mask(19, 20) = true;
  const std::vector<Region> regions = regionsOf(mask);
  ASSERT_EQ(regions.size(), 3U);
  EXPECT_EQ(regions[0].cells.size(), 3U * 8 + 1);
  EXPECT_DOUBLE_EQ(regions[0].length, std::hypot(4, 9));
  EXPECT_EQ(regions[1].cells.size(), 2U * 9);
  EXPECT_DOUBLE_EQ(regions[1].length, std::hypot(2, 9));
  EXPECT_EQ(regions[2].cells, std::vector<Eigen::Index>{19 + 20 * 20});
}

TEST(Regions, JoinCellsOverEmptyOnesBetween) {
  Mask chosen = Mask::Constant(20, 20, false), observed = chosen;
  chosen.col(5).setConstant(true);
  chosen.col(9).setConstant(true);
  observed = chosen;
  observed(10, 7) = true;
  const Mask all = joined(chosen, observed);
  EXPECT_TRUE(all(10, 6));
  EXPECT_FALSE(all(10, 7));   // holds a point, and is not chosen
  EXPECT_FALSE(all(10, 12));  // not between
  EXPECT_EQ(regionsOf(chosen).size(), 2U);
  EXPECT_EQ(regionsOf(all).size(), 1U);
}

}  // namespace
}  // namespace pcl_fft_ground::core
