#include "pcl_fft_ground/core/survey/pairing.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

namespace pcl_fft_ground::core {

namespace {

/// The nearest of the sub-maps that are left out of account by nobody; the first of equally near ones.
template <typename IsCandidate>
std::optional<std::size_t> nearestTo(std::size_t index, const std::vector<Eigen::Vector3d>& centroids,
                                     const IsCandidate& is_candidate) {
  std::optional<std::size_t> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < centroids.size(); ++i) {
    const double distance = (centroids[i] - centroids[index]).squaredNorm();
    if (i == index || !is_candidate(i) || distance >= least) continue;
    least = distance;
    nearest = i;
  }
  return nearest;
}

/// A pair of sub-maps, whichever way round.
std::pair<std::size_t, std::size_t> unordered(std::size_t a, std::size_t b) {
  return std::minmax(a, b);
}

/// Radius about the middle of the cells within which a scan covers anything, and that middle in the world
/// [m].
struct Circle {
  Eigen::Vector2d centre;
  double radius;
};

Circle circleAround(const ScanCoverage& coverage, const Eigen::Isometry3d& world_from_scan) {
  const Eigen::Vector2d sides(static_cast<double>(coverage.depth.rows()) * coverage.geometry.cell_size,
                              static_cast<double>(coverage.depth.cols()) * coverage.geometry.cell_size);
  const Eigen::Vector2d middle = coverage.geometry.origin + 0.5 * sides;
  return {(world_from_scan * Eigen::Vector3d(middle.x(), middle.y(), 0)).head<2>(), 0.5 * sides.norm()};
}

bool doTouch(const Circle& a, const Circle& b) {
  return (a.centre - b.centre).norm() < a.radius + b.radius;
}

/// For each circle those after it in the list that it touches, ascending: along x only as far as any reaches.
std::vector<std::vector<std::size_t>> touchingAfter(const std::vector<Circle>& circles) {
  std::vector<std::size_t> by_x(circles.size());
  std::iota(by_x.begin(), by_x.end(), std::size_t{0});
  std::sort(by_x.begin(), by_x.end(),
            [&](std::size_t a, std::size_t b) { return circles[a].centre.x() < circles[b].centre.x(); });
  double widest = 0;
  for (const Circle& circle : circles) widest = std::max(widest, circle.radius);
  std::vector<std::vector<std::size_t>> touching(circles.size());
  for (std::size_t n = 0; n < by_x.size(); ++n) {
    const Circle& circle = circles[by_x[n]];
    for (std::size_t k = n + 1; k < by_x.size(); ++k) {
      if (circles[by_x[k]].centre.x() - circle.centre.x() >= circle.radius + widest) break;
      if (!doTouch(circle, circles[by_x[k]])) continue;
      const auto [first, second] = unordered(by_x[n], by_x[k]);
      touching[first].push_back(second);
    }
  }
  for (std::vector<std::size_t>& others : touching) std::sort(others.begin(), others.end());
  return touching;
}

}  // namespace

std::vector<SubmapPair> chainPairs(const std::vector<Eigen::Vector3d>& centroids) {
  std::vector<SubmapPair> pairs;
  std::vector<bool> paired(centroids.size(), false);
  std::size_t current = 0;
  if (!paired.empty()) paired[0] = true;
  while (const auto next = nearestTo(current, centroids, [&](std::size_t i) { return !paired[i]; })) {
    pairs.push_back({current, *next});
    paired[*next] = true;
    current = *next;
  }
  if (pairs.empty()) return pairs;
  const std::size_t predecessor = pairs.back().reference;
  const auto last = nearestTo(current, centroids, [&](std::size_t i) { return i != predecessor; });
  if (last) pairs.push_back({current, *last});
  return pairs;
}

std::vector<SubmapPair> otherOverlappingPairs(const std::vector<ScanCoverage>& coverages,
                                              const std::vector<Eigen::Isometry3d>& world_from_submap,
                                              const std::vector<SubmapPair>& listed, double least) {
  if (coverages.size() != world_from_submap.size()) {
    throw std::invalid_argument("otherOverlappingPairs: as many poses as coverages are needed");
  }
  std::vector<Circle> circles;
  for (std::size_t n = 0; n < coverages.size(); ++n)
    circles.push_back(circleAround(coverages[n], world_from_submap[n]));
  std::set<std::pair<std::size_t, std::size_t>> known;
  for (const SubmapPair& pair : listed) known.insert(unordered(pair.reference, pair.moving));
  const std::vector<std::vector<std::size_t>> touching = touchingAfter(circles);
  std::vector<SubmapPair> pairs;
  for (std::size_t a = 0; a < coverages.size(); ++a)
    for (const std::size_t b : touching[a]) {
      if (known.count({a, b}) > 0) continue;
      const Eigen::Isometry3d a_from_b = world_from_submap[a].inverse() * world_from_submap[b];
      if (overlapShare(coverages[a], coverages[b], a_from_b) >= least) pairs.push_back({a, b});
    }
  return pairs;
}

bool mayOverlap(const ScanCoverage& a, const Eigen::Isometry3d& world_from_a, const ScanCoverage& b,
                const Eigen::Isometry3d& world_from_b) {
  return doTouch(circleAround(a, world_from_a), circleAround(b, world_from_b));
}

}  // namespace pcl_fft_ground::core
