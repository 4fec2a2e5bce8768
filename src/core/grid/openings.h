#pragma once

#include "pcl_fft_ground/core/grid/elevation_grid.h"

namespace pcl_fft_ground::core {

/// What progressive openings take for ground.
struct OpeningParameters {
  double max_object_size = 1;  ///< the widest window [m], > 0
  double max_slope = 0.3;      ///< steepest ground [m/m], > 0
  double least_height = 0.01;  ///< no object is lower than this [m], > 0
};

/** The cells that no opening cuts off.
 *
 * Grey openings with windows that grow to the largest object follow one another; a cell that one of them
 * lowers by more than the slope times the window's half width is an object (progressive morphological filter,
 * Zhang et al. 2003; threshold as in SMRF, Pingel et al. 2013). Unlike a low-pass surface an opening keeps
 * the edge of a terrace that is wider than the largest object. O(cells log(window)) for each window.
 *
 * \param elevation cells, the empty ones filled
 */
Mask openedGround(const ElevationGrid& elevation, const OpeningParameters& parameters);

}  // namespace pcl_fft_ground::core
