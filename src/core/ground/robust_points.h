#pragma once

#include "ground/robust_cells.h"
#include "ground/robust_surface.h"

namespace pcl_fft_ground::core {

/// How the points of the ground lie about the surface [m].
struct GroundPoints {
  double spread = 0;  ///< standard deviation, whatever stands on the ground
  bool sunk = false;  ///< the surface was sunk through what grows on the ground
};

/** Fits the surface to the ground points themselves: a cell may hold both ground and the foot of an object,
 * and its lowest points lie below the middle of the noise. Where the lowest points are plants, which shows in
 * a wide and skewed spread, the surface sinks through them.
 * \param usual what a spread of ground is expected to stay below, times three [m]
 */
GroundPoints fitGroundPoints(RobustSurface& surface, const SortedPoints& points, double usual);

}  // namespace pcl_fft_ground::core
