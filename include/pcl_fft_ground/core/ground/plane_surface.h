#pragma once

#include <Eigen/Geometry>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/ground/ground_surface.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"

namespace pcl_fft_ground::core {

/// A plane that is not vertical: z = slope . (x, y) + offset [m].
struct Plane {
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  double offset = 0;
};

/** A plane as a ground surface of 2 x 2 cells whose centres span the bounds.
 * \param bounds of the points in the level frame; the surface is flat beyond them
 */
PCL_FFT_GROUND_CORE_EXPORT GroundSurface planeSurface(const Eigen::Isometry3d& frame_from_input,
                                                      const Bounds& bounds, const Plane& plane);

}  // namespace pcl_fft_ground::core
