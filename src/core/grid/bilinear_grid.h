#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

#include "pcl_fft_ground/core/grid/elevation_grid.h"

namespace pcl_fft_ground::core {

/// Where a place lies between the four nearest cell centres of a grid.
struct Footing {
  std::int32_t corner;  ///< storage index of the lower one
  float a, b;           ///< shares of the way to the next row and column, [0, 1]
};

/** Bilinear interpolation between the cell centres of a grid of at least 2 x 2 cells; beyond the outermost
 * centres the border continues. */
class BilinearGrid {
 public:
  explicit BilinearGrid(const GridGeometry& geometry);

  Footing at(double x, double y) const {
    const double u = std::clamp((x - first_centre_.x()) * per_metre_, 0.0, last_.x());
    const double v = std::clamp((y - first_centre_.y()) * per_metre_, 0.0, last_.y());
    const std::int32_t i = std::min(static_cast<std::int32_t>(u), rows_ - 2);
    const std::int32_t j = std::min(static_cast<std::int32_t>(v), cols_ - 2);
    return {i + j * rows_, static_cast<float>(u - i), static_cast<float>(v - j)};
  }

  double value(const Eigen::ArrayXXd& grid, const Footing& f) const {
    const double* h = grid.data() + f.corner;
    const double a = static_cast<double>(f.a), b = static_cast<double>(f.b);
    const double low = h[0] + a * (h[1] - h[0]);
    const double high = h[rows_] + a * (h[rows_ + 1] - h[rows_]);
    return low + b * (high - low);
  }

  /// Slopes along x and y [m/m].
  Eigen::Vector2d gradient(const Eigen::ArrayXXd& grid, const Footing& f) const {
    const double* h = grid.data() + f.corner;
    const double a = static_cast<double>(f.a), b = static_cast<double>(f.b);
    const double along = (1 - b) * (h[1] - h[0]) + b * (h[rows_ + 1] - h[rows_]);
    const double across = (1 - a) * (h[rows_] - h[0]) + a * (h[rows_ + 1] - h[1]);
    return {per_metre_ * along, per_metre_ * across};
  }

  /** Adds a pair of values to the four cells, in the shares of the interpolation (its transpose).
   * \param grid one column for each cell
   */
  void add(Eigen::Array2Xd& grid, const Footing& f, const Eigen::Array2d& pair) const {
    const double a = static_cast<double>(f.a), b = static_cast<double>(f.b);
    const Eigen::Array2d low = (1 - b) * pair, high = b * pair;
    grid.col(f.corner) += (1 - a) * low;
    grid.col(f.corner + 1) += a * low;
    grid.col(f.corner + rows_) += (1 - a) * high;
    grid.col(f.corner + rows_ + 1) += a * high;
  }

  const GridGeometry& geometry() const { return geometry_; }

 private:
  GridGeometry geometry_;
  Eigen::Vector2d first_centre_, last_;  // last_: in cells from the first
  double per_metre_;
  std::int32_t rows_, cols_;
};

/** The grid on which a scale is solved: no finer than its wavelength needs, and wider than the scan, as the
 * cosine basis is level at its ends and the ground need not be.
 * \param cells the elevation cells
 * \param wavelength [m]
 */
GridGeometry scaleGeometry(const GridGeometry& cells, double wavelength);

/// The values of a grid at the cell centres of another.
Eigen::ArrayXXd resampled(const Eigen::ArrayXXd& values, const BilinearGrid& from, const GridGeometry& to);

}  // namespace pcl_fft_ground::core
