#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "pcl_fft_ground/simulation/simulation.h"
#include "simulation/scan_sensor.h"
#include "simulation/scene.h"
#include "simulation/simulation_random.h"

namespace pcl_fft_ground::core {

/// Height over the ground from which a point of an object counts as object [m]. \param noise of the range [m]
double faintHeight(double noise);

/** \brief Exactly as many sightings as asked for: the rays are made dense enough, and the surplus is dropped
 *  at random. */
std::vector<Sighting> senseExactly(std::size_t count, const Scene& scene, const ScanGeometry& geometry,
                                   const GapMask& gaps, std::uint32_t seed);

/// How places become points of a scan.
struct Measurement {
  Eigen::Isometry3d site_from_scan = Eigen::Isometry3d::Identity();  ///< the scan's own frame
  double noise;                                                      ///< standard deviation of the range [m]
  std::uint32_t seed;
  /// For each point how far it is thrown off along z [m]: 0, or it is an outlier; empty: no outliers.
  std::vector<double> offsets;
};

/// The points of these sightings with their labels, in the scan's own frame.
SimulatedScan measure(const std::vector<Sighting>& sightings, const Terrain& terrain,
                      const Measurement& measurement);

/** Measures the objects of a scene, in the site's frame.
 * \param footprint of the scan [m] \param faint height above the ground from which an object can be told from
 * it [m] */
std::vector<SimulatedObject> objectTruth(const Scene& scene, const Eigen::AlignedBox2d& footprint,
                                         double faint);

}  // namespace pcl_fft_ground::core
