#include "grid/morphology.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pcl_fft_ground::core {
namespace {

using Heights = Eigen::ArrayXXf;

/// Smallest of every `length` values from each on that lie `stride` apart, in place. Windows double until two
/// of them span the length: whole grids at a time, O(log(length)) for each value.
void takeRunningMinimum(Heights& grid, Eigen::Index length, Eigen::Index stride) {
  Eigen::Map<Eigen::ArrayXf> values(grid.data(), grid.size());
  const auto take = [&](Eigen::Index shift) {
    const Eigen::Index count = values.size() - shift * stride;
    values.head(count) = values.head(count).min(values.tail(count));  // reads ahead of what it writes
  };
  Eigen::Index spanned = 1;
  for (; 2 * spanned <= length; spanned *= 2) take(spanned);
  if (spanned < length) take(length - spanned);
}

/// Smallest of the (2 reach + 1)^2 cells around each.
void erode(Heights& grid, Eigen::Index reach) {
  const Eigen::Index rows = grid.rows(), cols = grid.cols(), window = 2 * reach + 1;
  Heights padded =
      Heights::Constant(rows + 2 * reach, cols + 2 * reach, std::numeric_limits<float>::infinity());
  padded.block(reach, reach, rows, cols) = grid;
  takeRunningMinimum(padded, window, 1);
  takeRunningMinimum(padded, window, padded.rows());
  grid = padded.topLeftCorner(rows, cols);
}

/// Smallest, then largest of the (2 reach + 1)^2 cells around each.
Heights opened(Heights grid, Eigen::Index reach) {
  erode(grid, reach);
  grid = -grid;
  erode(grid, reach);
  return -grid;
}

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

Eigen::ArrayXXf steepnessByOpenings(const ElevationGrid& elevation, const OpeningParameters& parameters) {
  constexpr double GROWTH = 1.5;
  const GridGeometry& cells = elevation.geometry;
  const auto widest =
      static_cast<Eigen::Index>(std::clamp(std::ceil(0.5 * parameters.max_object_size / cells.cell_size), 1.0,
                                           static_cast<double>(std::max(cells.rows, cells.cols))));
  const auto least_height = static_cast<float>(parameters.least_height);
  Heights surface = elevation.elevation.cast<float>();
  Heights steepness = Heights::Zero(cells.rows, cells.cols);
  for (Eigen::Index reach = 1; reach > 0;) {
    Heights lower = opened(surface, reach);
    const auto per_metre = static_cast<float>(1 / (static_cast<double>(reach) * cells.cell_size));
    surface -= lower;
    steepness = steepness.max((surface > least_height).select(surface * per_metre, 0.0F));
    surface.swap(lower);
    const auto wider = static_cast<Eigen::Index>(GROWTH * static_cast<double>(reach));
    reach = reach == widest ? 0 : std::min(std::max(reach + 1, wider), widest);
  }
  return steepness;
}

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
