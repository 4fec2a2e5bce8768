#include "pcl_fft_ground/core/tiles/tiling.h"

#include <algorithm>
#include <cmath>

namespace pcl_fft_ground::core {
namespace {

/// Tiles along an axis.
Eigen::Index tilesAlong(Eigen::Index cells, double cells_of_tile) {
  const double count = std::ceil(static_cast<double>(cells) / std::max(cells_of_tile, 1.0));
  return std::max<Eigen::Index>(1, static_cast<Eigen::Index>(count));
}

/// The first cell of a tile along an axis.
Eigen::Index beginOf(Eigen::Index tile, Eigen::Index tiles, Eigen::Index cells) {
  return tile * cells / tiles;
}

/// The tile along an axis that holds a cell.
Eigen::Index holding(Eigen::Index cell, Eigen::Index tiles, Eigen::Index cells) {
  Eigen::Index tile = cell * tiles / cells;
  while (tile + 1 < tiles && beginOf(tile + 1, tiles, cells) <= cell) ++tile;
  return tile;
}

}  // namespace

Tiling::Tiling(const GridGeometry& site, double tile_size, double margin)
    : site_(site),
      per_metre_(1 / site.cell_size),
      margin_(static_cast<Eigen::Index>(std::ceil(margin / site.cell_size))),
      along_(tilesAlong(site.rows, tile_size / site.cell_size)),
      across_(tilesAlong(site.cols, tile_size / site.cell_size)) {}

CellWindow Tiling::core(std::size_t tile) const {
  const Eigen::Index i = static_cast<Eigen::Index>(tile) % along_,
                     j = static_cast<Eigen::Index>(tile) / along_;
  const Eigen::Index row = beginOf(i, along_, site_.rows), col = beginOf(j, across_, site_.cols);
  return {row, col, beginOf(i + 1, along_, site_.rows) - row, beginOf(j + 1, across_, site_.cols) - col};
}

CellWindow Tiling::grown(const CellWindow& window, Eigen::Index by) const {
  const Eigen::Index row = std::max<Eigen::Index>(window.row - by, 0);
  const Eigen::Index col = std::max<Eigen::Index>(window.col - by, 0);
  return {row, col, std::min(window.row + window.rows + by, site_.rows) - row,
          std::min(window.col + window.cols + by, site_.cols) - col};
}

std::size_t Tiling::tileAt(Eigen::Index row, Eigen::Index col) const {
  return static_cast<std::size_t>(holding(row, along_, site_.rows) +
                                  along_ * holding(col, across_, site_.cols));
}

std::vector<std::size_t> Tiling::tilesIn(const CellWindow& window) const {
  const Eigen::Index first_i = holding(window.row, along_, site_.rows);
  const Eigen::Index last_i = holding(window.row + window.rows - 1, along_, site_.rows);
  const Eigen::Index first_j = holding(window.col, across_, site_.cols);
  const Eigen::Index last_j = holding(window.col + window.cols - 1, across_, site_.cols);
  std::vector<std::size_t> tiles;
  for (Eigen::Index j = first_j; j <= last_j; ++j)
    for (Eigen::Index i = first_i; i <= last_i; ++i)
      tiles.push_back(static_cast<std::size_t>(i + along_ * j));
  return tiles;
}

std::pair<Eigen::Index, Eigen::Index> Tiling::cellAt(float x, float y) const {
  const auto along = [&](float place, double origin, Eigen::Index cells) {
    const auto cell = static_cast<Eigen::Index>((static_cast<double>(place) - origin) * per_metre_);
    return std::clamp<Eigen::Index>(cell, 0, cells - 1);
  };
  return {along(x, site_.origin.x(), site_.rows), along(y, site_.origin.y(), site_.cols)};
}

GridGeometry Tiling::geometryOf(const CellWindow& window) const {
  const Eigen::Vector2d steps(static_cast<double>(window.row), static_cast<double>(window.col));
  return {site_.origin + site_.cell_size * steps, site_.cell_size, window.rows, window.cols};
}

}  // namespace pcl_fft_ground::core
