#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// Horizontal coordinates [m] of points: `axes` * (point - centre).
struct HorizontalProjection {
  Eigen::Matrix<double, 2, 3> axes;
  Eigen::Vector3d centre;

  Eigen::Vector2d operator()(const Eigen::Vector3f& point) const {
    return axes * (point.cast<double>() - centre);
  }
};

/** Tells quickly which points lie inside of a convex polygon and so cannot be corners of a hull around it.
 * The polygon is cut into strips; a strip knows the heights between which all of it is inside. All is
 * computed in float with a margin for rounding: some points just inside of the border are not recognised.
 */
class HullFilter {
 public:
  /// \param hull a convex polygon of horizontal coordinates, see convexHull()
  HullFilter(const std::vector<Eigen::Vector2d>& hull, const HorizontalProjection& projection);

  /// Ascending column numbers of all points but those that are recognised as lying inside of the polygon.
  std::vector<Eigen::Index> outside(const PointsView& points) const;

 private:
  /// \param first column number of the first point of the part
  std::vector<Eigen::Index> outsideOfPart(const PointsView& part, Eigen::Index first) const;

  static constexpr int STRIPS = 512;
  Eigen::Vector3f strip_axis_ = Eigen::Vector3f::Zero(), height_axis_ = Eigen::Vector3f::Zero();
  float strip_offset_ = 0, height_offset_ = 0;
  std::array<std::pair<float, float>, STRIPS + 2> inside_;  // nothing is inside of the first and the last
};

/// Horizontal coordinates of the points that can be corners of the convex hull of all: those outside of the
/// hull of a sample.
std::vector<Eigen::Vector2d> outermostPoints(const PointsView& points,
                                             const HorizontalProjection& projection);

}  // namespace pcl_fft_ground::core
