#include "pcl_fft_ground/core/segments/voxel_clusters.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "segments/voxel_set.h"

namespace pcl_fft_ground::core {
namespace {

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

/// The voxel of every point.
std::vector<VoxelIndex> assignVoxels(const PointsView& points, double leaf_size, VoxelSet& occupied) {
  std::vector<VoxelIndex> voxel_of_point(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    voxel_of_point[static_cast<std::size_t>(n)] = occupied.findOrInsert(voxelOf(points.col(n), leaf_size));
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

VoxelContact contactOf(const PointsView& points, double leaf_size) {
  VoxelContact contact;
  contact.voxel_of_point = assignVoxels(points, leaf_size, contact.occupied);
  DisjointSets sets = connectNeighbours(contact.occupied);
  contact.root_of_voxel.resize(contact.occupied.voxels().size());
  for (std::size_t v = 0; v < contact.root_of_voxel.size(); ++v)
    contact.root_of_voxel[v] = sets.find(static_cast<VoxelIndex>(v));
  return contact;
}

std::vector<std::vector<Eigen::Index>> voxelClusters(const PointsView& points, double leaf_size) {
  const VoxelContact contact = contactOf(points, leaf_size);

  // Voxels are numbered by their first point, so clusters come out ordered by theirs.
  std::vector<VoxelIndex> cluster_of_root(contact.root_of_voxel.size(), NO_VOXEL);
  std::vector<std::vector<Eigen::Index>> clusters;
  for (std::size_t n = 0; n < contact.voxel_of_point.size(); ++n) {
    const VoxelIndex root = contact.root_of_voxel[static_cast<std::size_t>(contact.voxel_of_point[n])];
    VoxelIndex& cluster = cluster_of_root[static_cast<std::size_t>(root)];
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
