#pragma once

#include <Eigen/Core>

#include "pcl_fft_ground/core/grid/elevation_grid.h"

namespace pcl_fft_ground::core {

/// What can be an object.
struct ObjectSize {
  double largest = 1;          ///< extent [m], > 0
  double least_height = 0.01;  ///< [m], > 0
};

/** Ground above a break, which a band-limited surface has lost.
 *
 * Of the observed cells that stand out of the surface, those which progressive openings leave standing
 * (openedGround(), slope 0.15) are gathered into connected regions. A region longer than the largest object
 * and broader than a fifth of it cannot be one: it is a terrace, the bench of a quarry, the land behind a
 * quay. Steeper cells (slope 0.3) beside it join in where they, too, form a region longer than an object.
 * What stands on the region stays cut off by the openings; a wall seen from one side is but a thin line.
 *
 * \param ground cells that the surface takes for ground
 * \return observed cells; none where the land does not break
 */
Mask groundAboveBreaks(const ElevationGrid& elevation, const Mask& ground, const ObjectSize& object);

/** Lets a surface follow the ground where that bends more sharply than its wavelengths can: at a ground cell
 * farther than three spreads from the surface the cell's own height takes its place.
 *
 * \param ground observed cells that are ground
 * \param spread of the ground points around the surface [m]
 * \param deepest how far below the surface ground can lie [m]: deeper cells are noise
 * \param surface heights at the cells of `elevation` [m]
 */
void followGround(const ElevationGrid& elevation, const Mask& ground, double spread, double deepest,
                  Eigen::ArrayXXd& surface);

}  // namespace pcl_fft_ground::core
