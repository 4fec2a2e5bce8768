#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/grid/elevation_grid.h"

namespace pcl_fft_ground::core {

/// A block of the cells of a grid.
struct CellWindow {
  Eigen::Index row = 0, col = 0;    ///< its first cell
  Eigen::Index rows = 0, cols = 0;  ///< how many it has

  bool contains(Eigen::Index i, Eigen::Index j) const {
    return i >= row && j >= col && i < row + rows && j < col + cols;
  }
};

/** The cells of a site divided into tiles of nearly one size, which together hold every cell once.
 *
 * Work on a tile looks at the cells around it, too: what lies within a margin of its border.
 */
class PCL_FFT_GROUND_CORE_EXPORT Tiling {
 public:
  /// \param site the cells of the whole site, at least one
  /// \param tile_size largest side of a tile [m], > 0; a tile has at least one cell
  /// \param margin width of what is looked at around a tile [m], >= 0
  Tiling(const GridGeometry& site, double tile_size, double margin);

  const GridGeometry& site() const { return site_; }
  std::size_t size() const { return static_cast<std::size_t>(along_ * across_); }
  Eigen::Index margin() const { return margin_; }  ///< [cells]

  /// The cells of a tile. \param tile below size()
  CellWindow core(std::size_t tile) const;

  /// A window with so many cells more on each side, as far as there are any.
  CellWindow grown(const CellWindow& window, Eigen::Index by) const;

  /// What is looked at for a tile: its cells and the margin.
  CellWindow seen(std::size_t tile) const { return grown(core(tile), margin_); }

  /// The tile of a cell of the site.
  std::size_t tileAt(Eigen::Index row, Eigen::Index col) const;

  /// The tiles with cells in a window of the site, ascending.
  std::vector<std::size_t> tilesIn(const CellWindow& window) const;

  /// Row and column of the site's cell that holds a place of the level frame; beside the site the nearest
  /// one.
  std::pair<Eigen::Index, Eigen::Index> cellAt(float x, float y) const;

  /// The cells of a window as a grid of their own.
  GridGeometry geometryOf(const CellWindow& window) const;

 private:
  GridGeometry site_;
  double per_metre_;
  Eigen::Index margin_;
  Eigen::Index along_, across_;  // tiles along rows and columns
};

}  // namespace pcl_fft_ground::core
