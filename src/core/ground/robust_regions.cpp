#include "ground/robust_regions.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace pcl_fft_ground::core {
namespace {

/// The region around a cell, taken out of the mask.
Region takeRegion(Mask& mask, Eigen::Index start) {
  const Eigen::Index rows = mask.rows(), cols = mask.cols();
  Region region{{start}};
  mask.data()[start] = false;
  Eigen::Array2<Eigen::Index> low(start % rows, start / rows), high = low;
  for (std::size_t n = 0; n < region.cells.size(); ++n) {
    const Eigen::Index row = region.cells[n] % rows, col = region.cells[n] / rows;
    low = low.min(Eigen::Array2<Eigen::Index>(row, col));
    high = high.max(Eigen::Array2<Eigen::Index>(row, col));
    for (Eigen::Index j = std::max<Eigen::Index>(col - 1, 0); j <= std::min(col + 1, cols - 1); ++j)
      for (Eigen::Index i = std::max<Eigen::Index>(row - 1, 0); i <= std::min(row + 1, rows - 1); ++i)
        if (std::exchange(mask(i, j), false)) region.cells.push_back(i + j * rows);
  }
  region.length = (high - low + 1).cast<double>().matrix().norm();
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

Mask joined(const Mask& chosen, const Mask& observed) {
  constexpr Eigen::Index REACH = 2;
  const Mask closed = !dilated(!dilated(chosen, REACH), REACH);
  return chosen || (closed && !observed);
}

std::vector<Region> regionsOf(Mask mask) {
  std::vector<Region> regions;
  for (Eigen::Index n = 0; n < mask.size(); ++n)
    if (mask.data()[n]) regions.push_back(takeRegion(mask, n));
  return regions;
}

}  // namespace pcl_fft_ground::core
