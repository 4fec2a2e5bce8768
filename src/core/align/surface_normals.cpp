#include "align/surface_normals.h"

#include <cmath>
#include <limits>

namespace pcl_fft_ground::core {
namespace {

constexpr double RADIUS = 2;  // of the neighbourhood: some 12 points [spacings]

}  // namespace

SurfaceNormals::SurfaceNormals(const Points& surface, double spacing,
                               const NearestNeighboursFactory& neighbours, std::size_t places)
    : search_(neighbours(surface, spacing)),
      patches_(surface, *search_, RADIUS * spacing),
      normals_(places, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())) {}

const Eigen::Vector3d& SurfaceNormals::at(std::size_t number, const Eigen::Vector3d& point) {
  Eigen::Vector3d& normal = normals_[number];
  if (std::isnan(normal.x())) normal = patches_.around(point.cast<float>()).normal;
  return normal;
}

}  // namespace pcl_fft_ground::core
