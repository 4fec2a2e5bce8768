#pragma once

#include <optional>

#include "ground/robust_cells.h"

namespace pcl_fft_ground::core {

/** Ground above breaks of the land, which a band-limited surface has lost.
 *
 * Of the cells that stand out of the ground, those that progressive openings leave (openedGround()) are
 * gathered into regions, and each is judged by its rim: land has a gentle way in somewhere and carries
 * things, or runs out of the scan, or is larger than an object; an object is the top of its place.
 *
 * \param elevation heights of the cells, the empty ones filled
 * \param ground observed cells
 * \param largest_object [m]
 * \param max_slope steepest land, if it is known: then land is taken to break, and no proof asked for
 * \return observed cells; none where the land does not break
 */
Mask groundAboveBreaks(const CellMap& land, const ElevationGrid& elevation, const Mask& ground,
                       double largest_object, const std::optional<double>& max_slope);

/** Lets a surface follow the ground where that bends more sharply than its wavelengths can: at a ground cell
 * farther than three spreads from the surface the cell's own height takes its place.
 *
 * \param ground observed cells that are ground
 * \param spread of the ground points around the surface [m]
 * \param surface heights at the cells of `land` [m]
 */
void followGround(const CellMap& land, const Mask& ground, double spread, Eigen::ArrayXXd& surface);

/** Where the ground steps up from a cell to the next, the cell holds points of both levels.
 * \param ground observed cells that are ground
 * \param surface heights at the cells of `land` [m]
 * \return for each cell the height of the step [m], 0 where there is none
 */
Eigen::ArrayXXf stepsOfGround(const CellMap& land, const Mask& ground, const Eigen::ArrayXXd& surface);

}  // namespace pcl_fft_ground::core
