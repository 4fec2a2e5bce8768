#pragma once

#include "pcl_fft_ground/core/ground/robust_ground.h"

namespace pcl_fft_ground::core {

/// Ground usually lies closer to the surface than this share of the largest object.
constexpr double USUAL_TOLERANCE = 0.0098;
/// Nor is ground deeper below it than this share.
constexpr double USUAL_DEPTH = 0.03;

/** Raises the tolerance where the points say so, up to the greatest one.
 *
 * Ground is as likely to lie above its surface as below it. Hence the points below a depth d are as many as
 * the ground that a tolerance d calls objects, and the points above, up to d, less those below, are objects
 * that it calls ground. The least sum is taken, the ground's share counted twice.
 *
 * \param points of which to judge, in the level frame
 * \param ground tolerances chosen, all else known
 */
void widenTolerance(const RobustParameters& parameters, const PointsView& points, RobustGround& ground);

}  // namespace pcl_fft_ground::core
