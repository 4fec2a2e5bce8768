#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "pcl_fft_ground/core/convex_hull.h"

namespace pcl_fft_ground::core {

/** Tells quickly that a point cannot be a corner of the hull because it lies inside of a polygon of other
 * points. The polygon is cut into vertical strips; a strip knows the heights between which all of it is
 * inside.
 */
class HullFilter {
 public:
  /// \param hull a convex polygon, see convexHull()
  explicit HullFilter(const std::vector<Eigen::Vector2d>& hull);

  /// True if the point lies strictly inside of the polygon; may be false for points next to its border.
  bool isInside(const Eigen::Vector2d& point) const {
    const double strip = (point.x() - left_) * strips_per_metre_;
    if (!(strip >= 0 && strip < STRIPS)) return false;
    const auto& [low, high] = inside_[static_cast<std::size_t>(strip)];
    return point.y() > low && point.y() < high;
  }

 private:
  static constexpr int STRIPS = 256;
  double left_ = 0;
  double strips_per_metre_ = 0;
  std::array<std::pair<double, double>, STRIPS> inside_;
};

/** The points that can be corners of the convex hull of all points: those outside of the hull of a sample.
 * \param count number of points
 * \param point function from index to Eigen::Vector2d
 */
template <typename PointFunction>
std::vector<Eigen::Vector2d> outermostPoints(Eigen::Index count, const PointFunction& point) {
  constexpr Eigen::Index SAMPLE = 4096;
  const Eigen::Index step = std::max<Eigen::Index>(1, count / SAMPLE);
  std::vector<Eigen::Vector2d> sample;
  for (Eigen::Index i = 0; i < count; i += step) sample.push_back(point(i));
  std::vector<Eigen::Vector2d> result = convexHull(std::move(sample));

  const HullFilter filter(result);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector2d p = point(i);
    if (!filter.isInside(p)) result.push_back(p);
  }
  return result;
}

}  // namespace pcl_fft_ground::core
