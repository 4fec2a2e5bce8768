#pragma once

#include <optional>

#include "pcl_fft_ground/core/segments/object_properties.h"

namespace pcl_fft_ground::core {

/** The cylinder or ellipsoid of revolution that fits points on the upper side of a body better.
 * \param points at least a dozen, z up \param box principal axes and lengths of the points
 * \return nothing where neither fits well
 */
std::optional<RoundBody> fitRoundBody(const Eigen::Matrix3Xd& points, const ObjectProperties& box);

}  // namespace pcl_fft_ground::core
