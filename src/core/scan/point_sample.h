#pragma once

#include <Eigen/Core>

#include "pcl_fft_ground/core/scan/point_statistics.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/** About as many of the points as are wanted, all of them if they are no more than twice as many or if none
 * would be chosen.
 *
 * The coordinates of a point decide on it: which points are chosen does not depend on their order.
 */
Points sampleOf(const PointsView& points, Eigen::Index wanted);

/// Some points of a scan, as sampleOf() chooses them, and the number of those that it has.
struct PointSample {
  Points points;
  Eigen::Index total = 0;
};

/** The same points as sampleOf() of all would give, fewer of them taken from a larger sample.
 * \param total number of the points from which the sample is
 */
Points sampleOfSample(const PointsView& sample, Eigen::Index total, Eigen::Index wanted);

/** Distance of neighbouring points [m], seen from above, from squares so large that those with points hold
 * several. \param scan all points, or at least 30,000 of them by sampleOf()
 */
double spacingOf(const PointSample& scan, const Bounds& bounds);

}  // namespace pcl_fft_ground::core
