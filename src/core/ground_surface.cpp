#include "pcl_fft_ground/core/ground_surface.h"

#include <algorithm>

namespace pcl_fft_ground::core {
namespace {

/// Bilinear interpolation between the cell centres of a surface; beyond them the border continues.
class BilinearSampler {
 public:
  explicit BilinearSampler(const GroundSurface& surface)
      : heights_(surface.height.data()),
        next_row_(surface.height.rows() > 1 ? 1 : 0),
        next_col_(surface.height.cols() > 1 ? surface.height.rows() : 0),
        stride_(surface.height.rows()),
        last_row_(std::max<Eigen::Index>(surface.height.rows() - 2, 0)),
        last_col_(std::max<Eigen::Index>(surface.height.cols() - 2, 0)),
        x_centre_(surface.geometry.origin.x() + 0.5 * surface.geometry.cell_size),
        y_centre_(surface.geometry.origin.y() + 0.5 * surface.geometry.cell_size),
        cells_per_metre_(1 / surface.geometry.cell_size) {}

  double operator()(double x, double y) const {
    const double u =
        std::clamp((x - x_centre_) * cells_per_metre_, 0.0, static_cast<double>(last_row_ + next_row_));
    const double v = std::clamp((y - y_centre_) * cells_per_metre_, 0.0,
                                static_cast<double>(last_col_ + (next_col_ ? 1 : 0)));
    const Eigen::Index i = std::min(static_cast<Eigen::Index>(u), last_row_);
    const Eigen::Index j = std::min(static_cast<Eigen::Index>(v), last_col_);
    const double* h = heights_ + i + j * stride_;
    const double a = u - static_cast<double>(i), b = v - static_cast<double>(j);
    const double low = h[0] + a * (h[next_row_] - h[0]);
    const double high = h[next_col_] + a * (h[next_col_ + next_row_] - h[next_col_]);
    return low + b * (high - low);
  }

 private:
  const double* heights_;
  Eigen::Index next_row_, next_col_, stride_, last_row_, last_col_;
  double x_centre_, y_centre_, cells_per_metre_;
};

}  // namespace

double GroundSurface::heightAt(double x, double y) const {
  return BilinearSampler(*this)(x, y);
}

double GroundSurface::heightAbove(const Eigen::Vector3d& input_point) const {
  const Eigen::Vector3d p = frame_from_input * input_point;
  return p.z() - heightAt(p.x(), p.y());
}

Labels labelByHeight(const PointsView& points, const GroundSurface& surface, double tolerance) {
  const BilinearSampler ground(surface);
  Labels labels(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const double height = points(2, n) - ground(points(0, n), points(1, n));
    labels[static_cast<std::size_t>(n)] = height > tolerance ? Label::OBJECT : Label::GROUND;
  }
  return labels;
}

}  // namespace pcl_fft_ground::core
