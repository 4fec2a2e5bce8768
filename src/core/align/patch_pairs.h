#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "align/icp.h"

namespace pcl_fft_ground::core {

/// Two patches of the same surface, one of the moving scan and one of the reference.
struct PatchPair {
  Eigen::Vector3d from;    ///< centre of the moving patch after the current correction [m]
  Eigen::Vector3d to;      ///< centre of its partner [m]
  Eigen::Vector3d normal;  ///< of unit length, amid the two
  double weight;           ///< in (0, 1]
  std::size_t block;       ///< number of the part of the scene
};

/// Mean place of the pairs.
Eigen::Vector3d centreOf(const std::vector<PatchPair>& pairs);

/// The equations that bring the patches into one plane, pair by pair.
MotionFit fitOf(const std::vector<PatchPair>& pairs, const Eigen::Vector3d& centre);

/// How well the pairs hold the correction.
IcpResult summarise(const std::vector<PatchPair>& pairs, const Eigen::Isometry3d& correction);

}  // namespace pcl_fft_ground::core
