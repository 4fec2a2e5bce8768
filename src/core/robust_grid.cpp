#include "robust_grid.h"

#include <algorithm>
#include <cmath>

#include "pcl_fft_ground/core/spectrum.h"

namespace pcl_fft_ground::core {

BilinearGrid::BilinearGrid(const GridGeometry& geometry)
    : geometry_(geometry), rows_(geometry.rows), per_metre_(1 / geometry.cell_size) {}

Footing BilinearGrid::at(double x, double y) const {
  const double u =
      std::clamp((x - geometry_.origin.x()) * per_metre_ - 0.5, 0.0, static_cast<double>(geometry_.rows - 1));
  const double v =
      std::clamp((y - geometry_.origin.y()) * per_metre_ - 0.5, 0.0, static_cast<double>(geometry_.cols - 1));
  const Eigen::Index i = std::min(static_cast<Eigen::Index>(u), geometry_.rows - 2);
  const Eigen::Index j = std::min(static_cast<Eigen::Index>(v), geometry_.cols - 2);
  return {i + j * rows_, u - static_cast<double>(i), v - static_cast<double>(j)};
}

double BilinearGrid::slope(const Eigen::ArrayXXd& grid, const Footing& f) const {
  const double* h = grid.data() + f.corner;
  const double along = (1 - f.b) * (h[1] - h[0]) + f.b * (h[rows_ + 1] - h[rows_]);
  const double across = (1 - f.a) * (h[rows_] - h[0]) + f.a * (h[rows_ + 1] - h[1]);
  return per_metre_ * std::hypot(along, across);
}

GridGeometry scaleGeometry(const GridGeometry& cells, double wavelength) {
  constexpr double CELLS_PER_WAVELENGTH = 4;
  constexpr double MARGIN = 0.5;  // wavelengths
  const double merged = std::floor(wavelength / (CELLS_PER_WAVELENGTH * cells.cell_size) + 1e-9);
  const auto factor = static_cast<Eigen::Index>(std::clamp(merged, 1.0, 1e6));
  const double size = cells.cell_size * static_cast<double>(factor);
  const auto margin = static_cast<Eigen::Index>(std::min(std::ceil(MARGIN * wavelength / size), 64.0));
  const auto length = [&](Eigen::Index n) { return smoothLength((n + factor - 1) / factor + 2 * margin); };
  const Eigen::Vector2d shift = Eigen::Vector2d::Constant(static_cast<double>(margin) * size);
  return {cells.origin - shift, size, length(cells.rows), length(cells.cols)};
}

Eigen::ArrayXXd resampled(const Eigen::ArrayXXd& values, const BilinearGrid& from, const GridGeometry& to) {
  Eigen::ArrayXXd result(to.rows, to.cols);
  for (Eigen::Index j = 0; j < to.cols; ++j)
    for (Eigen::Index i = 0; i < to.rows; ++i) {
      const double x = to.origin.x() + (static_cast<double>(i) + 0.5) * to.cell_size;
      const double y = to.origin.y() + (static_cast<double>(j) + 0.5) * to.cell_size;
      result(i, j) = from.value(values, from.at(x, y));
    }
  return result;
}

}  // namespace pcl_fft_ground::core
