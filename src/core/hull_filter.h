#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "pcl_fft_ground/core/points.h"

namespace pcl_fft_ground::core {

/// Horizontal coordinates [m] of points: `axes` * (point - centre).
struct HorizontalProjection {
  Eigen::Matrix<double, 2, 3> axes;
  Eigen::Vector3d centre;

  Eigen::Vector2d operator()(const Eigen::Vector3f& point) const {
    return axes * (point.cast<double>() - centre);
  }
};

/** Tells quickly that a point lies inside of a convex polygon and so cannot be a corner of a hull around it.
 * The polygon is cut into strips; a strip knows the heights between which all of it is inside. All is
 * computed in float with a margin for rounding: some points just inside of the border are not recognised.
 */
class HullFilter {
 public:
  /// \param hull a convex polygon of horizontal coordinates, see convexHull()
  HullFilter(const std::vector<Eigen::Vector2d>& hull, const HorizontalProjection& projection);

  /// True only if the point lies inside of the polygon.
  bool isInside(const Eigen::Vector3f& point) const {
    // Without branches: points come in any order, and a guess at each would often be wrong.
    const float strip = strip_axis_.dot(point) + strip_offset_;
    const float height = height_axis_.dot(point) + height_offset_;
    const float nearest = std::min(std::max(strip, 0.0F), static_cast<float>(STRIPS - 1));
    const auto& [low, high] = inside_[static_cast<std::size_t>(static_cast<int>(nearest))];
    return (strip >= 0) & (strip < STRIPS) & (height > low) & (height < high);
  }

 private:
  static constexpr int STRIPS = 256;
  Eigen::Vector3f strip_axis_ = Eigen::Vector3f::Zero(), height_axis_ = Eigen::Vector3f::Zero();
  float strip_offset_ = 0, height_offset_ = 0;
  std::array<std::pair<float, float>, STRIPS> inside_;
};

/// Horizontal coordinates of the points that can be corners of the convex hull of all: those outside of the
/// hull of a sample.
std::vector<Eigen::Vector2d> outermostPoints(const PointsView& points,
                                             const HorizontalProjection& projection);

}  // namespace pcl_fft_ground::core
