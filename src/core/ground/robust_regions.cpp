#include "ground/robust_regions.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace pcl_fft_ground::core {
namespace {

using Cell = std::pair<Eigen::Index, Eigen::Index>;

struct Region {
  std::vector<Cell> cells;
  double length = 0;  ///< diagonal of the bounding box [cells]
};

/// The region around a cell, taken out of the mask.
Region takeRegion(Mask& mask, const Cell& start) {
  Region region{{start}};
  mask(start.first, start.second) = false;
  Cell low = start, high = start;
  for (std::size_t n = 0; n < region.cells.size(); ++n) {
    const auto [row, col] = region.cells[n];
    low = {std::min(low.first, row), std::min(low.second, col)};
    high = {std::max(high.first, row), std::max(high.second, col)};
    for (Eigen::Index j = std::max<Eigen::Index>(col - 1, 0); j <= std::min(col + 1, mask.cols() - 1); ++j)
      for (Eigen::Index i = std::max<Eigen::Index>(row - 1, 0); i <= std::min(row + 1, mask.rows() - 1); ++i)
        if (std::exchange(mask(i, j), false)) region.cells.emplace_back(i, j);
  }
  region.length = std::hypot(static_cast<double>(high.first - low.first + 1),
                             static_cast<double>(high.second - low.second + 1));
  return region;
}

}  // namespace

Mask dilated(const Mask& mask, Eigen::Index reach) {
  const Eigen::Index rows = mask.rows(), cols = mask.cols();
  Mask along = mask;
  for (Eigen::Index shift = 1; shift <= std::min(reach, rows - 1); ++shift) {
    along.topRows(rows - shift) = along.topRows(rows - shift) || mask.bottomRows(rows - shift);
    along.bottomRows(rows - shift) = along.bottomRows(rows - shift) || mask.topRows(rows - shift);
  }
  Mask both = along;
  for (Eigen::Index shift = 1; shift <= std::min(reach, cols - 1); ++shift) {
    both.leftCols(cols - shift) = both.leftCols(cols - shift) || along.rightCols(cols - shift);
    both.rightCols(cols - shift) = both.rightCols(cols - shift) || along.leftCols(cols - shift);
  }
  return both;
}

Mask eroded(const Mask& mask, Eigen::Index reach) {
  const Eigen::Index rows = mask.rows(), cols = mask.cols();
  Mask result = Mask::Constant(rows, cols, false);
  if (rows <= 2 * reach || cols <= 2 * reach) return result;
  const Mask missing = dilated(!mask, reach);
  result.block(reach, reach, rows - 2 * reach, cols - 2 * reach) =
      !missing.block(reach, reach, rows - 2 * reach, cols - 2 * reach);
  return result;
}

Mask regionsAround(Mask mask, const Mask& cores, const RegionSize& size) {
  Mask kept = Mask::Constant(mask.rows(), mask.cols(), false);
  for (Eigen::Index j = 0; j < mask.cols(); ++j)
    for (Eigen::Index i = 0; i < mask.rows(); ++i) {
      if (!mask(i, j) || !cores(i, j)) continue;
      const Region region = takeRegion(mask, {i, j});
      const auto area = static_cast<double>(region.cells.size());
      if (region.length < size.least_length || area < size.least_area) continue;
      for (const auto& [row, col] : region.cells) kept(row, col) = true;
    }
  return kept;
}

}  // namespace pcl_fft_ground::core
