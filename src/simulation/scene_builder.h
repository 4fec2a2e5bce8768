#pragma once

#include "pcl_fft_ground/simulation/simulation.h"
#include "simulation/scan_sensor.h"
#include "simulation/scene.h"
#include "simulation/simulation_random.h"

namespace pcl_fft_ground::core {

/// Length and width of a single scan of such a scene [m].
Eigen::Vector2d footprintOf(SceneKind kind);

/// The bare ground of a site; its mean height over \c extent is zero.
Terrain makeTerrain(SceneKind kind, const Eigen::AlignedBox2d& extent, std::uint32_t seed);

/** \brief Strews objects over a site until they make up the share of points that is asked for.
 *  \param site the bare ground
 *  \param geometry the scan by which the share is judged; for a large site one that covers it all
 *  \param share of points of objects that can be told from ground, 0 to 0.8
 *  \param faint height above the ground below which a point of an object does not count [m] */
Scene strewObjects(const Scene& site, SceneKind kind, const ScanGeometry& geometry, double share,
                   double faint, std::uint32_t seed);

/// The next object for a scene of this kind, where it comes to rest on the ground or on what lies there
/// already.
PlacedObject placeObject(SceneKind kind, const Scene& scene, Random& random);

}  // namespace pcl_fft_ground::core
