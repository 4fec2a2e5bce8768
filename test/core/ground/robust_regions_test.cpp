#include "ground/robust_regions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

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

TEST(RobustRegions, DilationAndErosionLookAtSquares) {
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

TEST(RobustRegions, AreConnectedAlongSidesAndCorners) {
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

TEST(RobustRegions, JoinCellsOverEmptyOnesBetween) {
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
