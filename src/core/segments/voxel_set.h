#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// Number of an occupied voxel, from 0 in the order in which they were first seen.
using VoxelIndex = std::int32_t;
constexpr VoxelIndex NO_VOXEL = -1;

/// Coordinates of a voxel: (i, j, k) covers [i, i + 1) x [j, j + 1) x [k, k + 1) sides.
struct Voxel {
  std::int64_t i, j, k;
  bool operator==(const Voxel& other) const { return i == other.i && j == other.j && k == other.k; }
};

/// Number of the voxel that holds a coordinate; the bound keeps absurd quotients within the integers.
inline std::int64_t voxelCoordinate(float coordinate, double side) {
  constexpr double BOUND = 4e18;
  return static_cast<std::int64_t>(std::clamp(std::floor(coordinate / side), -BOUND, BOUND));
}

/// The voxel that holds a point.
inline Voxel voxelOf(const Eigen::Vector3f& point, double side) {
  return {voxelCoordinate(point.x(), side), voxelCoordinate(point.y(), side),
          voxelCoordinate(point.z(), side)};
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
  /// Mixes the three coordinates so that neighbours spread over the table.
  static std::uint64_t hashOf(const Voxel& voxel) {
    std::uint64_t h = static_cast<std::uint64_t>(voxel.i) * 0x9E3779B97F4A7C15ULL;
    h ^= static_cast<std::uint64_t>(voxel.j) * 0xC2B2AE3D27D4EB4FULL;
    h ^= static_cast<std::uint64_t>(voxel.k) * 0x165667B19E3779F9ULL;
    return h ^ (h >> 29);
  }

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

/// Which voxels points occupy, and which of these hang together (26 neighbours).
struct VoxelContact {
  VoxelSet occupied;
  std::vector<VoxelIndex> voxel_of_point;
  std::vector<VoxelIndex> root_of_voxel;  ///< the lowest number among the voxels of the same cluster
};

/// \param points finite points \param leaf_size side of a voxel [m], > 0
VoxelContact contactOf(const PointsView& points, double leaf_size);

}  // namespace pcl_fft_ground::core
