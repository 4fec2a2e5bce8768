#include "grid/openings.h"

#include <gtest/gtest.h>

#include <algorithm>
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

}  // namespace
}  // namespace pcl_fft_ground::core
