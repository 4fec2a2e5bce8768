#pragma once

#include <vector>

#include "ground/robust_cells.h"
#include "ground/robust_fit.h"
#include "ground/robust_surface.h"
#include "pcl_fft_ground/core/ground/robust_ground.h"

/// The steps of fitRobustGround() that have a file each, in the order in which it takes them.
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

/** Continues the ground where a band-limited surface has cut off the crests of smooth land.
 *
 * From cell to cell the ground goes on as a quadric through the ground around leads one to expect, as curved
 * as the land is where all of it is ground. A region that is gained so has to follow from the ground around
 * it: most of the cells that were judged by that alone have to be ground.
 *
 * \param ground observed cells
 * \param spread of the ground [m]
 * \param largest_object [m]
 * \return the cells gained; none where too little ground is seen to tell its shape
 */
Mask continuedGround(const CellMap& land, const Mask& ground, double spread, double largest_object);

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

/// Ground usually lies closer to the surface than this share of the largest object.
constexpr double USUAL_TOLERANCE = 0.0098;
/// Nor is ground deeper below it than this share.
constexpr double USUAL_DEPTH = 0.03;

}  // namespace pcl_fft_ground::core
