#pragma once

#include <vector>

#include "pcl_fft_ground/core/grid/elevation_grid.h"

namespace pcl_fft_ground::core {

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
