#include "align/voxel_means.h"

#include <Eigen/Geometry>
#include <vector>

#include "segments/voxel_set.h"

namespace pcl_fft_ground::core {

Points voxelMeans(const PointsView& points, double voxel_size) {
  VoxelSet occupied;
  std::vector<Eigen::Vector4d> sums;  // x, y, z and the number of points
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const auto voxel = static_cast<std::size_t>(occupied.findOrInsert(voxelOf(points.col(n), voxel_size)));
    if (voxel == sums.size()) sums.emplace_back(Eigen::Vector4d::Zero());
    sums[voxel] += points.col(n).cast<double>().homogeneous();
  }
  Points means(3, static_cast<Eigen::Index>(sums.size()));
  for (std::size_t voxel = 0; voxel < sums.size(); ++voxel)
    means.col(static_cast<Eigen::Index>(voxel)) = sums[voxel].hnormalized().cast<float>();
  return means;
}

}  // namespace pcl_fft_ground::core
