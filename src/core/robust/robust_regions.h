#pragma once

#include "pcl_fft_ground/core/elevation_grid.h"

namespace pcl_fft_ground::core {

/// The cells of a mask and all up to `reach` rows and columns away from one.
Mask dilated(const Mask& mask, Eigen::Index reach);

/// The cells of a mask from which none up to `reach` rows and columns away is missing; beyond the border all
/// are.
Mask eroded(const Mask& mask, Eigen::Index reach);

/** The regions of a mask, connected along sides and corners, that hold a cell of `cores` and whose bounding
 * box has a diagonal of at least `least_length` cells. O(cells). */
Mask regionsAround(Mask mask, const Mask& cores, double least_length);

}  // namespace pcl_fft_ground::core
