#pragma once

#include <Eigen/Geometry>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/grid/elevation_grid.h"
#include "pcl_fft_ground/core/ground/ground_surface.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// Settings of estimateGraphCutGround().
struct GraphCutParameters {
  double cell_size = 0.02;       ///< side of an elevation cell [m], > 0
  double max_object_size = 1.0;  ///< side of the window in which the lowest cell counts as ground [m], > 0
  double object_height =
      0.05;  ///< height above the lower surface where ground and object are equally likely [m], > 0
  double step_height = 0.02;  ///< height step between neighbours that makes a border likely [m], > 0
  double smoothness =
      0.5;  ///< cost of a border between two cells of equal height; 1 is a cell's full data cost, >= 0
};

/// The ground of a scan by minimum cut.
struct GraphCutGround {
  ElevationGrid elevation;  ///< highest point of each cell
  Mask is_object;           ///< the labels of the cells
  GroundSurface surface;    ///< elevation of the ground cells; object cells take the nearest one's
};

/** Labels the cells of the elevation grid as ground or object by minimum cut: the comparison that the paper
 * leaves to future work, after Boykov and Funka-Lea (2006), its reference [4].
 *
 * With z_i the elevation of cell i and b_i a lower surface (the opening of the elevation by a square of the
 * largest object's size: running minimum, then running maximum), the labels l minimise
 *
 *     sum_i D_i(l_i) + smoothness sum_{i,j neighbours} exp(-(z_i - z_j)^2 / (2 step_height^2)) [l_i != l_j]
 *     D_i(ground) = min(1, (z_i - b_i) / (2 object_height)),   D_i(object) = 1 - D_i(ground)
 *
 * over the 4-neighbourhood; an empty cell has no data term. Boykov and Kolmogorov's algorithm (Boost.Graph)
 * finds the global minimum. In practice the time grows a little faster than the number of cells; about 500
 * bytes a cell.
 *
 * \param points points in the level frame
 * \throws std::length_error if the grid would have more than a hundredth of MAX_CELLS cells
 */
PCL_FFT_GROUND_CORE_EXPORT GraphCutGround estimateGraphCutGround(const PointsView& points,
                                                                 const Eigen::Isometry3d& frame_from_input,
                                                                 const GraphCutParameters& parameters);

/// The opening of a grid by a square of (2 half_window + 1)^2 cells: running minimum, then running maximum.
/// O(cells).
PCL_FFT_GROUND_CORE_EXPORT Eigen::ArrayXXd opening(const Eigen::ArrayXXd& values, Eigen::Index half_window);

}  // namespace pcl_fft_ground::core
