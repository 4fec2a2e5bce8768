#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "align/surface_patch.h"
#include "pcl_fft_ground/core/align/nearest_neighbours.h"

namespace pcl_fft_ground::core {

/// Normals of a scan's surface, found where they are asked for, and kept.
class SurfaceNormals {
 public:
  /** \param surface points of the scan; a reference is kept
   * \param spacing of the points [m]
   * \param places number of places that may be asked for
   */
  SurfaceNormals(const Points& surface, double spacing, const NearestNeighboursFactory& neighbours,
                 std::size_t places);

  /// Unit normal of the surface, its sign arbitrary; zero where too few points are near.
  /// \param number of the place, always the same for one point
  const Eigen::Vector3d& at(std::size_t number, const Eigen::Vector3d& point);

 private:
  std::unique_ptr<NearestNeighbours> search_;
  PatchFitter patches_;
  std::vector<Eigen::Vector3d> normals_;  // NaN where not yet asked for
};

}  // namespace pcl_fft_ground::core
