#include "alignment/surface_normals.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace pcl_fft_ground::core {
namespace {

constexpr double RADIUS = 2;  // of the neighbourhood: some 12 points [spacings]
constexpr std::size_t LEAST_POINTS = 5;

}  // namespace

SurfaceNormals::SurfaceNormals(const Points& surface, double spacing,
                               const NearestNeighboursFactory& neighbours, std::size_t places)
    : surface_(surface),
      radius_(static_cast<float>(RADIUS * spacing)),
      search_(neighbours(surface, spacing)),
      normals_(places, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())) {}

const Eigen::Vector3d& SurfaceNormals::at(std::size_t number, const Eigen::Vector3d& point) {
  Eigen::Vector3d& normal = normals_[number];
  if (std::isnan(normal.x())) normal = normalAround(point.cast<float>());
  return normal;
}

Eigen::Vector3d SurfaceNormals::normalAround(const Eigen::Vector3f& place) {
  search_->within(place, radius_, near_);
  if (near_.size() < LEAST_POINTS) return Eigen::Vector3d::Zero();
  // Differences to the place are small, so that plain sums do.
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  for (const Eigen::Index n : near_) {
    const Eigen::Vector3f offset = surface_.col(n) - place;
    sum += offset;
    squares.noalias() += offset * offset.transpose();
  }
  const auto count = static_cast<float>(near_.size());
  const Eigen::Matrix3d covariance =
      ((squares - sum * sum.transpose() / count) / (radius_ * radius_)).cast<double>();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  return solver.eigenvectors().col(0);
}

}  // namespace pcl_fft_ground::core
