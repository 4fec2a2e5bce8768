#include "pcl_fft_ground/core/survey/pairing.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

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

bool isListed(const std::vector<SubmapPair>& pairs, std::size_t a, std::size_t b) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const SubmapPair& pair) {
    return (pair.reference == a && pair.moving == b) || (pair.reference == b && pair.moving == a);
  });
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
  std::vector<SubmapPair> pairs;
  for (std::size_t a = 0; a < coverages.size(); ++a) {
    for (std::size_t b = a + 1; b < coverages.size(); ++b) {
      if (isListed(listed, a, b)) continue;
      const Eigen::Isometry3d a_from_b = world_from_submap[a].inverse() * world_from_submap[b];
      if (overlapShare(coverages[a], coverages[b], a_from_b) >= least) pairs.push_back({a, b});
    }
  }
  return pairs;
}

}  // namespace pcl_fft_ground::core
