#include "hull_filter.h"

#include <algorithm>
#include <limits>

#include "pcl_fft_ground/core/convex_hull.h"

namespace pcl_fft_ground::core {
namespace {

/// Heights between which the vertical line at x lies inside of a convex polygon.
std::pair<double, double> insideHeights(const std::vector<Eigen::Vector2d>& hull, double x) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d &a = hull[i], &b = hull[(i + 1) % hull.size()];
    if (x < std::min(a.x(), b.x()) || x > std::max(a.x(), b.x()) || a.x() == b.x()) continue;
    const double y = a.y() + (b.y() - a.y()) * (x - a.x()) / (b.x() - a.x());
    low = std::min(low, y);
    high = std::max(high, y);
  }
  return {low, high};
}

/// More than the rounding errors of a horizontal coordinate computed in float [m].
double roundingMargin(const std::vector<Eigen::Vector2d>& hull, const HorizontalProjection& projection) {
  double reach = projection.centre.cwiseAbs().maxCoeff();
  for (const Eigen::Vector2d& corner : hull) reach = std::max(reach, corner.cwiseAbs().maxCoeff());
  return 32 * std::numeric_limits<float>::epsilon() * reach;
}

}  // namespace

HullFilter::HullFilter(const std::vector<Eigen::Vector2d>& hull, const HorizontalProjection& projection) {
  inside_.fill({0.0F, 0.0F});
  if (hull.size() < 3) return;
  const auto [left, right] = std::minmax_element(hull.begin(), hull.end(),
                                                 [](const auto& a, const auto& b) { return a.x() < b.x(); });
  const double margin = roundingMargin(hull, projection), width = right->x() - left->x();
  if (width < STRIPS * margin) return;
  const double strips_per_metre = STRIPS / width;
  strip_axis_ = (projection.axes.row(0) * strips_per_metre).cast<float>();
  strip_offset_ =
      static_cast<float>(-(projection.axes.row(0).dot(projection.centre) + left->x()) * strips_per_metre);
  height_axis_ = projection.axes.row(1).cast<float>();
  height_offset_ = static_cast<float>(-projection.axes.row(1).dot(projection.centre));

  const auto insideAt = [&](int strip, double shift) {
    return insideHeights(hull,
                         std::clamp(left->x() + strip / strips_per_metre + shift, left->x(), right->x()));
  };
  for (int strip = 0; strip < STRIPS; ++strip) {
    // The polygon is convex: what is inside at both ends of the strip is inside all over it.
    const auto a = insideAt(strip, -margin), b = insideAt(strip + 1, margin);
    inside_[static_cast<std::size_t>(strip)] = {static_cast<float>(std::max(a.first, b.first) + margin),
                                                static_cast<float>(std::min(a.second, b.second) - margin)};
  }
}

std::vector<Eigen::Vector2d> outermostPoints(const PointsView& points,
                                             const HorizontalProjection& projection) {
  constexpr Eigen::Index SAMPLE = 4096;
  const Eigen::Index step = std::max<Eigen::Index>(1, points.cols() / SAMPLE);
  std::vector<Eigen::Vector2d> sample;
  for (Eigen::Index i = 0; i < points.cols(); i += step) sample.push_back(projection(points.col(i)));
  std::vector<Eigen::Vector2d> result = convexHull(std::move(sample));

  const HullFilter filter(result, projection);
  std::array<Eigen::Index, 1024> outside;
  constexpr auto BLOCK = static_cast<Eigen::Index>(outside.size());
  for (Eigen::Index begin = 0; begin < points.cols(); begin += BLOCK) {
    std::size_t count = 0;
    for (Eigen::Index i = begin; i < std::min(begin + BLOCK, points.cols()); ++i) {
      outside[count] = i;
      count += filter.isInside(points.col(i)) ? 0 : 1;
    }
    for (std::size_t n = 0; n < count; ++n) result.push_back(projection(points.col(outside[n])));
  }
  return result;
}

}  // namespace pcl_fft_ground::core
