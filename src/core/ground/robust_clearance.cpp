#include "ground/robust_clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pcl_fft_ground/core/scan/threads.h"

namespace pcl_fft_ground::core {
namespace {

constexpr Eigen::Index COLUMNS_AT_A_TIME = 64;

/// The reciprocal of a size that float holds need not be finite there, and infinity times nothing is no
/// place.
float finiteFloat(double value) {
  constexpr double LARGEST = std::numeric_limits<float>::max();
  return static_cast<float>(std::min(value, LARGEST));
}

}  // namespace

Clearance::Patches::Patches(const GroundSurface& surface)
    : rows(static_cast<std::int32_t>(surface.height.rows()) + 1),
      cols(static_cast<std::int32_t>(surface.height.cols()) + 1),
      per_metre(finiteFloat(1 / surface.geometry.cell_size)),
      x_first(static_cast<float>(surface.geometry.origin.x() - 0.5 * surface.geometry.cell_size)),
      y_first(static_cast<float>(surface.geometry.origin.y() - 0.5 * surface.geometry.cell_size)),
      x_end(std::nextafter(static_cast<float>(rows), 0.0F)),
      y_end(std::nextafter(static_cast<float>(cols), 0.0F)) {}

Clearance::Clearance(const RobustGround& ground, const PointsView& points)
    : grid_(ground.surface),
      per_metre_(1 / ground.surface.geometry.cell_size),
      patches_(static_cast<std::size_t>(grid_.rows) * static_cast<std::size_t>(grid_.cols)),
      allowances_(static_cast<std::size_t>(ground.surface.height.size())) {
  if (points.cols() < ground.surface.height.size())
    makeReady(ground, points);
  else
    makeReady(ground);
}

void Clearance::makeReady(const RobustGround& ground) {
  forEachRange(grid_.cols, COLUMNS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
    for (Eigen::Index j = begin; j < end; ++j)
      for (Eigen::Index i = 0; i < grid_.rows; ++i) patches_[grid_.number(i, j)] = patchAt(ground, i, j);
  });
  const Eigen::Index rows = ground.surface.height.rows();
  forEachRange(ground.surface.height.cols(), COLUMNS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
    for (Eigen::Index cell = begin * rows; cell < end * rows; ++cell)
      allowances_[static_cast<std::size_t>(cell)] = allowanceOf(ground, cell);
  });
}

/// Where cells are more than points most are empty: the patches that no point asks for stay as they are.
void Clearance::makeReady(const RobustGround& ground, const PointsView& points) {
  std::vector<bool> patches(patches_.size(), false), cells(allowances_.size(), false);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Place place = grid_.placeOf(points(0, n), points(1, n));
    patches[static_cast<std::size_t>(place.patch)] = true;
    cells[static_cast<std::size_t>(place.cell)] = true;
  }
  const Eigen::Index rows = ground.surface.height.rows();
  for (std::size_t cell = 0; cell < cells.size();
       ++cell) {  // the allowance looks at the patch from its centre on
    const auto number = static_cast<Eigen::Index>(cell);
    if (cells[cell]) patches[grid_.number(number % rows + 1, number / rows + 1)] = true;
  }
  for (std::size_t patch = 0; patch < patches.size(); ++patch) {
    const auto number = static_cast<Eigen::Index>(patch);
    if (patches[patch]) patches_[patch] = patchAt(ground, number % grid_.rows, number / grid_.rows);
  }
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
    if (cells[cell]) allowances_[cell] = allowanceOf(ground, static_cast<Eigen::Index>(cell));
}

Clearance::Patch Clearance::patchAt(const RobustGround& ground, Eigen::Index i, Eigen::Index j) const {
  const Eigen::ArrayXXd& h = ground.surface.height;
  const Eigen::Index low_i = std::max<Eigen::Index>(i - 1, 0), low_j = std::max<Eigen::Index>(j - 1, 0);
  const Eigen::Index high_i = std::min(i, h.rows() - 1), high_j = std::min(j, h.cols() - 1);
  const double a = h(low_i, low_j), b = h(high_i, low_j) - a, c = h(low_i, high_j) - a;
  const double d = h(high_i, high_j) - a - b - c;
  const double slope = per_metre_ * Eigen::Vector2d(b + 0.5 * d, c + 0.5 * d).norm();
  return {static_cast<float>(a),
          static_cast<float>(b),
          static_cast<float>(c),
          static_cast<float>(d),
          static_cast<float>(1 / std::sqrt(1 + slope * slope)),
          static_cast<float>(ground.slope_tolerance * slope)};
}

float Clearance::allowanceOf(const RobustGround& ground, Eigen::Index cell) const {
  const Eigen::Index rows = ground.surface.height.rows();
  const Patch& patch = patches_[grid_.number(cell % rows + 1, cell / rows + 1)];
  const auto most = static_cast<float>(ground.most_tolerance - ground.tolerance);
  const bool seen = ground.elevation.observed.data()[cell];
  const float bend = std::max(0.0F, (ground.lowest.data()[cell] - patch.lean) * patch.shortening);
  return std::max(seen ? std::min(bend, most) : most, ground.steps.data()[cell]);
}

void Clearance::read(const PointsView& points, std::size_t begin, Block& block) const {
  PointBlock at;
  at.read(points, begin);
  block.count = at.count;
  std::array<std::int32_t, PointBlock::SIZE> patches, cells;
  std::array<float, PointBlock::SIZE> u, v;
  const Patches grid = grid_;
  for (std::size_t n = 0; n < at.count; ++n) {
    const Place place = grid.placeOf(at.x[n], at.y[n]);
    patches[n] = place.patch, cells[n] = place.cell, u[n] = place.u, v[n] = place.v;
  }
  for (std::size_t n = 0; n < at.count; ++n) {
    const Patch& patch = patches_[static_cast<std::size_t>(patches[n])];
    const float height = at.z[n] - patch.heightAt(u[n], v[n]);
    block.above[n] =
        (height - patch.lean) * patch.shortening - allowances_[static_cast<std::size_t>(cells[n])];
    block.below[n] = (-height - patch.lean) * patch.shortening;
  }
}

}  // namespace pcl_fft_ground::core
