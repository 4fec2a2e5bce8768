#pragma once

#include "pcl_fft_ground/core/grid/elevation_grid.h"

namespace pcl_fft_ground::core {

/// The cells of a mask and all up to `reach` rows and columns away from one.
Mask dilated(const Mask& mask, Eigen::Index reach);

/// The cells of a mask from which none up to `reach` rows and columns away is missing; beyond the border all
/// are.
Mask eroded(const Mask& mask, Eigen::Index reach);

/// How large a region has to be.
struct RegionSize {
  double least_length;    ///< of the diagonal of its bounding box [cells]
  double least_area = 1;  ///< [cells]
};

/** The regions of a mask, connected along sides and corners, that hold a cell of `cores` and are large
 * enough. O(cells). */
Mask regionsAround(Mask mask, const Mask& cores, const RegionSize& size);

}  // namespace pcl_fft_ground::core
