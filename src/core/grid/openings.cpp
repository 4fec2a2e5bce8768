#include "grid/openings.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

}  // namespace pcl_fft_ground::core
