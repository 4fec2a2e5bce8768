#include "pcl_fft_ground/core/voxel_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace pcl_fft_ground::core {
namespace {

using VoxelIndex = std::int32_t;
constexpr VoxelIndex NO_VOXEL = -1;

struct Voxel {
  std::int64_t i, j, k;
  bool operator==(const Voxel& other) const { return i == other.i && j == other.j && k == other.k; }
};

/// Mixes the three coordinates so that neighbours spread over the table.
std::uint64_t hashOf(const Voxel& voxel) {
  std::uint64_t h = static_cast<std::uint64_t>(voxel.i) * 0x9E3779B97F4A7C15ULL;
  h ^= static_cast<std::uint64_t>(voxel.j) * 0xC2B2AE3D27D4EB4FULL;
  h ^= static_cast<std::uint64_t>(voxel.k) * 0x165667B19E3779F9ULL;
  return h ^ (h >> 29);
}

/// Set of occupied voxels: open addressing, voxels numbered in the order of their first point.
class VoxelSet {
 public:
  VoxelSet() : slots_(1024, NO_VOXEL) {}

  const std::vector<Voxel>& voxels() const { return voxels_; }

  VoxelIndex find(const Voxel& voxel) const { return slots_[slotOf(voxel)]; }

  VoxelIndex findOrInsert(const Voxel& voxel) {
    const std::size_t slot = slotOf(voxel);
    if (slots_[slot] != NO_VOXEL) return slots_[slot];
    const auto index = static_cast<VoxelIndex>(voxels_.size());
    slots_[slot] = index;
    voxels_.push_back(voxel);
    if (voxels_.size() * 2 > slots_.size()) grow();
    return index;
  }

 private:
  /// The slot that holds the voxel, or the empty one where it belongs.
  std::size_t slotOf(const Voxel& voxel) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hashOf(voxel) & mask;
    while (slots_[slot] != NO_VOXEL && !(voxels_[static_cast<std::size_t>(slots_[slot])] == voxel))
      slot = (slot + 1) & mask;
    return slot;
  }

  void grow() {
    slots_.assign(slots_.size() * 4, NO_VOXEL);
    for (std::size_t index = 0; index < voxels_.size(); ++index)
      slots_[slotOf(voxels_[index])] = static_cast<VoxelIndex>(index);
  }

  std::vector<Voxel> voxels_;
  std::vector<VoxelIndex> slots_;
};

/// Disjoint sets of voxels; the representative of a set is its lowest number.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  VoxelIndex find(VoxelIndex index) {
    VoxelIndex* parent = parent_.data();
    while (parent[index] != index) index = parent[index] = parent[parent[index]];
    return index;
  }

  void unite(VoxelIndex a, VoxelIndex b) {
    a = find(a);
    b = find(b);
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<VoxelIndex> parent_;
};

/// One of each opposite pair of the 26 neighbours.
std::array<Voxel, 13> halfNeighbourhood() {
  std::array<Voxel, 13> offsets{};
  for (int n = 0; n < 13; ++n) offsets[static_cast<std::size_t>(n)] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
  return offsets;
}

/// Number of the voxel that holds a coordinate; the bound keeps absurd quotients within the integers.
std::int64_t voxelCoordinate(float coordinate, double leaf_size) {
  constexpr double BOUND = 4e18;
  return static_cast<std::int64_t>(std::clamp(std::floor(coordinate / leaf_size), -BOUND, BOUND));
}

/// The voxel of every point.
std::vector<VoxelIndex> assignVoxels(const PointsView& points, double leaf_size, VoxelSet& occupied) {
  std::vector<VoxelIndex> voxel_of_point(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    voxel_of_point[static_cast<std::size_t>(n)] = occupied.findOrInsert(
        {voxelCoordinate(points(0, n), leaf_size), voxelCoordinate(points(1, n), leaf_size),
         voxelCoordinate(points(2, n), leaf_size)});
  return voxel_of_point;
}

DisjointSets connectNeighbours(const VoxelSet& occupied) {
  const std::array<Voxel, 13> offsets = halfNeighbourhood();
  DisjointSets sets(occupied.voxels().size());
  for (std::size_t index = 0; index < occupied.voxels().size(); ++index) {
    const Voxel& v = occupied.voxels()[index];
    for (const Voxel& offset : offsets) {
      const VoxelIndex neighbour = occupied.find({v.i + offset.i, v.j + offset.j, v.k + offset.k});
      if (neighbour != NO_VOXEL) sets.unite(static_cast<VoxelIndex>(index), neighbour);
    }
  }
  return sets;
}

}  // namespace

std::vector<std::vector<Eigen::Index>> voxelClusters(const PointsView& points, double leaf_size) {
  VoxelSet occupied;
  const std::vector<VoxelIndex> voxel_of_point = assignVoxels(points, leaf_size, occupied);
  DisjointSets sets = connectNeighbours(occupied);

  // Voxels are numbered by their first point, so clusters come out ordered by theirs.
  std::vector<VoxelIndex> cluster_of_voxel(occupied.voxels().size(), NO_VOXEL);
  std::vector<std::vector<Eigen::Index>> clusters;
  for (std::size_t n = 0; n < voxel_of_point.size(); ++n) {
    VoxelIndex& cluster = cluster_of_voxel[static_cast<std::size_t>(sets.find(voxel_of_point[n]))];
    if (cluster == NO_VOXEL) {
      cluster = static_cast<VoxelIndex>(clusters.size());
      clusters.emplace_back();
    }
    clusters[static_cast<std::size_t>(cluster)].push_back(static_cast<Eigen::Index>(n));
  }
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return clusters;
}

}  // namespace pcl_fft_ground::core
