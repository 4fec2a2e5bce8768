#pragma once

#include <Eigen/Core>

#include "pcl_fft_ground/core/points.h"

namespace pcl_fft_ground::core {

/** About as many of the points as are wanted, all of them if they are no more than twice as many.
 *
 * The coordinates of a point decide on it: which points are chosen does not depend on their order.
 */
Points sampleOf(const PointsView& points, Eigen::Index wanted);

}  // namespace pcl_fft_ground::core
