#include "pcl_fft_ground/core/ground/graph_cut_ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "analytic_worlds.h"
#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double CELL = 0.0625;  // a power of two: see onePointPerCell()

GraphCutGround groundOf(const Points& points, const GraphCutParameters& parameters) {
  return estimateGraphCutGround(points, Eigen::Isometry3d::Identity(), parameters);
}

/// Smallest (or largest) value of the window around every cell, by looking at all of them.
template <typename Choose>
Eigen::ArrayXXd slowExtremes(const Eigen::ArrayXXd& values, Eigen::Index half_window, const Choose& choose) {
  Eigen::ArrayXXd extremes = values;
  for (Eigen::Index j = 0; j < values.cols(); ++j)
    for (Eigen::Index i = 0; i < values.rows(); ++i)
      for (Eigen::Index l = 0; l < values.cols(); ++l)
        for (Eigen::Index k = 0; k < values.rows(); ++k)
          if (std::abs(k - i) <= half_window && std::abs(l - j) <= half_window)
            extremes(i, j) = choose(extremes(i, j), values(k, l));
  return extremes;
}

Eigen::ArrayXXd slowOpening(const Eigen::ArrayXXd& values, Eigen::Index half_window) {
  const auto smaller = [](double a, double b) { return std::min(a, b); };
  const auto larger = [](double a, double b) { return std::max(a, b); };
  return slowExtremes(slowExtremes(values, half_window, smaller), half_window, larger);
}

/// The energy as the header documents it. \param is_object label of each cell
double energyOf(const Mask& is_object, const ElevationGrid& grid, const GraphCutParameters& parameters,
                Eigen::Index half_window) {
  const Eigen::ArrayXXd& z = grid.elevation;
  const Eigen::ArrayXXd lower = slowOpening(z, half_window);
  double energy = 0;
  const auto addBorder = [&](Eigen::Index i, Eigen::Index j, Eigen::Index k, Eigen::Index l) {
    if (k >= z.rows() || l >= z.cols() || is_object(i, j) == is_object(k, l)) return;
    energy += parameters.smoothness *
              std::exp(-std::pow(z(i, j) - z(k, l), 2) / (2 * std::pow(parameters.step_height, 2)));
  };
  for (Eigen::Index j = 0; j < z.cols(); ++j)
    for (Eigen::Index i = 0; i < z.rows(); ++i) {
      const double ground_cost = std::min(1.0, (z(i, j) - lower(i, j)) / (2 * parameters.object_height));
      if (grid.observed(i, j)) energy += is_object(i, j) ? 1 - ground_cost : ground_cost;
      addBorder(i, j, i + 1, j);
      addBorder(i, j, i, j + 1);
    }
  return energy;
}

/// The labels of a grid of 3 x 3 cells, a bit each.
Mask labelling(unsigned bits) {
  Mask is_object(3, 3);
  for (Eigen::Index cell = 0; cell < 9; ++cell) is_object(cell) = (bits >> cell & 1U) != 0;
  return is_object;
}

double leastEnergy(const ElevationGrid& grid, const GraphCutParameters& parameters,
                   Eigen::Index half_window) {
  double least = std::numeric_limits<double>::infinity();
  for (unsigned bits = 0; bits < 512; ++bits)
    least = std::min(least, energyOf(labelling(bits), grid, parameters, half_window));
  return least;
}

/// 3 x 3 cells of random heights up to 0.2 m, three of four with the cells in the middle of two sides empty.
Points randomCells(unsigned seed) {
  std::mt19937 random(seed);
  Points points =
      test::onePointPerCell(3, 3, CELL, [&](auto, auto) { return test::uniform(random, 0, 0.2); });
  if (seed % 4 == 0) return points;
  return points(Eigen::all, std::vector<Eigen::Index>{0, 2, 4, 5, 6, 8});
}

