#include "align/surface_patch.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace pcl_fft_ground::core {
namespace {

constexpr std::size_t LEAST_POINTS = 5;

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

}  // namespace pcl_fft_ground::core
