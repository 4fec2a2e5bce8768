#include "pcl_fft_ground/core/ground/column_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pcl_fft_ground/core/grid/elevation_grid.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"

namespace pcl_fft_ground::core {
namespace {

/// The height of the column that holds a point.
template <typename Heights>
auto& columnOf(Heights& heights, const GridGeometry& cells, const Eigen::Vector3f& point) {
  const Eigen::Array2d cell = (point.head<2>().cast<double>() - cells.origin).array() / cells.cell_size;
  return heights(static_cast<Eigen::Index>(cell.x()), static_cast<Eigen::Index>(cell.y()));
}

}  // namespace

GroundSurface bottomVoxelSurface(const PointsView& points, const Eigen::Isometry3d& frame_from_input,
                                 double cell_size, double voxel_height) {
  constexpr double EMPTY = std::numeric_limits<double>::infinity();
  const Bounds bounds = boundsOf(points);
  const GridGeometry cells = gridAround(bounds, cell_size);
  if (points.cols() == 0) return {frame_from_input, {cells.origin, cell_size, 0, 0}, {}};
  Eigen::ArrayXXd tops = Eigen::ArrayXXd::Constant(cells.rows, cells.cols, EMPTY);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const double voxel = std::floor((points(2, n) - bounds.low.z()) / voxel_height);
    double& top = columnOf(tops, cells, points.col(n));
    top = std::min(top, bounds.low.z() + (voxel + 1) * voxel_height);
  }
  fillEmptyCells(tops, tops != EMPTY);
  return {frame_from_input, cells, std::move(tops)};
}

Labels labelByColumn(const PointsView& points, const GroundSurface& surface, double tolerance) {
  Labels labels(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const double top = columnOf(surface.height, surface.geometry, points.col(n));
    labels[static_cast<std::size_t>(n)] = points(2, n) < top + tolerance ? Label::GROUND : Label::OBJECT;
  }
  return labels;
}

}  // namespace pcl_fft_ground::core
