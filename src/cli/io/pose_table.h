#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace pcl_fft_ground::cli {

/// The pose of a sub-map.
struct NamedPose {
  std::string submap;  ///< name of its file, without the folder
  Eigen::Isometry3d world_from_submap = Eigen::Isometry3d::Identity();
};

/// Poses as CSV: submap,x,y,z,qx,qy,qz,qw - metres, and a unit quaternion.
std::string asCsv(const std::vector<NamedPose>& poses);

/// Reads what asCsv() wrote.
/// \throws WorkError naming the file and the line, for one that cannot be read or is no such table
std::vector<NamedPose> readPoses(const std::string& path);

}  // namespace pcl_fft_ground::cli
