#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_fft_ground/core/grid/elevation_grid.h"

namespace pcl_fft_ground::core {

/// The standard deviation [m] of a normal distribution around 0 that holds 95 % of the values as these are
/// held; 0 of none. Signs do not matter; the order becomes another.
double deviationOf(std::vector<float>& values);

/** How far the ground may be from the surface, as a standard deviation [m] for each cell.
 *
 * Where ground was seen it is the spread of its points. In a gap the land tells what to expect: how far,
 * where ground was seen, the surface is from the straight line between two places d away on both sides. A
 * place in a gap, a from the ground on one side and b on the other, is as uncertain as the middle between two
 * at d = sqrt(a b): the error of interpolating a curve of second degree is its curvature times a b / 2.
 *
 * \param surface heights of the cells [m]
 * \param distance of each cell from the nearest one with ground [m]
 * \param seen_within the surface is known so near to a cell with ground [m]
 * \param spread deviation of the ground's points from the surface [m]
 * \note O(n log n)
 */
Eigen::ArrayXXd surfaceUncertainty(const Eigen::ArrayXXd& surface, const Eigen::ArrayXXd& distance,
                                   double cell_size, double seen_within, double spread);

}  // namespace pcl_fft_ground::core
