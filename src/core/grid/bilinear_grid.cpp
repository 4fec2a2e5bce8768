#include "grid/bilinear_grid.h"

#include <algorithm>
#include <cmath>

#include "grid/dct.h"

namespace pcl_fft_ground::core {

BilinearGrid::BilinearGrid(const GridGeometry& geometry)
    : geometry_(geometry),
      first_centre_(geometry.origin.array() + 0.5 * geometry.cell_size),
      last_(static_cast<double>(geometry.rows - 1), static_cast<double>(geometry.cols - 1)),
      per_metre_(1 / geometry.cell_size),
      rows_(static_cast<std::int32_t>(geometry.rows)),
      cols_(static_cast<std::int32_t>(geometry.cols)) {}

GridGeometry scaleGeometry(const GridGeometry& cells, double wavelength) {
  constexpr double CELLS_PER_WAVELENGTH = 3.2, MARGIN = 0.5;  // in wavelengths
  const double size = std::max(wavelength / CELLS_PER_WAVELENGTH, cells.cell_size);
  const double margins = std::min(2 * MARGIN * wavelength / size, 128.0);
  const Eigen::Array2d own = cells.cell_size / size * Eigen::Array2d(cells.rows, cells.cols);
  const Eigen::Array2d needed = (own + margins).ceil();
  const Eigen::Index rows = fastDctLength(static_cast<Eigen::Index>(needed.x()));
  const Eigen::Index cols = fastDctLength(static_cast<Eigen::Index>(needed.y()));
  const Eigen::Array2d excess = Eigen::Array2d(rows, cols) - own;
  return {cells.origin - 0.5 * size * excess.matrix(), size, rows, cols};
}

Eigen::ArrayXXd resampled(const Eigen::ArrayXXd& values, const BilinearGrid& from, const GridGeometry& to) {
  const auto centre = [&](Eigen::Index axis, Eigen::Index n) {
    return to.origin[axis] + (static_cast<double>(n) + 0.5) * to.cell_size;
  };
  Eigen::ArrayXXd result(to.rows, to.cols);
  for (Eigen::Index j = 0; j < to.cols; ++j)
    for (Eigen::Index i = 0; i < to.rows; ++i)
      result(i, j) = from.value(values, from.at(centre(0, i), centre(1, j)));
  return result;
}

}  // namespace pcl_fft_ground::core
