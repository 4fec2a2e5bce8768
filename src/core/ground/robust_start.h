#pragma once

#include "ground/robust_cells.h"
#include "ground/robust_fit.h"

namespace pcl_fft_ground::core {

/** A first surface that passes below the objects: the lower envelope of the scan at one wavelength.
 *
 * The blocks of the grid take the lowest level at which a share of their cells agrees (a lone outlier far
 * below does not); blocks that most of their neighbours contradict are left out; then the smaller of height
 * and low-pass surface replaces the height again and again, so that the surface sinks to the ground between
 * the objects, wherever some is seen.
 * \param fit of that grid and wavelength
 */
Eigen::ArrayXXd lowerEnvelope(const std::vector<Eigen::Vector3d>& points, const GridGeometry& grid,
                              double wavelength, PenalisedFit& fit);

}  // namespace pcl_fft_ground::core
