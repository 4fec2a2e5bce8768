#include "ground/robust_clearance.h"

#include <algorithm>
#include <cmath>

namespace pcl_fft_ground::core {

Clearance::Clearance(const RobustGround& ground)
    : rows_(static_cast<int>(ground.surface.height.rows()) + 1),
      cols_(static_cast<int>(ground.surface.height.cols()) + 1),
      first_(ground.surface.geometry.origin.array() - 0.5 * ground.surface.geometry.cell_size),
      per_metre_(1 / ground.surface.geometry.cell_size) {
  patches_.reserve(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_));
  for (int j = 0; j < cols_; ++j)
    for (int i = 0; i < rows_; ++i) patches_.push_back(patchAt(ground, i, j));
  allowances_.reserve(static_cast<std::size_t>(ground.surface.height.size()));
  for (Eigen::Index cell = 0; cell < ground.surface.height.size(); ++cell)
    allowances_.push_back(allowanceOf(ground, cell));
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
  const Patch& patch = patches_[static_cast<std::size_t>(cell % rows + 1 + (cell / rows + 1) * (rows + 1))];
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
  std::array<float, PointBlock::SIZE> u, v;  // shares of the way to the next centre
  const auto x_first = static_cast<float>(first_.x()), y_first = static_cast<float>(first_.y());
  const auto per_metre = static_cast<float>(per_metre_);
  const float x_end = std::nextafter(static_cast<float>(rows_), 0.0F);
  const float y_end = std::nextafter(static_cast<float>(cols_), 0.0F);
  const int rows = rows_, cols = cols_;
  for (std::size_t n = 0; n < at.count; ++n) {
    const float x = std::min(std::max((at.x[n] - x_first) * per_metre, 0.0F), x_end);
    const float y = std::min(std::max((at.y[n] - y_first) * per_metre, 0.0F), y_end);
    const auto i = static_cast<std::int32_t>(x), j = static_cast<std::int32_t>(y);
    patches[n] = i + j * rows;
    u[n] = x - static_cast<float>(i);
    v[n] = y - static_cast<float>(j);
    // The nearest of the four centres is that of the point's own cell.
    const std::int32_t row = i - (u[n] < 0.5F ? 1 : 0), col = j - (v[n] < 0.5F ? 1 : 0);
    cells[n] = std::clamp(row, 0, rows - 2) + std::clamp(col, 0, cols - 2) * (rows - 1);
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
