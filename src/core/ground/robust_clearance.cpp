#include "ground/robust_clearance.h"

#include <algorithm>
#include <cmath>

namespace pcl_fft_ground::core {

Clearance::Clearance(const RobustGround& ground, const PointsView& points)
    : rows_(static_cast<int>(ground.surface.height.rows()) + 1),
      cols_(static_cast<int>(ground.surface.height.cols()) + 1),
      first_(ground.surface.geometry.origin.array() - 0.5 * ground.surface.geometry.cell_size),
      per_metre_(1 / ground.surface.geometry.cell_size),
      x_first_(static_cast<float>(first_.x())),
      y_first_(static_cast<float>(first_.y())),
      x_end_(std::nextafter(static_cast<float>(rows_), 0.0F)),
      y_end_(std::nextafter(static_cast<float>(cols_), 0.0F)),
      per_metre_in_float_(static_cast<float>(per_metre_)),
      patches_(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_)),
      allowances_(static_cast<std::size_t>(ground.surface.height.size())) {
  if (points.cols() < ground.surface.height.size())
    makeReady(ground, points);
  else
    makeReady(ground);
}

void Clearance::makeReady(const RobustGround& ground) {
  forEachRange(cols_, COLUMNS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
    for (Eigen::Index j = begin; j < end; ++j)
      for (Eigen::Index i = 0; i < rows_; ++i) patches_[patchNumber(i, j)] = patchAt(ground, i, j);
  });
  const Eigen::Index rows = ground.surface.height.rows();
  forEachRange(ground.surface.height.cols(), COLUMNS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
    for (Eigen::Index cell = begin * rows; cell < end * rows; ++cell)
      allowances_[static_cast<std::size_t>(cell)] = allowanceOf(ground, cell);
  });
}

/// Where cells are more than points most are empty: the patches that no point asks for stay as they are.
void Clearance::makeReady(const RobustGround& ground, const PointsView& points) {
  enum : char { NOT_ASKED, ASKED, READY };
  std::vector<char> patches(patches_.size(), NOT_ASKED), cells(allowances_.size(), NOT_ASKED);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Place place = placeOf(points(0, n), points(1, n));
    patches[static_cast<std::size_t>(place.patch)] = cells[static_cast<std::size_t>(place.cell)] = ASKED;
  }
  const auto ready = [&](std::size_t patch) {
    if (std::exchange(patches[patch], READY) == READY) return;
    const auto number = static_cast<Eigen::Index>(patch);
    patches_[patch] = patchAt(ground, number % rows_, number / rows_);
  };
  for (std::size_t patch = 0; patch < patches.size(); ++patch)
    if (patches[patch] == ASKED) ready(patch);
  const Eigen::Index rows = ground.surface.height.rows();
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    if (cells[cell] != ASKED) continue;
    const auto number = static_cast<Eigen::Index>(cell);
    ready(patchNumber(number % rows + 1, number / rows + 1));  // that the allowance looks at
    allowances_[cell] = allowanceOf(ground, number);
  }
}

std::size_t Clearance::patchNumber(Eigen::Index i, Eigen::Index j) const {
  return static_cast<std::size_t>(i + j * rows_);
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
  const Patch& patch = patches_[patchNumber(cell % rows + 1, cell / rows + 1)];
  const auto most = static_cast<float>(ground.most_tolerance - ground.tolerance);
  const bool seen = ground.elevation.observed.data()[cell];
  const float bend = std::max(0.0F, (ground.lowest.data()[cell] - patch.lean) * patch.shortening);
  return std::max(seen ? std::min(bend, most) : most, ground.steps.data()[cell]);
}

Clearance::Place Clearance::placeOf(float x, float y) const {
  const float from_x = std::min(std::max((x - x_first_) * per_metre_in_float_, 0.0F), x_end_);
  const float from_y = std::min(std::max((y - y_first_) * per_metre_in_float_, 0.0F), y_end_);
  const auto i = static_cast<std::int32_t>(from_x), j = static_cast<std::int32_t>(from_y);
  const float u = from_x - static_cast<float>(i), v = from_y - static_cast<float>(j);
  // The nearest of the four centres is that of the point's own cell.
  const std::int32_t row = i - (u < 0.5F ? 1 : 0), col = j - (v < 0.5F ? 1 : 0);
  return {i + j * rows_, std::clamp(row, 0, rows_ - 2) + std::clamp(col, 0, cols_ - 2) * (rows_ - 1), u, v};
}

void Clearance::read(const PointsView& points, std::size_t begin, Block& block) const {
  PointBlock at;
  at.read(points, begin);
  block.count = at.count;
  std::array<std::int32_t, PointBlock::SIZE> patches, cells;
  std::array<float, PointBlock::SIZE> u, v;
  const Clearance own = geometry();  // not to be read again and again
  for (std::size_t n = 0; n < at.count; ++n) {
    const Place place = placeOf(at.x[n], at.y[n]);
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
