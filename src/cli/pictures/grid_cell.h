#pragma once

#include <Eigen/Core>

#include "pcl_fft_ground/core/grid/elevation_grid.h"

namespace pcl_fft_ground::cli {

/// Number of the cell, in the order of an Eigen array of the grid's size, above which a point of the level
/// frame lies; -1 if it is beside the grid.
inline Eigen::Index cellBelow(const core::GridGeometry& cells, const Eigen::Vector3d& point) {
  const Eigen::Array2d place = ((point.head<2>() - cells.origin) / cells.cell_size).array().floor();
  const bool is_inside = (place >= 0).all() && place.x() < static_cast<double>(cells.rows) &&
                         place.y() < static_cast<double>(cells.cols);
  return is_inside ? static_cast<Eigen::Index>(place.y()) * cells.rows + static_cast<Eigen::Index>(place.x())
                   : -1;
}

}  // namespace pcl_fft_ground::cli
