#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "pcl_fft_ground/core/align/nearest_neighbours.h"

namespace pcl_fft_ground::core {

/// The plane that fits the surface around a place best.
struct SurfacePatch {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< mean of the points [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of unit length, its sign arbitrary; zero: no patch
  double roughness = 0;                              ///< mean squared distance of the points [m^2]
  double breadth = 0;  ///< mean squared distance from the centre, along the narrower side [m^2]
};

/// Fits planes to the surface of a scan.
class PatchFitter {
 public:
  /// Keeps references. \param radius of the neighbourhood [m]
  PatchFitter(const Points& surface, const NearestNeighbours& search, double radius)
      : surface_(surface), search_(search), radius_(static_cast<float>(radius)) {}

  /// The patch around a place; none, with a normal of zero, where too few points are near.
  SurfacePatch around(const Eigen::Vector3f& place);

 private:
  const Points& surface_;
  const NearestNeighbours& search_;
  float radius_;
  std::vector<Eigen::Index> near_;
};

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
