#pragma once

#include <vector>

#include "pcl_fft_ground/simulation/simulation.h"
#include "simulation/scene.h"

namespace pcl_fft_ground::core {

/** Measures the objects of a scene, in the site's frame.
 * \param footprint of the scan [m] \param faint height above the ground from which an object can be told from
 * it [m] */
std::vector<SimulatedObject> objectTruth(const Scene& scene, const Eigen::AlignedBox2d& footprint,
                                         double faint);

}  // namespace pcl_fft_ground::core
