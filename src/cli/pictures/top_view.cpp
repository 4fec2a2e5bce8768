#include "pictures/top_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "methods/segmentation.h"
#include "pcl_fft_ground/core/scan/frame.h"
#include "pictures/raster.h"

namespace pcl_fft_ground::cli {
namespace {

using Eigen::ArrayXXi;
using Eigen::Index;

/// Side of a cell such that the longer side has at most this many, and that a cell holds two points on
/// average [m].
double cellSizeFor(const core::Bounds& bounds, Index points, Index most_cells) {
  constexpr double POINTS_PER_CELL = 2.0;
  const Eigen::Array2d sides = (bounds.high - bounds.low).head<2>();
  const double finest = sides.maxCoeff() / static_cast<double>(most_cells);
  const double dense = std::sqrt(POINTS_PER_CELL * sides.prod() / static_cast<double>(points));
  const double size = std::max(finest, dense);
  return size > 0 ? size : 1.0;
}

}  // namespace

TopView viewFromAbove(const pcl::PointCloud<Point>& cloud, const Eigen::Vector3d& up, Index most_cells) {
  TopView view;
  view.cells.assign(cloud.size(), -1);
  const Eigen::Isometry3d level_from_input(Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()));
  const core::Points level = core::transformed(usablePoints(cloud).points, level_from_input);
  if (level.cols() == 0) return view;
  const core::Bounds bounds = core::boundsOf(level);
  const core::ElevationGrid grid =
      core::rasteriseHighest(level, core::gridAround(bounds, cellSizeFor(bounds, level.cols(), most_cells)));
  view.top = {grid.observed.select(grid.elevation, std::numeric_limits<double>::quiet_NaN()),
              grid.geometry.origin, grid.geometry.cell_size};
  for (std::size_t n = 0; n < cloud.size(); ++n) {
    const Eigen::Vector3d p = cloud[n].getVector3fMap().cast<double>();
    if (p.allFinite()) view.cells[n] = cellBelow(grid.geometry, level_from_input * p);
  }
  return view;
}

ArrayXXi classesFromAbove(const TopView& view, const std::vector<int>& classes, int count) {
  ArrayXXi votes = ArrayXXi::Zero(count, view.top.values.size());
  for (std::size_t n = 0; n < classes.size(); ++n)
    if (view.cells[n] >= 0) ++votes(classes[n], view.cells[n]);
  ArrayXXi winners = ArrayXXi::Constant(view.top.values.rows(), view.top.values.cols(), -1);
  for (Index cell = 0; cell < winners.size(); ++cell) {
    const int most = votes.col(cell).maxCoeff();
    for (int k = 0; k < count && most > 0; ++k)
      if (votes(k, cell) == most) winners.data()[cell] = k;
  }
  return winners;
}

}  // namespace pcl_fft_ground::cli
