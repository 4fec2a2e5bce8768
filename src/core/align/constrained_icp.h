#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "align/icp.h"
#include "align/scan_pair.h"

namespace pcl_fft_ground::core {

/// ICP whose correspondences stay within matched segments and in what the reference has seen.
class ConstrainedIcp {
 public:
  /// Keeps a reference to the pair.
  explicit ConstrainedIcp(const ScanPair& pair);

  /// Point-to-point in yaw and shift. \param gate largest distance of partners at first [voxels]
  Eigen::Isometry3d approach(const std::vector<SegmentMatch>& matches, const Eigen::Isometry3d& start,
                             double gate) const;

  /// Point-to-plane in all six degrees of freedom, from within a few voxels.
  IcpResult refine(const std::vector<SegmentMatch>& matches, const Eigen::Isometry3d& start);

 private:
  /// Partners of one in so many of the samples' points.
  FindPartners partnersIn(const std::vector<SegmentMatch>& matches, Eigen::Index one_in) const;
  std::optional<Partners> partnersOf(const Eigen::Vector3d& point, const std::vector<std::size_t>& segments,
                                     double gate) const;

  const ScanPair& pair_;
  std::vector<Points> samples_;           // of the moving segments
  std::vector<std::size_t> first_place_;  // per reference segment, the number of its first point
  SurfaceNormals normals_;
};

}  // namespace pcl_fft_ground::core