TEST(GraphCutGround, LabelsHaveTheLeastEnergyOfAll) {
  int divided = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    GraphCutParameters parameters;
    parameters.cell_size = CELL;
    const Eigen::Index half_window = 1 + seed % 2;
    parameters.max_object_size = 2 * CELL * static_cast<double>(half_window);
    parameters.step_height = seed % 3 == 0 ? 0.02 : 0.1;
    parameters.smoothness = 0.25 * (seed % 5);
    const GraphCutGround ground = groundOf(randomCells(seed), parameters);
    ASSERT_EQ(ground.is_object.rows(), 3);
    ASSERT_EQ(ground.is_object.cols(), 3);
    EXPECT_EQ(ground.elevation.observed.count(), seed % 4 == 0 ? 9 : 6);
    EXPECT_NEAR(energyOf(ground.is_object, ground.elevation, parameters, half_window),
                leastEnergy(ground.elevation, parameters, half_window), 1e-9);
    divided += ground.is_object.any() && !ground.is_object.all() ? 1 : 0;
  }
  EXPECT_GT(divided, 20);
}

TEST(GraphCutGround, BoxOnASlopeIsCutOutAndTheGroundContinuesUnderIt) {
  const auto is_box = [](Eigen::Index i, Eigen::Index j) { return i >= 5 && i < 9 && j >= 6 && j < 9; };
  const auto slope = [](Eigen::Index i) { return 0.001 * static_cast<double>(i); };
  const Points points = test::onePointPerCell(
      20, 16, CELL, [&](Eigen::Index i, Eigen::Index j) { return slope(i) + (is_box(i, j) ? 0.3 : 0.0); });
  GraphCutParameters parameters;
  parameters.cell_size = CELL;
  parameters.max_object_size = 0.4;
  const GraphCutGround ground = groundOf(points, parameters);
  for (Eigen::Index j = 0; j < 16; ++j)
    for (Eigen::Index i = 0; i < 20; ++i) {
      EXPECT_EQ(ground.is_object(i, j), is_box(i, j)) << i << ", " << j;
      EXPECT_NEAR(ground.surface.height(i, j), slope(i), is_box(i, j) ? 0.003 : 1e-6);
    }
}

TEST(GraphCutGround, WhatIsWiderThanTheLargestObjectIsGround) {
  const Points points = test::onePointPerCell(24, 24, CELL, [](Eigen::Index i, Eigen::Index j) {
    return i >= 6 && i < 18 && j >= 6 && j < 18 ? 0.3 : 0.0;
  });
  GraphCutParameters parameters;
  parameters.cell_size = CELL;
  parameters.max_object_size = 8 * CELL;
  EXPECT_FALSE(groundOf(points, parameters).is_object.any());
  parameters.max_object_size = 16 * CELL;
  EXPECT_EQ(groundOf(points, parameters).is_object.count(), 144);
}

TEST(GraphCutGround, NoPointsAndOnePoint) {
  EXPECT_EQ(groundOf(Points(3, 0), {}).surface.height.size(), 0);
  const GraphCutGround one = groundOf(Points::Constant(3, 1, 2.0f), {});
  ASSERT_EQ(one.is_object.size(), 1);
  EXPECT_FALSE(one.is_object(0, 0));
  EXPECT_EQ(one.surface.height(0, 0), 2);
}

TEST(GraphCutGround, RefusesMoreThanAMillionCells) {
  GraphCutParameters parameters;
  parameters.cell_size = 1;
  Points points(3, 2);
  points << 0, 1000,  //
      0, 1000,        //
      0, 0;
  EXPECT_THROW(groundOf(points, parameters), std::length_error);
  parameters.cell_size = 1e-9;
  EXPECT_THROW(groundOf(points, parameters), std::length_error);
}

TEST(Opening, AgreesWithBruteForce) {
  std::mt19937 random(7);
  for (const auto& [rows, cols] :
       std::vector<std::pair<Eigen::Index, Eigen::Index>>{{1, 1}, {1, 12}, {11, 1}, {9, 14}})
    for (const Eigen::Index half_window : {0, 1, 3, 50}) {
      SCOPED_TRACE(testing::Message() << rows << " x " << cols << ", " << half_window);
      const Eigen::ArrayXXd values = test::randomGrid(rows, cols, random);
      EXPECT_TRUE((opening(values, half_window) == slowOpening(values, half_window)).all());
    }
}

}  // namespace
}  // namespace pcl_fft_ground::core
