#pragma once

#include <Eigen/Core>
#include <optional>

#include "scan/point_sample.h"

namespace pcl_fft_ground::core {

/** The normal of the plane around which the closest-lying half of the points is flattest.
 *
 * From the given direction and from the principal axis in turn: take the thinnest slab across the direction
 * that holds half of the points, replace the direction by the smallest principal axis of that half, and
 * repeat (concentration steps of the minimum covariance determinant, Rousseeuw and Van Driessen 1999). Walls,
 * tall objects and outliers stay outside of the slab, and narrow strips do not tip over.
 *
 * A narrow strip (less than half as broad as long) can lie askew on objects that have more than half of the
 * points. As they stand on the ground, the same steps go on there with the lowest 30 % of the points; their
 * normal is taken where it leans by more than 5 degrees from the first one, they lie in a slab less than
 * 0.6 times as thick, and they are flatter than the first half: a pit beside level ground is not. Where no
 * half is flat, as more than half of a narrow strip is objects, the lowest 30 % alone are looked at.
 *
 * \param scan all points, or at least 4,000 of them by sampleOf()
 * \param given direction towards which the normal is turned, a unit vector
 * \return nothing where neither is a flat sheet (spread along the normal above a tenth of that along the
 * next axis), or where the normal leans by more than 45 degrees from the given direction
 * \note O(n); about 4,000 points are looked at, chosen by their coordinates, not by their order
 */
std::optional<Eigen::Vector3d> normalOfFlattestHalf(const PointSample& scan, const Eigen::Vector3d& given);

}  // namespace pcl_fft_ground::core
