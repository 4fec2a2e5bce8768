#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pcl_fft_ground/core/grid/elevation_grid.h"
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

}  // namespace pcl_fft_ground::core
