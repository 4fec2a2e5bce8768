#include "pcl_fft_ground/core/convex_hull.h"

#include <algorithm>
#include <cmath>

#include "hull_filter.h"

namespace pcl_fft_ground::core {
namespace {

bool lowerX(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
}

/// Positive if a, b, c turn counter-clockwise.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Appends the chain of left turns through a sorted range; its last point is left to the next chain.
template <typename Iterator>
void appendChain(std::vector<Eigen::Vector2d>& hull, Iterator begin, Iterator end) {
  const std::size_t start = hull.size();
  for (Iterator p = begin; p != end; ++p) {
    while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), *p) <= 0) hull.pop_back();
    hull.push_back(*p);
  }
  hull.pop_back();
}

/// Brings an angle into (-pi/4, pi/4] by quarter turns.
double withinQuarterTurn(double angle) {
  const double turned = std::remainder(angle, M_PI_2);
  return turned == -M_PI_4 ? M_PI_4 : turned;
}

/// Area of the rectangle around the hull that is turned by the angle.
double rectangleArea(const std::vector<Eigen::Vector2d>& hull, double angle) {
  const Eigen::Vector2d x(std::cos(angle), std::sin(angle)), y(-x.y(), x.x());
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Eigen::Vector2d& corner : hull) {
    const Eigen::Array2d p(x.dot(corner), y.dot(corner));
    low = low.min(p);
    high = high.max(p);
  }
  return (high - low).prod();
}

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

}  // namespace

std::vector<Eigen::Vector2d> convexHull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), lowerX);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 2) return points;
  std::vector<Eigen::Vector2d> hull;
  appendChain(hull, points.begin(), points.end());
  appendChain(hull, points.rbegin(), points.rend());
  return hull;
}

double minimumAreaRectangleAngle(const std::vector<Eigen::Vector2d>& hull) {
  if (hull.size() < 2) return 0;
  constexpr double SAME_AREA = 1e-9;  // areas that differ by rounding only must not decide
  double best_angle = 0, best_area = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
    const double angle = withinQuarterTurn(std::atan2(edge.y(), edge.x()));
    const double area = rectangleArea(hull, angle);
    const bool smaller = area < best_area * (1 - SAME_AREA);
    const bool same = area <= best_area * (1 + SAME_AREA);
    if (smaller || (same && std::abs(angle) < std::abs(best_angle))) best_angle = angle;
    best_area = std::min(best_area, area);
  }
  return best_angle;
}

HullFilter::HullFilter(const std::vector<Eigen::Vector2d>& hull) {
  inside_.fill({0.0, 0.0});
  if (hull.size() < 3) return;
  const auto [left, right] = std::minmax_element(hull.begin(), hull.end(), lowerX);
  left_ = left->x();
  strips_per_metre_ = STRIPS / (right->x() - left_);
  if (!std::isfinite(strips_per_metre_)) strips_per_metre_ = 0;
  std::pair<double, double> here = insideHeights(hull, left_);
  for (int strip = 0; strip < STRIPS; ++strip) {
    const std::pair<double, double> next = insideHeights(hull, left_ + (strip + 1) / strips_per_metre_);
    // The polygon is convex: what is inside at both ends of the strip is inside all over it.
    inside_[static_cast<std::size_t>(strip)] = {std::max(here.first, next.first),
                                                std::min(here.second, next.second)};
    here = next;
  }
}

}  // namespace pcl_fft_ground::core
