#include "pictures/top_view.h"

#include <gtest/gtest.h>

#include <limits>

namespace pcl_fft_ground::cli {
namespace {

const Eigen::Vector3d UP = Eigen::Vector3d::UnitZ();

/// A level square of 1 m x 1 m, 100 points on each side.
pcl::PointCloud<Point> square() {
  pcl::PointCloud<Point> cloud;
  for (int row = 0; row < 100; ++row)
    for (int column = 0; column < 100; ++column)
      cloud.push_back({0.01f * static_cast<float>(column), 0.01f * static_cast<float>(row), 0});
  return cloud;
}

TEST(TopView, CellsHoldTheHighestOfTheirPoints) {
  pcl::PointCloud<Point> cloud = square();
  cloud[0].z = 2;
  const TopView view = viewFromAbove(cloud, UP, 10);
  EXPECT_NEAR(view.top.cell_size, 0.099, 1e-6);
  EXPECT_EQ(view.top.values(0, 0), 2);
  EXPECT_EQ(view.top.values(5, 5), 0);
  EXPECT_EQ(view.cells[0], 0);
  EXPECT_EQ(view.cells[50], 5);
}

TEST(TopView, SparseCloudsGetFewerCells) {
  const TopView view = viewFromAbove(square(), UP, 1000);
  EXPECT_NEAR(view.top.cell_size, 0.014, 0.001);  // two points in each cell
}

TEST(TopView, PointsThatAreNotFiniteOrFarAreInNoCell) {
  pcl::PointCloud<Point> cloud = square();
  cloud[0].x = 1e6f;
  cloud[1].z = std::numeric_limits<float>::quiet_NaN();
  const TopView view = viewFromAbove(cloud, UP, 10);
  EXPECT_EQ(view.cells[0], -1);
  EXPECT_EQ(view.cells[1], -1);
  EXPECT_NEAR(view.top.cell_size, 0.099, 1e-3);
  for (auto& point : cloud) point.x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(viewFromAbove(cloud, UP, 10).top.values.size(), 0);
}

TEST(TopView, LooksAgainstTheGivenUp) {
  pcl::PointCloud<Point> cloud = square();
  for (auto& point : cloud) point = {0.5f * point.x, point.z, point.y};  // upright, facing y
  const TopView view = viewFromAbove(cloud, Eigen::Vector3d::UnitY(), 100);
  EXPECT_NEAR(static_cast<double>(view.top.values.rows()), 50, 1);
  EXPECT_NEAR(static_cast<double>(view.top.values.cols()), 100, 1);
}

TEST(TopView, TheMostFrequentClassWinsAndTheLargerOfEquals) {
  TopView view;
  view.top.values = Eigen::ArrayXXd::Zero(2, 2);
  view.cells = {0, 0, 0, 1, 1, 3, -1};
  const Eigen::ArrayXXi classes = classesFromAbove(view, {0, 0, 2, 1, 0, 2, 1}, 3);
  EXPECT_EQ(classes(0, 0), 0);
  EXPECT_EQ(classes(1, 0), 1);
  EXPECT_EQ(classes(0, 1), -1);
  EXPECT_EQ(classes(1, 1), 2);
}

}  // namespace
}  // namespace pcl_fft_ground::cli
