#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/** How a scan looks along a direction: the lowest and the highest points of cells across it.
 *
 * Seen along up, the lowest points are ground, which is smoother than the tops of what stands on it; seen
 * along down it is the other way round, and along any other direction both are rough. Roughness is the mean
 * second difference of neighbouring cells' heights over the side of a cell, so that a slope has none and a
 * scale does not matter; a geometric mean is taken over two sizes of cells.
 */
struct UpProfile {
  std::optional<double> rough_below, rough_above;  ///< nothing where too few cells lie side by side
  bool is_enclosed = false;   ///< two smooth sheets with the scan between them: floor and ceiling
  Eigen::ArrayXXd low, high;  ///< along the direction, of the larger cells [m]; NaN where they are empty

  /// By how much smoother the ground below is than what is above, a logarithm: positive where the direction
  /// is up. 0 where nothing tells.
  double evidence() const;
};

/// \param points a sample of the scan is enough: some thousand points
UpProfile profileAlong(const Points& points, const Eigen::Vector3d& direction);

/// The spread of points along a direction over the smaller one across it, between their 10 and 90 %
/// quantiles.
double heightToBreadth(const Points& points, const Eigen::Vector3d& direction);

/** How many separate things stand out on one side of the sheet that lies across a direction, as far as they
 * are about as high as the highest of them. Objects are several as a rule; a pit, seen upside down, is one.
 * \param up the side on which they stand out
 */
int thingsStandingOut(const Points& points, const Eigen::Vector3d& up);

/// Share of cells whose height is above a given one [0, 1]; 0 for no cells.
double shareAbove(const Eigen::ArrayXXd& heights, double height);

/** True where the points show that a sensor at the origin has measured them: rays.
 *
 * A scanner looks in all directions alike: in equal solid angles it finds equally many points, however far
 * away they are, and they lie at one distance. In a map the number grows with the square of the distance.
 * \note false where all points are about as far away, as nothing can be told there
 */
bool showsSensorAtOrigin(const PointsView& points);

}  // namespace pcl_fft_ground::core
