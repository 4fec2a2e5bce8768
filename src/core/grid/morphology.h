#pragma once

#include <vector>

#include "pcl_fft_ground/core/grid/elevation_grid.h"

namespace pcl_fft_ground::core {

/// What progressive openings cut off.
struct OpeningParameters {
  double max_object_size = 1;  ///< the widest window [m], > 0
  double least_height = 0.01;  ///< no object is lower than this [m], > 0
};

/** How steep the land would have to be for each cell to belong to it [m/m]; 0 where no opening cuts.
 *
 * Grey openings with windows that grow to the largest object follow one another. On land of a slope no
 * opening lowers a cell by more than the slope times the window's half width (progressive morphological
 * filter, Zhang et al. 2003; threshold as in SMRF, Pingel et al. 2013): the cells up to a steepness are what
 * is left of land with this slope. Unlike a low-pass surface an opening keeps the edge of a terrace that is
 * wider than the largest object. O(cells log(window)) for each window.
 *
 * \param elevation cells, the empty ones filled
 */
Eigen::ArrayXXf steepnessByOpenings(const ElevationGrid& elevation, const OpeningParameters& parameters);

/// The cells of a mask and all up to `reach` rows and columns away from one.
Mask dilated(const Mask& mask, Eigen::Index reach);

/// The cells of a mask from which none up to `reach` rows and columns away is missing; beyond the border all
/// are.
Mask eroded(const Mask& mask, Eigen::Index reach);

/// Chosen cells and the empty ones between those of them that lie close to each other: there may be but one
/// point to four cells.
Mask joined(const Mask& chosen, const Mask& observed);

/// Cells of a mask that are connected along sides and corners.
struct Region {
  std::vector<Eigen::Index> cells;  ///< storage indices
  double length = 0;                ///< diagonal of the bounding box [cells]
};

/// The regions of a mask, in the order of their first cells. O(cells).
std::vector<Region> regionsOf(Mask mask);

}  // namespace pcl_fft_ground::core
