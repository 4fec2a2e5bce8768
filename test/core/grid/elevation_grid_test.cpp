#include "pcl_fft_ground/core/grid/elevation_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

Bounds boundsBetween(double x_low, double y_low, double x_high, double y_high) {
  return {{x_low, y_low, -1}, {x_high, y_high, 1}};
}

ElevationGrid gridOf(const Points& points, double cell_size) {
  return rasteriseHighest(points, gridAround(boundsOf(points), cell_size));
}

TEST(GridAround, StartsAtTheLowerCorner) {
  const GridGeometry grid = gridAround(boundsBetween(-1.25, 7, 0.9, 7.6), 0.5);
  EXPECT_EQ(grid.origin, Eigen::Vector2d(-1.25, 7));
  EXPECT_EQ(grid.cell_size, 0.5);
  EXPECT_EQ(grid.rows, 5);
  EXPECT_EQ(grid.cols, 2);
}

TEST(GridAround, APointOnABorderBelongsToTheUpperCell) {
  EXPECT_EQ(gridAround(boundsBetween(0, 0, 1, 2), 0.25).rows, 5);
  EXPECT_EQ(gridAround(boundsBetween(0, 0, 1, 2), 0.25).cols, 9);
  EXPECT_EQ(gridAround(boundsBetween(0, 0, std::nextafter(1.0, 0.0), 2), 0.25).rows, 4);
}

TEST(GridAround, OfOnePlaceIsOneCell) {
  const GridGeometry grid = gridAround(boundsBetween(3, 4, 3, 4), 0.02);
  EXPECT_EQ(grid.rows, 1);
  EXPECT_EQ(grid.cols, 1);
}

TEST(GridAround, AllowsAHundredMillionCells) {
  const GridGeometry grid = gridAround(boundsBetween(0, 0, 9999, 9999), 1);
  EXPECT_EQ(grid.rows * grid.cols, 100000000);
  EXPECT_THROW(gridAround(boundsBetween(0, 0, 9999, 10000), 1), std::length_error);
  EXPECT_THROW(gridAround(boundsBetween(-3e38, 0, 3e38, 0), 1e-30), std::length_error);
  EXPECT_THROW(gridAround(boundsBetween(0, 0, 1, 1), 1e-320), std::length_error);
}

TEST(GridAround, TooManyCellsAreNamed) {
  try {
    gridAround(boundsBetween(0, 0, 4321, 765), 0.0125);
    FAIL() << "no exception";
  } catch (const std::length_error& error) {
    const std::string message = error.what();
    for (const char* size : {"4321", "765", "0.0125"})
      EXPECT_NE(message.find(size), std::string::npos) << size << " is not in: " << message;
  }
}

TEST(ElevationGrid, TakesTheHighestPointAndFillsFromTheNearest) {
  Points points(3, 5);
  points << 0, 0.5F, 2.5F, 2.0F, 0.25F,  //
      0, 0.75F, 1.5F, 1.0F, 0.5F,        //
      1, 3, -5, -7, 2;
  const ElevationGrid grid = gridOf(points, 1);
  Eigen::ArrayXXd elevation(3, 2);
  elevation << 3, 3,  //
      3, -5,          // cell (1, 0) is as near to (0, 0) as none other, cell (1, 1) to (2, 1)
      -5, -5;
  Mask observed(3, 2);
  observed << true, false, false, false, false, true;
  EXPECT_TRUE((grid.elevation == elevation).all()) << grid.elevation;
  EXPECT_TRUE((grid.observed == observed).all()) << grid.observed;
  EXPECT_DOUBLE_EQ(grid.emptyCellShare(), 4.0 / 6);
}

TEST(ElevationGrid, WithoutCellsHasNoEmptyOnes) {
  EXPECT_EQ(ElevationGrid().emptyCellShare(), 0);
}

TEST(ElevationGrid, OfOnePoint) {
  const ElevationGrid grid = gridOf(Eigen::Vector3f(5, 6, 7), 0.02);
  ASSERT_EQ(grid.elevation.size(), 1);
  EXPECT_EQ(grid.elevation(0, 0), 7);
  EXPECT_EQ(grid.emptyCellShare(), 0);
}

