#include "pcl_fft_ground/core/tiles/tile_segments.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace pcl_fft_ground::core {

TileSegments::TileSegments(std::vector<std::uint64_t> points)
    : points_(std::move(points)), parent_(points_.size()) {
  std::iota(parent_.begin(), parent_.end(), 0U);
}

std::uint32_t TileSegments::rootOf(std::uint32_t segment) {
  while (parent_[segment] != segment) segment = parent_[segment] = parent_[parent_[segment]];
  return segment;
}

void TileSegments::unite(std::uint32_t a, std::uint32_t b) {
  a = rootOf(a);
  b = rootOf(b);
  parent_[std::max(a, b)] = std::min(a, b);
}

void TileSegments::join(std::vector<SeamPoint> seam, SeamRule rule) {
  std::map<std::uint32_t, std::size_t> of_one, of_other;
  for (const SeamPoint& point : seam) {
    ++of_one[point.one];
    ++of_other[point.other];
  }
  std::sort(seam.begin(), seam.end(), [](const SeamPoint& a, const SeamPoint& b) {
    return std::tie(a.one, a.other) < std::tie(b.one, b.other);
  });
  for (std::size_t begin = 0, end = 0; begin < seam.size(); begin = end) {
    const SeamPoint pair = seam[begin];
    while (end < seam.size() && seam[end].one == pair.one && seam[end].other == pair.other) ++end;
    const std::size_t smaller = std::min(of_one[pair.one], of_other[pair.other]);
    if (rule == SeamRule::ANY || 2 * (end - begin) >= smaller) unite(pair.one, pair.other);
  }
}

std::vector<std::int32_t> TileSegments::numbers(std::uint64_t least, std::uint64_t most) {
  std::vector<std::uint64_t> sizes(points_.size(), 0);
  for (std::uint32_t s = 0; s < points_.size(); ++s) sizes[rootOf(s)] += points_[s];
  std::vector<std::uint32_t> roots;
  for (std::uint32_t s = 0; s < points_.size(); ++s)
    if (parent_[s] == s && sizes[s] >= std::max<std::uint64_t>(least, 1) && sizes[s] <= most)
      roots.push_back(s);
  std::stable_sort(roots.begin(), roots.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return sizes[a] > sizes[b]; });
  std::vector<std::int32_t> number_of_root(points_.size(), 0), numbers(points_.size());
  for (std::size_t k = 0; k < roots.size(); ++k) number_of_root[roots[k]] = static_cast<std::int32_t>(k + 1);
  for (std::uint32_t s = 0; s < points_.size(); ++s) numbers[s] = number_of_root[rootOf(s)];
  return numbers;
}

}  // namespace pcl_fft_ground::core
