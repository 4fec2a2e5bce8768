#pragma once

#include "pcl_fft_ground/simulation/simulation.h"
#include "simulation/scene.h"
#include "simulation/simulation_random.h"

namespace pcl_fft_ground::core {

/// The next object for a scene of this kind, where it comes to rest on the ground or on what lies there
/// already.
PlacedObject placeObject(SceneKind kind, const Scene& scene, Random& random);

}  // namespace pcl_fft_ground::core