TEST(ElevationGrid, HeightsBelowAllThatIsUsualCount) {
  Points points(3, 2);
  points << 0, 3, 0, 0, -3e38F, std::numeric_limits<float>::lowest();
  const ElevationGrid grid = gridOf(points, 2);
  EXPECT_TRUE(grid.observed.all());
  EXPECT_EQ(grid.elevation(0, 0), static_cast<double>(-3e38F));
}

class ElevationGridOfSeed : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, ElevationGridOfSeed, testing::Range(1U, 7U));

TEST_P(ElevationGridOfSeed, HoldsTheHighestPointOfEachCell) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  const double cell_size = test::uniform(random, 0.03, 0.3);
  const Points points = test::randomBox(800, {-3, 100, -2}, {1, 103, 2}, random);
  const ElevationGrid grid = gridOf(points, cell_size);
  const Eigen::Vector2d origin = grid.geometry.origin;

  std::map<std::pair<Eigen::Index, Eigen::Index>, double> highest;
  for (const auto& point : points.colwise()) {
    const Eigen::Vector3d p = point.cast<double>();
    const std::pair<Eigen::Index, Eigen::Index> cell(std::floor((p.x() - origin.x()) / cell_size),
                                                     std::floor((p.y() - origin.y()) / cell_size));
    const auto [entry, is_new] = highest.emplace(cell, p.z());
    if (!is_new) entry->second = std::max(entry->second, p.z());
  }
  EXPECT_EQ(static_cast<std::size_t>(grid.observed.count()), highest.size());
  for (const auto& [cell, height] : highest) {
    ASSERT_TRUE(grid.observed(cell.first, cell.second));
    EXPECT_EQ(grid.elevation(cell.first, cell.second), height);
  }
  EXPECT_DOUBLE_EQ(grid.emptyCellShare(),
                   1 - static_cast<double>(highest.size()) / static_cast<double>(grid.elevation.size()));
}

TEST_P(ElevationGridOfSeed, DoesNotDependOnTheOrderOfThePoints) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  const Points points = test::randomBox(3000, {0, 0, 0}, {4, 3, 1}, random);
  const ElevationGrid a = gridOf(points, 0.05), b = gridOf(test::shuffled(points, random), 0.05);
  EXPECT_TRUE((a.elevation == b.elevation).all());
  EXPECT_TRUE((a.observed == b.observed).all());
}

TEST_P(ElevationGridOfSeed, IsContinuedFromItsNearestObservedCells) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  const Points points = test::randomBox(60, {0, 0, 0}, {7, 11, 1}, random);
  const ElevationGrid grid = gridOf(points, 1);
  GridGeometry longer = grid.geometry;
  longer.rows += 3;
  longer.cols += 5;
  const ElevationGrid continued = rasteriseHighest(points, longer);
  ASSERT_EQ(continued.elevation.rows(), longer.rows);
  ASSERT_EQ(continued.elevation.cols(), longer.cols);

  // The same from a filled grid to which empty cells are added.
  Eigen::ArrayXXd expected = Eigen::ArrayXXd::Zero(longer.rows, longer.cols);
  Mask observed = Mask::Constant(longer.rows, longer.cols, false);
  expected.topLeftCorner(grid.geometry.rows, grid.geometry.cols) = grid.elevation;
  observed.topLeftCorner(grid.geometry.rows, grid.geometry.cols) = grid.observed;
  fillEmptyCells(expected, observed);
  EXPECT_TRUE((continued.elevation == expected).all());

  const ElevationGrid corner = lowerCorner(continued, grid.geometry.rows, grid.geometry.cols);
  EXPECT_EQ(corner.geometry.origin, grid.geometry.origin);
  EXPECT_EQ(corner.geometry.cell_size, grid.geometry.cell_size);
  EXPECT_EQ(corner.geometry.rows, grid.geometry.rows);
  EXPECT_EQ(corner.geometry.cols, grid.geometry.cols);
  EXPECT_TRUE((corner.elevation == grid.elevation).all());
  EXPECT_TRUE((corner.observed == grid.observed).all());
}

}  // namespace
}  // namespace pcl_fft_ground::core
