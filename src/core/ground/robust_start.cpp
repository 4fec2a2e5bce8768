#include "ground/robust_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace pcl_fft_ground::core {
namespace {

using Heights = std::vector<double>;

std::size_t blockOf(const Eigen::Vector3d& p, const GridGeometry& grid) {
  const Eigen::Vector2d at = (p.head<2>() - grid.origin) / grid.cell_size;
  const Eigen::Index i = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(at.x()), 0, grid.rows - 1);
  const Eigen::Index j = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(at.y()), 0, grid.cols - 1);
  return static_cast<std::size_t>(i + j * grid.rows);
}

std::vector<Heights> heightsOfBlocks(const std::vector<Eigen::Vector3d>& points, const GridGeometry& grid) {
  std::vector<Heights> blocks(static_cast<std::size_t>(grid.rows * grid.cols));
  for (const Eigen::Vector3d& p : points) blocks[blockOf(p, grid)].push_back(p.z());
  return blocks;
}

/// How many cells of a block must agree at the least: fewer where blocks are sparse.
double fewestAgreeing(const std::vector<Heights>& blocks) {
  std::vector<double> sizes;
  for (const Heights& block : blocks)
    if (!block.empty()) sizes.push_back(static_cast<double>(block.size()));
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2), sizes.end());
  return std::clamp(sizes[sizes.size() / 2] / 4, 1.0, 3.0);
}

/// The lowest level of a block at which enough of its cells lie within `window`.
std::optional<double> lowestLevel(Heights& heights, double fewest, double window) {
  constexpr double AGREEING = 0.15, LOW = 0.1;  // shares of the cells of a block
  std::sort(heights.begin(), heights.end());
  const auto count = static_cast<double>(heights.size());
  const auto needed = static_cast<std::size_t>(std::max(std::floor(fewest), std::ceil(AGREEING * count)));
  for (std::size_t n = 0; n + needed <= heights.size(); ++n)
    if (heights[n + needed - 1] - heights[n] <= window)
      return heights[n + std::min(static_cast<std::size_t>(LOW * count), needed - 1)];
  return std::nullopt;
}

/// True where most neighbours of a cell lie more than `reach` above or below it.
bool isContradicted(const ElevationGrid& blocks, Eigen::Index i, Eigen::Index j, double reach) {
  constexpr Eigen::Index NEIGHBOURS = 2;
  constexpr double ENOUGH = 0.3;
  double neighbours = 0, near = 0;
  for (Eigen::Index l = std::max<Eigen::Index>(j - NEIGHBOURS, 0);
       l <= std::min(j + NEIGHBOURS, blocks.geometry.cols - 1); ++l)
    for (Eigen::Index k = std::max<Eigen::Index>(i - NEIGHBOURS, 0);
         k <= std::min(i + NEIGHBOURS, blocks.geometry.rows - 1); ++k) {
      if ((k == i && l == j) || !blocks.observed(k, l)) continue;
      ++neighbours;
      if (std::abs(blocks.elevation(k, l) - blocks.elevation(i, j)) < reach) ++near;
    }
  return near < ENOUGH * neighbours;
}

/// Takes the contradicted blocks for empty, unless that leaves none.
void dropContradicted(ElevationGrid& blocks, double reach) {
  Mask kept = blocks.observed;
  for (Eigen::Index j = 0; j < kept.cols(); ++j)
    for (Eigen::Index i = 0; i < kept.rows(); ++i)
      if (kept(i, j)) kept(i, j) = !isContradicted(blocks, i, j, reach);
  if (kept.any()) blocks.observed = kept;
}

ElevationGrid emptyGrid(const GridGeometry& grid) {
  return {grid, Eigen::ArrayXXd::Zero(grid.rows, grid.cols), Mask::Constant(grid.rows, grid.cols, false)};
}

ElevationGrid lowestLevels(const std::vector<Eigen::Vector3d>& points, const GridGeometry& grid,
                           double window) {
  std::vector<Heights> heights = heightsOfBlocks(points, grid);
  ElevationGrid blocks = emptyGrid(grid);
  const double fewest = fewestAgreeing(heights);
  for (std::size_t k = 0; k < heights.size(); ++k) {
    const std::optional<double> level = lowestLevel(heights[k], fewest, window);
    blocks.elevation.data()[k] = level.value_or(0);
    blocks.observed.data()[k] = level.has_value();
  }
  return blocks;
}

}  // namespace

Eigen::ArrayXXd lowerEnvelope(const std::vector<Eigen::Vector3d>& points, const GridGeometry& grid,
                              double wavelength, PenalisedFit& fit) {
  constexpr int ITERATIONS = 20;
  ElevationGrid blocks = lowestLevels(points, grid, wavelength / 8);
  if (!blocks.observed.any()) blocks = lowestLevels(points, grid, std::numeric_limits<double>::infinity());
  dropContradicted(blocks, wavelength / 2);
  fillEmptyCells(blocks.elevation, blocks.observed);
  Eigen::ArrayXXd surface;
  for (int n = 0; n < ITERATIONS; ++n) {
    surface = blocks.elevation;
    fit.lowPass(surface);
    blocks.elevation = blocks.elevation.min(surface);
  }
  return surface;
}

}  // namespace pcl_fft_ground::core
