#include "pcl_fft_ground/core/grid/elevation_grid.h"

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace pcl_fft_ground::core {
namespace {

constexpr double NOT_OBSERVED = -std::numeric_limits<double>::infinity();

[[noreturn]] void throwTooManyCells(const Eigen::Array2d& extent, double cell_size) {
  std::ostringstream message;
  message << "an elevation grid of " << extent.x() << " m x " << extent.y() << " m with cells of "
          << cell_size << " m would have more than " << MAX_CELLS << " cells; use larger cells";
  throw std::length_error(message.str());
}

}  // namespace

double ElevationGrid::emptyCellShare() const {
  if (observed.size() == 0) return 0;
  return 1.0 - static_cast<double>(observed.count()) / static_cast<double>(observed.size());
}

GridGeometry gridAround(const Bounds& bounds, double cell_size) {
  const Eigen::Array2d extent = (bounds.high - bounds.low).head<2>();
  const Eigen::Array2d cells = (extent / cell_size).floor() + 1;
  if (!(cells.prod() <= MAX_CELLS)) throwTooManyCells(extent, cell_size);
  return {bounds.low.head<2>().matrix(), cell_size, static_cast<Eigen::Index>(cells.x()),
          static_cast<Eigen::Index>(cells.y())};
}

ElevationGrid rasteriseHighest(const PointsView& points, const GridGeometry& geometry) {
  ElevationGrid grid{geometry, Eigen::ArrayXXd::Constant(geometry.rows, geometry.cols, NOT_OBSERVED), {}};
  const Eigen::Array2d origin = geometry.origin;
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Eigen::Array2d place = points.col(n).head<2>().cast<double>();
    const Eigen::Array2d cell = (place - origin) / geometry.cell_size;
    double& highest =
        grid.elevation(static_cast<Eigen::Index>(cell.x()), static_cast<Eigen::Index>(cell.y()));
    highest = std::max(highest, static_cast<double>(points(2, n)));
  }
  grid.observed = grid.elevation != NOT_OBSERVED;
  fillEmptyCells(grid.elevation, grid.observed);
  return grid;
}

ElevationGrid lowerCorner(ElevationGrid grid, Eigen::Index rows, Eigen::Index cols) {
  grid.geometry.rows = rows;
  grid.geometry.cols = cols;
  grid.elevation.conservativeResize(rows, cols);
  grid.observed.conservativeResize(rows, cols);
  return grid;
}

}  // namespace pcl_fft_ground::core
