#include "pcl_fft_ground/core/grid/scan_coverage.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "grid/morphology.h"

namespace pcl_fft_ground::core {
namespace {

using Cell = std::pair<Eigen::Index, Eigen::Index>;

constexpr Eigen::Index MARGIN = 2;          // uncovered cells around the points
constexpr std::size_t LARGEST_SHADOW = 30;  // a larger hole was not seen, for all we know [cells]

Mask occupiedCells(const PointsView& points, const GridGeometry& geometry) {
  Mask occupied = Mask::Constant(geometry.rows, geometry.cols, false);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Eigen::Array2d cell =
        (points.col(n).head<2>().cast<double>() - geometry.origin).array() / geometry.cell_size;
    occupied(static_cast<Eigen::Index>(cell.x()), static_cast<Eigen::Index>(cell.y())) = true;
  }
  return occupied;
}

/// The uncovered cells that hang together with one, which are marked as visited.
std::vector<Cell> holeAround(const Cell& start, const Mask& covered, Mask& visited) {
  std::vector<Cell> hole = {start};
  visited(start.first, start.second) = true;
  for (std::size_t next = 0; next < hole.size(); ++next)
    for (const auto& [di, dj] : std::array<Cell, 4>{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}}) {
      const Cell cell(hole[next].first + di, hole[next].second + dj);
      const bool inside =
          cell.first >= 0 && cell.second >= 0 && cell.first < covered.rows() && cell.second < covered.cols();
      if (!inside || covered(cell.first, cell.second) || visited(cell.first, cell.second)) continue;
      visited(cell.first, cell.second) = true;
      hole.push_back(cell);
    }
  return hole;
}

/// Covers the holes that may be the shadow of an object.
Mask withoutShadows(Mask covered) {
  Mask visited = covered;
  holeAround({0, 0}, covered, visited);
  for (Eigen::Index j = 0; j < covered.cols(); ++j)
    for (Eigen::Index i = 0; i < covered.rows(); ++i) {
      if (visited(i, j)) continue;
      const std::vector<Cell> hole = holeAround({i, j}, covered, visited);
      if (hole.size() > LARGEST_SHADOW) continue;
      for (const auto& [row, col] : hole) covered(row, col) = true;
    }
  return covered;
}

/// Distance of every covered cell to the border of the nearest uncovered one.
Eigen::ArrayXXf depthOf(const Mask& covered, double cell_size) {
  const Eigen::ArrayXd rows =
      Eigen::ArrayXd::LinSpaced(covered.rows(), 0, static_cast<double>(covered.rows() - 1));
  const Eigen::ArrayXd cols =
      Eigen::ArrayXd::LinSpaced(covered.cols(), 0, static_cast<double>(covered.cols() - 1));
  const Eigen::ArrayXXd row = rows.replicate(1, covered.cols());
  const Eigen::ArrayXXd col = cols.transpose().replicate(covered.rows(), 1);
  Eigen::ArrayXXd nearest_row = row;
  Eigen::ArrayXXd nearest_col = col;
  fillEmptyCells(nearest_row, !covered);
  fillEmptyCells(nearest_col, !covered);
  const Eigen::ArrayXXd cells = ((nearest_row - row).square() + (nearest_col - col).square()).sqrt();
  return (cell_size * (cells - 0.5).max(0)).cast<float>();
}

/// Centre of a covered cell.
Eigen::Vector3d cellCentre(const GridGeometry& cells, Eigen::Index row, Eigen::Index col) {
  return {cells.origin.x() + (static_cast<double>(row) + 0.5) * cells.cell_size,
          cells.origin.y() + (static_cast<double>(col) + 0.5) * cells.cell_size, 0.0};
}

/// Area of the moving scan that the reference covers, too [m^2].
double sharedArea(const ScanCoverage& reference, const ScanCoverage& moving,
                  const Eigen::Isometry3d& reference_from_moving) {
  double cells = 0.0;
  for (Eigen::Index j = 0; j < moving.depth.cols(); ++j) {
    for (Eigen::Index i = 0; i < moving.depth.rows(); ++i) {
      if (moving.depth(i, j) <= 0.0F) continue;
      if (reference.covers(reference_from_moving * cellCentre(moving.geometry, i, j), 0.0)) cells += 1.0;
    }
  }
  return cells * moving.geometry.cell_size * moving.geometry.cell_size;
}

}  // namespace

double ScanCoverage::depthAt(double x, double y) const {
  const double row = (x - geometry.origin.x()) / geometry.cell_size;
  const double col = (y - geometry.origin.y()) / geometry.cell_size;
  const bool inside = row >= 0 && col >= 0 && row < static_cast<double>(depth.rows()) &&
                      col < static_cast<double>(depth.cols());
  return inside ? depth(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(col)) : 0;
}

double ScanCoverage::area() const {
  return static_cast<double>((depth > 0).count()) * geometry.cell_size * geometry.cell_size;
}

GridGeometry coverageCells(const Bounds& bounds, double cell_size) {
  GridGeometry geometry = gridAround(bounds, cell_size);
  geometry.origin.array() -= MARGIN * cell_size;
  geometry.rows += 2 * MARGIN;
  geometry.cols += 2 * MARGIN;
  return geometry;
}

ScanCoverage coverageOf(const GridGeometry& cells, const Mask& occupied) {
  const Mask closed = !dilated(!dilated(occupied, 1), 1);
  return {cells, depthOf(withoutShadows(closed), cells.cell_size)};
}

ScanCoverage coverageOf(const PointsView& points, double cell_size) {
  if (points.cols() == 0) return {};
  const GridGeometry geometry = coverageCells(boundsOf(points), cell_size);
  return coverageOf(geometry, occupiedCells(points, geometry));
}

double overlapShare(const ScanCoverage& reference, const ScanCoverage& moving,
                    const Eigen::Isometry3d& reference_from_moving) {
  const double smaller = std::min(reference.area(), moving.area());
  if (smaller <= 0.0) return 0.0;
  return std::min(1.0, sharedArea(reference, moving, reference_from_moving) / smaller);
}

}  // namespace pcl_fft_ground::core
