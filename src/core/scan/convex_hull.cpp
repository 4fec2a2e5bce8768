#include "pcl_fft_ground/core/scan/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

}  // namespace pcl_fft_ground::core
