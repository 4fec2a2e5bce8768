#pragma once

#include <Eigen/Core>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// One flag per cell.
using Mask = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// Where the cells of a grid lie: cell (i, j) covers [origin + (i, j) * cell_size, origin + (i + 1, j + 1) *
/// cell_size).
struct GridGeometry {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< lower corner of cell (0, 0) [m]
  double cell_size = 0.02;                           ///< side of a cell [m], > 0
  Eigen::Index rows = 0;                             ///< cells along x
  Eigen::Index cols = 0;                             ///< cells along y
};

/// Elevation map of a scan (Sec. IV-A): rows along x, columns along y.
struct ElevationGrid {
  GridGeometry geometry;
  Eigen::ArrayXXd elevation;  ///< height of a cell [m]; an empty cell holds that of the nearest observed one
  Mask observed;              ///< true where the cell holds a point

  /// Share of the cells without a point, in [0, 1]; 0 for a grid without cells.
  PCL_FFT_GROUND_CORE_EXPORT double emptyCellShare() const;
};

/// The largest number of cells that a grid may have.
constexpr double MAX_CELLS = 1e8;

/** The smallest grid that covers the bounds horizontally: its lower corner is theirs.
 * \param cell_size side of a cell [m], > 0
 * \throws std::length_error if the grid would have more than MAX_CELLS cells
 */
PCL_FFT_GROUND_CORE_EXPORT GridGeometry gridAround(const Bounds& bounds, double cell_size);

/** The highest point of each cell; empty cells take the height of the nearest observed cell
 * (fillEmptyCells()).
 *
 * \param points points in the level frame, at least one, all inside of the grid
 */
PCL_FFT_GROUND_CORE_EXPORT ElevationGrid rasteriseHighest(const PointsView& points,
                                                          const GridGeometry& geometry);

/** Gives every unobserved cell the value of the nearest observed one: exact Euclidean distance between cell
 * centres.
 *
 * Ties go to the lower column, then to the lower row. With no observed cell the values are left alone.
 *
 * \param values one value per cell
 * \param observed the same size as `values`
 * \note O(cells): distance transform of Felzenszwalb and Huttenlocher (2012), carrying the nearest cell along
 */
PCL_FFT_GROUND_CORE_EXPORT void fillEmptyCells(Eigen::ArrayXXd& values, const Mask& observed);

/// The first `rows` x `cols` cells of a grid, which has no fewer; a grid that is moved in is not copied.
PCL_FFT_GROUND_CORE_EXPORT ElevationGrid lowerCorner(ElevationGrid grid, Eigen::Index rows,
                                                     Eigen::Index cols);

}  // namespace pcl_fft_ground::core
