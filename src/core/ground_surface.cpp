#include "pcl_fft_ground/core/ground_surface.h"

#include <algorithm>

namespace pcl_fft_ground::core {
namespace {

/// Bilinear interpolation between the cell centres of a surface; beyond them the border continues.
class BilinearSampler {
 public:
  explicit BilinearSampler(const GroundSurface& surface)
      : heights_(surface.height.data()),
        stride_(surface.height.rows()),
        next_row_(surface.height.rows() > 1 ? 1 : 0),
        next_col_(surface.height.cols() > 1 ? stride_ : 0),
        first_centre_(surface.geometry.origin.array() + 0.5 * surface.geometry.cell_size),
        last_cell_(static_cast<double>(surface.height.rows() - 1),
                   static_cast<double>(surface.height.cols() - 1)),
        last_pair_((last_cell_.cast<int>() - 1).max(0)),
        cells_per_metre_(1 / surface.geometry.cell_size) {}

  double operator()(const Eigen::Array2d& place) const {
    const Eigen::Array2d cell = ((place - first_centre_) * cells_per_metre_).max(0.0).min(last_cell_);
    const Eigen::Array2i pair = cell.cast<int>().min(last_pair_);
    const Eigen::Array2d t = cell - pair.cast<double>();
    const double* h = heights_ + pair.x() + pair.y() * stride_;
    const double low = h[0] + t.x() * (h[next_row_] - h[0]);
    const double high = h[next_col_] + t.x() * (h[next_col_ + next_row_] - h[next_col_]);
    return low + t.y() * (high - low);
  }

 private:
  const double* heights_;
  Eigen::Index stride_, next_row_, next_col_;
  Eigen::Array2d first_centre_, last_cell_;
  Eigen::Array2i last_pair_;
  double cells_per_metre_;
};

}  // namespace

double GroundSurface::heightAt(double x, double y) const {
  return BilinearSampler(*this)({x, y});
}

double GroundSurface::heightAbove(const Eigen::Vector3d& input_point) const {
  const Eigen::Vector3d p = frame_from_input * input_point;
  return p.z() - heightAt(p.x(), p.y());
}

Labels labelByHeight(const PointsView& points, const GroundSurface& surface, double tolerance) {
  const BilinearSampler ground(surface);
  Labels labels(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const double height = points(2, n) - ground(points.col(n).head<2>().array().cast<double>());
    labels[static_cast<std::size_t>(n)] = height > tolerance ? Label::OBJECT : Label::GROUND;
  }
  return labels;
}

}  // namespace pcl_fft_ground::core
