#pragma once

#include "ground/robust_cells.h"

namespace pcl_fft_ground::core {

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

}  // namespace pcl_fft_ground::core
