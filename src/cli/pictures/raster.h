#pragma once

#include <Eigen/Core>
#include <optional>

#include "pcl_fft_ground/core/grid/elevation_grid.h"

namespace pcl_fft_ground::cli {

/// Source cells [begin, begin + count) that one cell of a smaller grid stands for.
struct CellBlock {
  Eigen::Index begin;
  Eigen::Index count;
};

/// Block `k` of `blocks` when `cells` cells are divided evenly; needs 0 <= k < blocks <= cells, and then no
/// block is empty.
CellBlock cellBlock(Eigen::Index k, Eigen::Index blocks, Eigen::Index cells);

/// A grid of at most max_x x max_y cells: the mean of the finite values of each block, NaN where there are
/// none. Axes that fit already are kept as they are. Infinite values count as unknown.
Eigen::ArrayXXd reducedMean(const Eigen::ArrayXXd& values, Eigen::Index max_x, Eigen::Index max_y);

/// As above for classes: the most frequent non-negative one of each block, the larger of equals, -1 where
/// there is none. Empty cells are outvoted by any other, so that sparse points do not vanish.
Eigen::ArrayXXi reducedMode(const Eigen::ArrayXXi& classes, Eigen::Index max_x, Eigen::Index max_y);

/// Relief shading in [-1, 1] for light from the north-west (the upper left of the picture): 1 faces the
/// light, 0 lies as the terrain does on the whole, so that a plane is 0 everywhere, however tilted. The
/// contrast adapts to the terrain. 0 where unknown. `spacing` is the size of a cell [m] along x and y.
Eigen::ArrayXXd hillShade(const Eigen::ArrayXXd& heights, const Eigen::Vector2d& spacing);

/// Number of the cell, in the order of an Eigen array of the grid's size, above which a point of the level
/// frame lies; -1 if it is beside the grid.
inline Eigen::Index cellBelow(const core::GridGeometry& cells, const Eigen::Vector3d& point) {
  const Eigen::Array2d place = ((point.head<2>() - cells.origin) / cells.cell_size).array().floor();
  const bool is_inside = (place >= 0).all() && place.x() < static_cast<double>(cells.rows) &&
                         place.y() < static_cast<double>(cells.cols);
  return is_inside ? static_cast<Eigen::Index>(place.y()) * cells.rows + static_cast<Eigen::Index>(place.x())
                   : -1;
}

/// Values from `low` to `high`, low < high.
struct ValueRange {
  double low;
  double high;
};

/// The range between the quantiles `tail` and 1 - tail (in [0, 0.5)) of the finite values, on an even sample
/// of at most about a million of them. A constant array gets a small range around its value; none where
/// nothing is finite.
std::optional<ValueRange> robustRange(const Eigen::ArrayXXd& values, double tail = 0.005);

}  // namespace pcl_fft_ground::cli
