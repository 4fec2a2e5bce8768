#include "align/surface_patch.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_fft_ground::core {
namespace {

constexpr std::size_t LEAST_POINTS = 5;
constexpr double NORMAL_RADIUS = 2;  // of the neighbourhood of a normal: some 12 points [spacings]

}  // namespace

SurfacePatch PatchFitter::around(const Eigen::Vector3f& place) {
  SurfacePatch patch;
  search_.within(place, radius_, near_);
  if (near_.size() < LEAST_POINTS) return patch;
  // Differences to the place are small, so that plain sums do.
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  for (const Eigen::Index n : near_) {
    const Eigen::Vector3f offset = surface_.col(n) - place;
    sum += offset;
    squares.noalias() += offset * offset.transpose();
  }
  const auto count = static_cast<float>(near_.size());
  const double scale = static_cast<double>(radius_) * static_cast<double>(radius_);
  const Eigen::Matrix3d covariance =
      ((squares - sum * sum.transpose() / count) / count).cast<double>() / scale;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  patch.centre = (place + sum / count).cast<double>();
  patch.normal = solver.eigenvectors().col(0);
  patch.roughness = scale * std::max(0.0, solver.eigenvalues()[0]);
  patch.breadth = scale * std::max(0.0, solver.eigenvalues()[1]);
  return patch;
}

SurfaceNormals::SurfaceNormals(const Points& surface, double spacing,
                               const NearestNeighboursFactory& neighbours, std::size_t places)
    : search_(neighbours(surface, spacing)),
      patches_(surface, *search_, NORMAL_RADIUS * spacing),
      normals_(places, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())) {}

const Eigen::Vector3d& SurfaceNormals::at(std::size_t number, const Eigen::Vector3d& point) {
  Eigen::Vector3d& normal = normals_[number];
  if (std::isnan(normal.x())) normal = patches_.around(point.cast<float>()).normal;
  return normal;
}

}  // namespace pcl_fft_ground::core
