#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include <Eigen/Geometry>

#include "pcl_fft_ground/simulation/export.h"
#include "pcl_fft_ground/simulation/simulation.h"

namespace pcl_fft_ground::core {

/** \brief What site to survey, and how well the vehicle knows where it is.
 *
 * A vehicle runs lawn-mower transects over the site and crosses them twice at the end (loop closures); of
 * each 4 m x 4 m (WRECK), 6 m x 1.5 m (PIPES) or 20 m x 20 m (BARE) it makes a sub-map that overlaps its
 * neighbours by 30 to 60 %. Site, route and errors do not depend on \c points and \c drift.
 */
struct SurveyParameters {
  SceneKind site =
      SceneKind::WRECK;           ///< WRECK, 16 m x 10 m, PIPES, 16 m x 6 m with stones, or BARE, 68 m x 44 m
  std::uint32_t seed = 1;         ///< any value; equal seeds give equal surveys
  std::size_t points = 600000;    ///< points of each sub-map, 1 to 100,000,000
  double object_share = 0.3;      ///< share of object points amid the site, 0 to 0.8; 0 for BARE
  double noise = 0.003;           ///< standard deviation of the range [m], 0 to 0.1
  double navigation_error = 0.2;  ///< largest horizontal error of a sub-map's pose [m], 0 to 5
  double heading_error = 3.0;     ///< largest error of its heading [degrees], 0 to 45
  double drift = 0.0;             ///< by how far a sub-map is sheared from its start to its end [m], 0 to 1
  double altitude = 3.0;          ///< of the laser above the ground [m], 2 to 20
  double baseline = 0.5;          ///< distance of the camera behind the laser [m], 0 to 2
};

/// What suits a site: the members' defaults for those with objects, seen by a laser; for BARE a sonar's, 20 m
/// above the ground, with 0.25 m between points, 2 cm of noise, and 1 m and 2 degrees of navigation error.
PCL_FFT_GROUND_SIMULATION_EXPORT SurveyParameters surveyParametersFor(SceneKind site);

/** \brief A sub-map: a scan in its own, nearly level frame, its origin amid the footprint, x along the track.
 *
 * The scan's \c world_from_scan is the true pose.
 */
struct SimulatedSubmap {
  SimulatedScan scan;
  Eigen::Isometry3d world_from_navigation = Eigen::Isometry3d::Identity();  ///< pose as the vehicle takes it
};

/** \brief A survey whose truth is known; its sub-maps are made one at a time, as they are asked for.
 *
 * The navigation error of each sub-map is drawn anew: horizontally between a tenth and all of
 * \c navigation_error, in heading between a sixth and all of \c heading_error; also a few centimetres of
 * depth and tenths of a degree of tilt, which a vehicle measures better. Where \c drift is given, points are
 * displaced along it in a random direction in proportion to their place along the track.
 */
class PCL_FFT_GROUND_SIMULATION_EXPORT SurveySimulation {
 public:
  /// Builds the site and plans the route.
  /// \throws std::invalid_argument naming the parameter, its value and what is allowed
  explicit SurveySimulation(const SurveyParameters& parameters);
  ~SurveySimulation();
  SurveySimulation(SurveySimulation&&) noexcept;
  SurveySimulation& operator=(SurveySimulation&&) noexcept;

  /// Number of sub-maps.
  std::size_t size() const;

  /// Sub-map \c index (0 to size() - 1) in the order of the route; always the same for one index.
  /// \throws std::out_of_range for any other index
  SimulatedSubmap submap(std::size_t index) const;

 private:
  class Site;
  std::unique_ptr<Site> site_;
};

}  // namespace pcl_fft_ground::core
