#pragma once

#include <Eigen/Core>

#include "pcl_fft_ground/core/grid/elevation_grid.h"
#include "pcl_fft_ground/core/ground/robust_ground.h"

namespace pcl_fft_ground::core {

/// Ground usually lies closer to the surface than this share of the largest object.
constexpr double USUAL_TOLERANCE = 0.0098;
/// Nor is ground deeper below it than this share.
constexpr double USUAL_DEPTH = 0.03;

/// What is fitted, all values given or chosen.
struct RobustPlan {
  double extent = 0;           ///< smaller horizontal extent of the points [m]
  double max_object_size = 0;  ///< [m]
  GridGeometry cells;          ///< the elevation cells
  CellStatistic statistic = CellStatistic::LOWEST;
  double finest_wavelength = 0;  ///< [m]
  double slope = 0;              ///< of the scale's floor: threshold as a share of the wavelength [m/m]
};

/** Chooses what is not set from the bounds and the number of the points.
 * \param choices takes what was chosen, with its reason
 * \throws std::length_error if the grid would have more than MAX_CELLS cells
 */
RobustPlan planRobustGround(const RobustParameters& parameters, const Bounds& bounds, Eigen::Index points,
                            std::vector<RobustChoice>& choices);

/** Chooses the tolerances by the scale, the size of objects and the spacing of the points.
 * \param ground elevation, scale and largest object known
 */
void chooseTolerances(const RobustParameters& parameters, Eigen::Index points, RobustGround& ground);

}  // namespace pcl_fft_ground::core
