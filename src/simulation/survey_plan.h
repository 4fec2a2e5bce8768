#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "pcl_fft_ground/simulation/survey_simulation.h"

namespace pcl_fft_ground::core {

/// Where one sub-map is taken, seen from above.
struct SurveyStation {
  Eigen::Vector2d centre;  ///< [m]
  double heading;          ///< of the track, from +x towards +y [rad]
};

/// The rectangle that a survey covers, its middle at the origin [m].
Eigen::AlignedBox2d surveyExtent(SceneKind site);

/** \brief The stations of a survey in the order of the route: transects along x, to and fro, then two along y
 *  that cross them.
 *
 * Neighbours overlap by at least 40 % of a footprint, less what the vehicle strays from the plan.
 * \param footprint length along and width across the track [m], within the extent */
std::vector<SurveyStation> planSurvey(const Eigen::AlignedBox2d& extent, const Eigen::Vector2d& footprint,
                                      std::uint32_t seed);

/// What the vehicle does not know of one sub-map.
struct NavigationError {
  Eigen::Vector3d translation;  ///< navigation minus truth [m]
  double heading;               ///< navigation minus truth [rad]
  Eigen::Vector2d tilt;         ///< true roll and pitch of a frame that is taken for level [rad]
  Eigen::Vector3d drift;        ///< displacement of the end of the sub-map relative to its start [m]
};

/// One error for each of \c count sub-maps.
std::vector<NavigationError> drawErrors(const SurveyParameters& parameters, std::size_t count);

}  // namespace pcl_fft_ground::core
