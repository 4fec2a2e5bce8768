#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_fft_ground/core/export.h"

namespace pcl_fft_ground::core {

/** Convex hull of points in the plane (Andrew's monotone chain).
 *
 * \param points points [m] in any order, duplicates allowed
 * \return corners counter-clockwise from the lowest x (then the lowest y); collinear points are left out. One
 * corner for identical points, two for collinear ones, none for an empty set.
 * \note O(n log n)
 */
PCL_FFT_GROUND_CORE_EXPORT std::vector<Eigen::Vector2d> convexHull(std::vector<Eigen::Vector2d> points);

/** Direction of the smallest rectangle around a convex polygon.
 *
 * One side of that rectangle lies along an edge of the polygon. Among rectangles of equal area the one that
 * is turned least from the axes is taken.
 *
 * \param hull corners as returned by convexHull()
 * \return angle [rad] in (-pi/4, pi/4] by which the axes must be turned to lie along the rectangle; 0 for
 * fewer than two corners
 */
PCL_FFT_GROUND_CORE_EXPORT double minimumAreaRectangleAngle(const std::vector<Eigen::Vector2d>& hull);

}  // namespace pcl_fft_ground::core
