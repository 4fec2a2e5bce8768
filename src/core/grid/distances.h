#pragma once

#include "pcl_fft_ground/core/grid/elevation_grid.h"

namespace pcl_fft_ground::core {

/// The distance of every cell from the nearest chosen one, between their centres [cells]; 0 where none is.
/// By the transform of fillEmptyCells(), without asking which cell that is.
Eigen::ArrayXXd distancesFrom(const Mask& chosen);

}  // namespace pcl_fft_ground::core
