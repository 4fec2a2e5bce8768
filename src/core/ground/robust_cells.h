#pragma once

#include <Eigen/Core>
#include <vector>

#include "grid/bilinear_grid.h"
#include "ground/robust_points.h"
#include "ground/robust_scale.h"
#include "pcl_fft_ground/core/grid/elevation_grid.h"
#include "pcl_fft_ground/core/ground/robust_ground.h"

namespace pcl_fft_ground::core {

/// One point for each observed cell, in the order of the cells.
struct CellPoints {
  std::vector<Eigen::Vector3d> positions;  ///< level frame [m]: a cell's height holds where it was measured
  std::vector<Eigen::Index> cells;         ///< storage index of the cell
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

/// How the points in the band lie around the surface; told from about 20,000 of all points.
Spread spreadAround(const SortedPoints& points, const GroundBand& band);

/// The heights as a grid, empty cells filled from the nearest observed one.
ElevationGrid elevationOf(const CellPoints& points, const GridGeometry& cells);

}  // namespace pcl_fft_ground::core
