#pragma once

#include <optional>
#include <vector>

#include "ground/robust_cells.h"

namespace pcl_fft_ground::core {

/// Cells above breaks of the land.
struct AboveBreaks {
  Mask cells;                            ///< of the observed ones; none where the land does not break
  bool is_known = false;                 ///< whether it is known that the land breaks
  std::vector<StandingRegion> standing;  ///< what of the plan's own cells has a say in that
};

/** Ground above breaks of the land, which a band-limited surface has lost.
 *
 * Of the cells that stand out of the ground, those that progressive openings leave (openedGround()) are
 * gathered into regions, and each is judged by its rim: land has a gentle way in somewhere and carries
 * things, or runs out of the scan, or is larger than an object; an object is the top of its place.
 *
 * \param elevation heights of the cells, the empty ones filled
 * \param ground observed cells
 * \param plan tells the largest object, where the scan ends, and whether the land is known to break
 * \param max_slope steepest land, if it is known: then land is taken to break, and no proof asked for
 */
AboveBreaks groundAboveBreaks(const CellMap& land, const ElevationGrid& elevation, const Mask& ground,
                              const RobustPlan& plan, const std::optional<double>& max_slope);

/// Whether a whole region is land; of those of PROOF and GENTLE that proves that the land breaks.
/// \param cell side of a cell [largest objects]
bool isLand(const StandingRegion& region, double cell);

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
