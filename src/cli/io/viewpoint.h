#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace pcl_fft_ground::cli {

/// The VIEWPOINT of a PCD file: maps the coordinates of its points to the world. In double, since a place in
/// the world may be millions of metres from its origin.
struct Viewpoint {
  static constexpr double FARTHEST = 1e8;  ///< beyond any coordinates on Earth [m]

  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< [m]
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< of any length above 0

  Eigen::Isometry3d asTransform() const { return Eigen::Translation3d(position) * rotation.normalized(); }
};

}  // namespace pcl_fft_ground::cli
