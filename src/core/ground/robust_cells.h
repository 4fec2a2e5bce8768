#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "grid/bilinear_grid.h"
#include "ground/robust_scale.h"
#include "pcl_fft_ground/core/grid/elevation_grid.h"
#include "pcl_fft_ground/core/ground/robust_ground.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/** The points of a scan cell by cell: what is read again and again comes in one run.
 *
 * The order within a cell is that of the input; no result should depend on it.
 */
class SortedPoints {
 public:
  /// \param cells a grid around the bounds of the points
  SortedPoints(const PointsView& points, const Bounds& bounds, const GridGeometry& cells);

  const Bounds& bounds() const { return bounds_; }
  const GridGeometry& cells() const { return cells_; }
  const Points& positions() const { return positions_; }

  /// Number of cells that hold points.
  std::size_t size() const { return observed_.size(); }

  /// Storage index of the n-th cell that holds points.
  Eigen::Index cell(std::size_t n) const { return observed_[n]; }

  /// The first of its points; end() of one is begin() of the next.
  Eigen::Index begin(std::size_t n) const { return begins_[n]; }
  Eigen::Index end(std::size_t n) const { return begins_[n + 1]; }

  /// Lower corner of the n-th cell [m].
  Eigen::Vector2d corner(std::size_t n) const {
    const Eigen::Index i = observed_[n] % cells_.rows, j = observed_[n] / cells_.rows;
    return cells_.origin + cells_.cell_size * Eigen::Vector2d(static_cast<double>(i), static_cast<double>(j));
  }

 private:
  Bounds bounds_;
  GridGeometry cells_;
  Points positions_;
  std::vector<std::int32_t> observed_;
  std::vector<Eigen::Index> begins_;
};

/// One point for each observed cell, in the order of the cells.
struct CellPoints {
  std::vector<Eigen::Vector3d> positions;  ///< level frame [m]: a cell's height holds where it was measured
  std::vector<Eigen::Index> cells;         ///< storage index of the cell
};

/// Finds the point of a cell, and the cells of a stretch of a column that have one: however few they are,
/// none of the others is looked at.
class CellMap {
 public:
  CellMap(const CellPoints& points, const GridGeometry& cells);

  const GridGeometry& cells() const { return cells_; }
  Eigen::Index size() const { return cells_.rows * cells_.cols; }
  bool isObserved(Eigen::Index cell) const { return before(cell) < before(cell + 1); }
  /// Level frame [m]; of an observed cell.
  const Eigen::Vector3d& point(Eigen::Index cell) const { return pointOf(before(cell)); }
  /// The point of a number, as visitColumn() tells it.
  const Eigen::Vector3d& pointOf(std::size_t number) const { return points_.positions[number]; }

  /// Calls visit(number, cell) for the observed cells from `first` to `last`, both in one column; number is
  /// that of the cell's point.
  template <typename Visit>
  void visitColumn(Eigen::Index first, Eigen::Index last, const Visit& visit) const {
    const std::size_t end = before(last + 1);
    for (std::size_t n = before(first); n < end; ++n) visit(n, points_.cells[n]);
  }

  /// Share of the cells that hold points, (0, 1].
  double density() const;
  /// About as far away is the next observed cell [cells].
  Eigen::Index reach() const;

 private:
  /// Number of the observed cells before one.
  std::size_t before(Eigen::Index cell) const { return before_[static_cast<std::size_t>(cell)]; }

  const CellPoints& points_;
  GridGeometry cells_;
  std::vector<std::uint32_t> before_;  // of each cell, and behind the last
};

/** A point for each cell by the statistic. The result does not depend on the order of the points. */
CellPoints representativePoints(const SortedPoints& points, CellStatistic statistic);

/// A surface and the band around it in which points are ground.
struct GroundBand {
  const BilinearGrid& grid;
  const Eigen::ArrayXXd& surface;
  double low, high;  ///< least and greatest height above the surface [m]
};

/// The mean of those points of each cell that lie in the band.
CellPoints meanGroundPoints(const SortedPoints& points, const GroundBand& band);

/** Heights above the surface of the points in the band [m]; of about 20,000 of all points.
 * \param left_out cells that are not looked at, or null
 */
std::vector<float> heightsIn(const SortedPoints& points, const GroundBand& band,
                             const Mask* left_out = nullptr);

/// Height above the surface of the lowest point of each cell [m], 0 where there is none.
Eigen::ArrayXXf lowestHeights(const SortedPoints& points, const GroundBand& band);

/// Cells that hold a point above the band.
Mask cellsReachingAbove(const SortedPoints& points, const GroundBand& band);

/// The heights as a grid, empty cells filled from the nearest observed one.
ElevationGrid elevationOf(const CellPoints& points, const GridGeometry& cells);

}  // namespace pcl_fft_ground::core
