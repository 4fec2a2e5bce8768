#include "pcl_fft_ground/core/ground/column_ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

GroundSurface surfaceOf(const Points& points, double cell_size, double voxel_height) {
  return bottomVoxelSurface(points, Eigen::Isometry3d::Identity(), cell_size, voxel_height);
}

/// Numbers of the voxel that holds each point, counted from the lowest corner of all.
Eigen::Array3Xd voxelsOf(const Points& points, double cell_size, double voxel_height) {
  const Eigen::Array3d side(cell_size, cell_size, voxel_height);
  const Eigen::Array3d low = points.rowwise().minCoeff().cast<double>();
  return ((points.cast<double>().array().colwise() - low).colwise() / side).floor();
}

/// Ground is what no point of the same column has a voxel below; every point is compared with every other.
Labels slowLabels(const Points& points, double cell_size, double voxel_height) {
  const Eigen::Array3Xd voxels = voxelsOf(points, cell_size, voxel_height);
  Labels labels;
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    bool lowest = true;
    for (Eigen::Index m = 0; m < points.cols(); ++m)
      lowest = lowest &&
               !((voxels.col(m).head<2>() == voxels.col(n).head<2>()).all() && voxels(2, m) < voxels(2, n));
    labels.push_back(lowest ? Label::GROUND : Label::OBJECT);
  }
  return labels;
}

class ColumnGround : public testing::TestWithParam<unsigned> {
 protected:
  std::mt19937 random_{GetParam()};
  const Points points_ = test::randomBox(600, {-3, 10, -1}, {2, 12, 1}, random_);
};
INSTANTIATE_TEST_SUITE_P(Seeds, ColumnGround, testing::Values(1U, 2U, 3U));

TEST_P(ColumnGround, LabelsAgreeWithBruteForce) {
  for (const double cell_size : {0.02, 0.3, 20.0})
    for (const double voxel_height : {0.05, 0.5, 10.0}) {
      SCOPED_TRACE(testing::Message() << cell_size << " x " << voxel_height);
      EXPECT_EQ(labelByColumn(points_, surfaceOf(points_, cell_size, voxel_height), 0),
                slowLabels(points_, cell_size, voxel_height));
    }
}

TEST_P(ColumnGround, SurfaceIsTheTopOfTheLowestVoxel) {
  constexpr double CELL = 0.5, HEIGHT = 0.125;
  const GroundSurface surface = surfaceOf(points_, CELL, HEIGHT);
  const Eigen::Array3Xd voxels = voxelsOf(points_, CELL, HEIGHT);
  const double low = static_cast<double>(points_.row(2).minCoeff());
  for (Eigen::Index n = 0; n < points_.cols(); ++n) {
    double lowest = voxels(2, n);
    for (Eigen::Index m = 0; m < points_.cols(); ++m)
      if ((voxels.col(m).head<2>() == voxels.col(n).head<2>()).all()) lowest = std::min(lowest, voxels(2, m));
    const auto row = static_cast<Eigen::Index>(voxels(0, n)), col = static_cast<Eigen::Index>(voxels(1, n));
    EXPECT_NEAR(surface.height(row, col), low + (lowest + 1) * HEIGHT, 1e-12);
  }
}

TEST(ColumnGroundCells, EmptyColumnsTakeTheNearest) {
  Points points(3, 2);
  points << 0, 5,  //
      0, 0,        //
      1, 3;
  const GroundSurface surface = surfaceOf(points, 1, 0.5);
  ASSERT_EQ(surface.height.rows(), 6);
  ASSERT_EQ(surface.height.cols(), 1);
  EXPECT_TRUE((surface.height.topRows(3) == 1.5).all());
  EXPECT_TRUE((surface.height.bottomRows(3) == 3.5).all());
}

TEST(ColumnGroundCells, ToleranceRaisesTheTop) {
  Points points(3, 4);
  points << 0, 0, 0, 0,  //
      0, 0, 0, 0,        //
      0, 0.25f, 0.5f, 0.75f;
  const GroundSurface surface = surfaceOf(points, 1, 0.5);
  const Label ground = Label::GROUND, object = Label::OBJECT;
  EXPECT_EQ(labelByColumn(points, surface, 0), (Labels{ground, ground, object, object}));
  EXPECT_EQ(labelByColumn(points, surface, 0.125), (Labels{ground, ground, ground, object}));
  EXPECT_EQ(labelByColumn(points, surface, -0.375), (Labels{ground, object, object, object}));
}

TEST(ColumnGroundCells, NoPoints) {
  const Points none(3, 0);
  const GroundSurface surface = surfaceOf(none, 1, 1);
  EXPECT_EQ(surface.height.size(), 0);
  EXPECT_TRUE(labelByColumn(none, surface, 0).empty());
}

TEST(ColumnGroundCells, RefusesTooManyColumns) {
  std::mt19937 random(4);
  EXPECT_THROW(surfaceOf(test::randomBox(10, {0, 0, 0}, {1, 1, 1}, random), 1e-9, 1), std::length_error);
}

}  // namespace
}  // namespace pcl_fft_ground::core
