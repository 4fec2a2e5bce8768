#pragma once

#include <Eigen/Core>
#include <cmath>
#include <random>
#include <vector>

#include "pcl_fft_ground/core/scan/points.h"
#include "random_points.h"

namespace pcl_fft_ground::test {

/** One point per cell: point (i, j) stands at the lower corner of cell (i, j) of the grid around all of them.
 * \param cell_size [m]; a power of two, so that no point slips over the border of its cell by rounding
 * \param height function of the cell (i, j) [m]
 */
template <typename Height>
core::Points onePointPerCell(Eigen::Index rows, Eigen::Index cols, double cell_size, const Height& height) {
  core::Points points(3, rows * cols);
  for (Eigen::Index j = 0; j < cols; ++j)
    for (Eigen::Index i = 0; i < rows; ++i)
      points.col(i + j * rows) = Eigen::Vector3d(static_cast<double>(i) * cell_size,
                                                 static_cast<double>(j) * cell_size, height(i, j))
                                     .cast<float>();
  return points;
}

/// Points scattered evenly over [0, width) x [0, depth) on the ground z = height(x, y).
template <typename Height>
core::Points scatteredOn(Eigen::Index count, double width, double depth, const Height& height,
                         std::mt19937& random) {
  core::Points points = randomBox(count, {0, 0, 0}, {width, depth, 1}, random);
  for (Eigen::Index n = 0; n < count; ++n)
    points(2, n) =
        static_cast<float>(height(static_cast<double>(points(0, n)), static_cast<double>(points(1, n))));
  return points;
}

/// A wave with whole numbers of periods over a grid.
struct Wave {
  Eigen::Index k = 0;    ///< periods along x
  Eigen::Index l = 0;    ///< periods along y
  double amplitude = 1;  ///< [m]
  double phase = 0;      ///< [rad]

  /// Height [m] of the wave over a cell of a grid of `rows` x `cols` cells.
  double at(Eigen::Index i, Eigen::Index j, Eigen::Index rows, Eigen::Index cols) const {
    const double turns = static_cast<double>(i * k) / static_cast<double>(rows) +
                         static_cast<double>(j * l) / static_cast<double>(cols);
    return amplitude * std::cos(2 * M_PI * turns + phase);
  }
};

}  // namespace pcl_fft_ground::test
