#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_fft_ground/core/elevation_grid.h"

namespace pcl_fft_ground::core {

/// Where a place lies between the four nearest cell centres of a grid.
struct Footing {
  Eigen::Index corner;  ///< storage index of the lower one
  double a, b;          ///< shares of the way to the next row and column, [0, 1]
};

/** Bilinear interpolation between the cell centres of a grid of at least 2 x 2 cells; beyond the outermost
 * centres the border continues. */
class BilinearGrid {
 public:
  explicit BilinearGrid(const GridGeometry& geometry);

  Footing at(double x, double y) const;

  double value(const Eigen::ArrayXXd& grid, const Footing& f) const {
    const double* h = grid.data() + f.corner;
    const double low = h[0] + f.a * (h[1] - h[0]);
    const double high = h[rows_] + f.a * (h[rows_ + 1] - h[rows_]);
    return low + f.b * (high - low);
  }

  /// Steepest slope of the interpolated surface [m/m].
  double slope(const Eigen::ArrayXXd& grid, const Footing& f) const;

  /// Adds a value to the four cells, in the shares of the interpolation (its transpose).
  void add(Eigen::ArrayXXd& grid, const Footing& f, double value) const {
    double* h = grid.data() + f.corner;
    const double low = (1 - f.b) * value, high = f.b * value;
    h[0] += (1 - f.a) * low;
    h[1] += f.a * low;
    h[rows_] += (1 - f.a) * high;
    h[rows_ + 1] += f.a * high;
  }

  const GridGeometry& geometry() const { return geometry_; }

 private:
  GridGeometry geometry_;
  Eigen::Index rows_;
  double per_metre_;
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
