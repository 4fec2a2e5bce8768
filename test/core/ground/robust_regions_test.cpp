#include "ground/robust_regions.h"

#include <gtest/gtest.h>

#include <cstdlib>
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

TEST(RobustRegions, KeepsLongAndLargeRegionsThatHoldACore) {
  Mask mask = Mask::Constant(20, 20, false);
  mask.block(1, 1, 3, 8).setConstant(true);  // long, connected at a corner with the next
  mask(4, 9) = true;
  mask.block(10, 1, 2, 9).setConstant(true);   // long, without a core
  mask.block(15, 15, 3, 3).setConstant(true);  // short
  Mask cores = Mask::Constant(20, 20, false);
  cores(2, 2) = cores(16, 16) = cores(0, 19) = true;
  const Mask kept = regionsAround(mask, cores, {9.5});  // the diagonals: 9.8, 9.2 and 4.2
  EXPECT_EQ(kept.count(), 3 * 8 + 1);
  EXPECT_TRUE(kept(4, 9));
  EXPECT_EQ(regionsAround(mask, cores, {0}).count(), 3 * 8 + 1 + 3 * 3);
  EXPECT_EQ(regionsAround(mask, cores, {0, 25}).count(), 3 * 8 + 1);
  EXPECT_FALSE(regionsAround(mask, cores, {0, 26}).any());
}

}  // namespace
}  // namespace pcl_fft_ground::core
