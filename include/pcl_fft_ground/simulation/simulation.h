#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pcl_fft_ground/simulation/export.h"

namespace pcl_fft_ground::core {

/// What lies on the simulated sea floor.
enum class SceneKind {
  WRECK,  ///< 4 m x 4 m: a mound on a slope with fractal roughness, amphorae half buried, alone or piled
  PIPES,  ///< 6 m x 1.5 m: flat to gently rolling, cylindrical pipe segments
  REEF,   ///< 4 m x 4 m: undulating (relief 0.1-0.3 m, wavelengths from 0.5 m up), boulders of 0.1-1 m
  BARE    ///< 20 m x 20 m, in surveys only: relief of a metre, wavelengths 3-30 m, no objects
};

/** \brief What to simulate, and how it is seen.
 *
 * The seed decides on everything random. Ground and objects do not depend on \c points, \c gap_share,
 * \c outlier_share and \c tilt_degrees, and of two object shares the larger one holds the objects of the
 * smaller: so one scene can be had dense and thin, whole and with gaps.
 */
struct SimulationParameters {
  SceneKind scene = SceneKind::WRECK;  ///< ground, kind of objects and footprint
  std::uint32_t seed = 1;              ///< any value; equal seeds give equal scans
  std::size_t points = 600000;         ///< points of the scan, 1 to 100,000,000
  double object_share = 0.5;   ///< share of label 1 among labels 0 and 1, 0 to 0.8 (reached to within 0.05)
  double noise = 0.003;        ///< standard deviation of the range [m], 0 to 0.1
  double gap_share = 0.0;      ///< share of the footprint without points, 0 to 0.9
  double outlier_share = 0.0;  ///< share of points that are outliers, up to 10 m off, 0 to 0.5
  double tilt_degrees = 0.0;   ///< turn of the whole scan about its x axis [degrees], -45 to 45
  double altitude = 3.0;       ///< height of the laser above the mean ground [m], 2 to 20
  double baseline = 0.5;       ///< distance of the camera behind the laser, along the track [m], 0 to 2
};

/** \brief A scan whose truth is known; all members hold one entry per point.
 *
 * Points come in the order in which they were measured: profile after profile along the track (+x), each
 * from -y to +y. They are given in the scan's own frame: origin amid the footprint at the mean height of the
 * ground, x along the track, z up (all before the tilt).
 */
struct SimulatedScan {
  Eigen::Matrix3Xf points;  ///< measured positions [m], noise and outliers included
  /// 1 object; 0 ground; 2 neither: outliers, and points of an object whose height above the ground without
  /// noise is below 4 standard deviations of the noise, where nobody could tell them from ground.
  std::vector<std::int32_t> labels;
  std::vector<std::int32_t> segments;  ///< number of the object, from 1; 0 for ground and outliers
  std::vector<float> ground_heights;   ///< z of the true ground at the point's x and y [m]
  Eigen::Isometry3d world_from_scan = Eigen::Isometry3d::Identity();  ///< true pose: undoes the tilt
};

/** \brief Simulates one scan by a structured-light laser scanner that looks down at the sea floor.
 *
 * The laser stands above the track and throws a fan of rays across it, even on a flat bottom; the camera
 * follows \c baseline behind. A point is measured where a ray first meets a surface, if the camera sees that
 * place too: overhangs, what lies behind an object and what lies in its shadow have no points. Gaussian noise
 * displaces each point along its ray. The footprint is cut to the rectangle of the scene.
 *
 * \return exactly \c parameters.points points
 * \throws std::invalid_argument naming the parameter, its value and what is allowed
 */
PCL_FFT_GROUND_SIMULATION_EXPORT SimulatedScan simulateScan(const SimulationParameters& parameters);

/// What is known of an object of a simulated scan; metres, in the scan's own frame.
struct SimulatedObject {
  std::int32_t segment = 0;                          ///< its number in SimulatedScan::segments
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< amid its length
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();   ///< unit length; of a boulder its longest one
  double length = 0;                                 ///< along the axis [m]
  double radius = 0;                                 ///< the largest across the axis [m]
  double volume = 0;                                 ///< above the ground [m^3], whether seen or not
  double share_seen = 0;  ///< of its outline, seen from above, where it stands out of the ground: what lies
                          ///< within the footprint and under no other object
};

/** The objects of the scan that simulateScan() makes of the same parameters, seen or not, by number.
 * \throws std::invalid_argument as simulateScan() does
 */
PCL_FFT_GROUND_SIMULATION_EXPORT std::vector<SimulatedObject> simulatedObjects(
    const SimulationParameters& parameters);

}  // namespace pcl_fft_ground::core
