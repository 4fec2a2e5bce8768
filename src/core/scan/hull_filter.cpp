#include "scan/hull_filter.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "pcl_fft_ground/core/scan/convex_hull.h"
#include "pcl_fft_ground/core/scan/threads.h"
#include "scan/point_block.h"

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
  const auto ends = std::minmax_element(hull.begin(), hull.end(),
                                        [](const auto& a, const auto& b) { return a.x() < b.x(); });
  const double left = ends.first->x(), right = ends.second->x();
  const double margin = roundingMargin(hull, projection), width = right - left;
  if (width < STRIPS * margin) return;
  const double strips_per_metre = STRIPS / width;
  strip_axis_ = (projection.axes.row(0) * strips_per_metre).cast<float>();
  strip_offset_ =
      static_cast<float>(1 - (projection.axes.row(0).dot(projection.centre) + left) * strips_per_metre);
  height_axis_ = projection.axes.row(1).cast<float>();
  height_offset_ = static_cast<float>(-projection.axes.row(1).dot(projection.centre));

  const auto insideAt = [&](int strip, double shift) {
    return insideHeights(hull, std::clamp(left + strip / strips_per_metre + shift, left, right));
  };
  for (int strip = 0; strip < STRIPS; ++strip) {
    // The polygon is convex: what is inside at both ends of the strip is inside all over it.
    const int next = strip + 1;
    const auto a = insideAt(strip, -margin), b = insideAt(next, margin);
    inside_[static_cast<std::size_t>(next)] = {static_cast<float>(std::max(a.first, b.first) + margin),
                                               static_cast<float>(std::min(a.second, b.second) - margin)};
  }
}

std::vector<Eigen::Index> HullFilter::outside(const PointsView& points) const {
  std::vector<Eigen::Index> result;
  for (const std::vector<Eigen::Index>&part :
       resultsOfRanges(points.cols(), POINTS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
         return outsideOfPart(points.middleCols(begin, end - begin), begin);
       }))
    result.insert(result.end(), part.begin(), part.end());
  return result;
}

std::vector<Eigen::Index> HullFilter::outsideOfPart(const PointsView& part, Eigen::Index first) const {
  PointBlock block;
  std::array<std::int32_t, PointBlock::SIZE> strips;
  std::array<float, PointBlock::SIZE> heights;
  const Eigen::Vector3f s = strip_axis_, h = height_axis_;
  const float s_offset = strip_offset_, h_offset = height_offset_;
  std::vector<Eigen::Index> result;
  for (std::size_t begin = 0; begin < static_cast<std::size_t>(part.cols()); begin += block.count) {
    block.read(part, begin);
    for (std::size_t n = 0; n < block.count; ++n) {
      const float strip = s[0] * block.x[n] + s[1] * block.y[n] + (s[2] * block.z[n] + s_offset);
      strips[n] = static_cast<std::int32_t>(std::min(std::max(strip, 0.0F), static_cast<float>(STRIPS + 1)));
      heights[n] = h[0] * block.x[n] + h[1] * block.y[n] + (h[2] * block.z[n] + h_offset);
    }
    for (std::size_t n = 0; n < block.count; ++n) {
      const auto& [low, high] = inside_[static_cast<std::size_t>(strips[n])];
      if (!(heights[n] > low && heights[n] < high))
        result.push_back(first + static_cast<Eigen::Index>(begin + n));
    }
  }
  return result;
}

std::vector<Eigen::Vector2d> outermostPoints(const PointsView& points,
                                             const HorizontalProjection& projection) {
  constexpr Eigen::Index ONE_IN = 64, FEW = 256;
  std::vector<Eigen::Vector2d> result;
  if (points.cols() <= FEW) {
    for (Eigen::Index n = 0; n < points.cols(); ++n) result.push_back(projection(points.col(n)));
    return result;
  }
  const Points sample = points(Eigen::all, Eigen::seqN(0, points.cols() / ONE_IN, ONE_IN));
  result = convexHull(outermostPoints(sample, projection));
  for (const Eigen::Index n : HullFilter(result, projection).outside(points))
    result.push_back(projection(points.col(n)));
  return result;
}

}  // namespace pcl_fft_ground::core
