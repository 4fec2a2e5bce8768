#include "pcl_fft_ground/core/ground/ground_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pcl_fft_ground/core/scan/threads.h"

namespace pcl_fft_ground::core {
namespace {

/// Heights of points [m] between which the surface itself must be asked: below all is ground, above all is
/// object.
struct HeightBand {
  float low, high;
};

/// Bilinear interpolation between the cell centres of a surface; beyond them the border continues.
class BilinearSampler {
 public:
  explicit BilinearSampler(const GroundSurface& surface)
      : heights_(surface.height.data()),
        size_(surface.height.size()),
        stride_(surface.height.rows()),
        next_row_(surface.height.rows() > 1 ? 1 : 0),
        next_col_(surface.height.cols() > 1 ? stride_ : 0),
        first_centre_(surface.geometry.origin.array() + 0.5 * surface.geometry.cell_size),
        last_cell_(static_cast<double>(surface.height.rows() - 1),
                   static_cast<double>(surface.height.cols() - 1)),
        last_pair_((last_cell_ - 1).max(0)),
        cells_per_metre_(1 / surface.geometry.cell_size) {}

  double operator()(const Eigen::Array2d& place) const {
    const Eigen::Array2d cell = ((place - first_centre_) * cells_per_metre_).max(0.0).min(last_cell_);
    const Eigen::Array2i pair = cell.min(last_pair_).cast<int>();
    const Eigen::Array2d t = cell - pair.cast<double>();
    const double* h = heights_ + pair.x() + pair.y() * stride_;
    const double low = h[0] + t.x() * (h[next_row_] - h[0]);
    const double high = h[next_col_] + t.x() * (h[next_col_ + next_row_] - h[next_col_]);
    return low + t.y() * (high - low);
  }

  /// Number of the cell from which a place is interpolated, together with the next ones.
  std::size_t pairAt(const Eigen::Array2d& place) const {
    const Eigen::Array2d pair = ((place - first_centre_) * cells_per_metre_).max(0.0).min(last_pair_);
    return static_cast<std::size_t>(static_cast<int>(pair.x()) + static_cast<int>(pair.y()) * stride_);
  }

  /// For every pairAt() the surface's range of heights plus a tolerance [m], widened by more than roundings.
  std::vector<HeightBand> bands(double tolerance) const {
    const auto [lowest, highest] = std::minmax_element(heights_, heights_ + size_);
    const double margin = 1e-6 * (std::abs(*lowest) + std::abs(*highest) + std::abs(tolerance));
    std::vector<HeightBand> result(static_cast<std::size_t>(size_));
    for (Eigen::Index n = 0; n + next_row_ + next_col_ < size_; ++n) {
      const double *h = heights_ + n, *next = h + next_col_;
      const auto [low, high] = std::minmax({h[0], h[next_row_], next[0], next[next_row_]});
      result[static_cast<std::size_t>(n)] = {static_cast<float>(low + tolerance - margin),
                                             static_cast<float>(high + tolerance + margin)};
    }
    return result;
  }

 private:
  const double* heights_;
  Eigen::Index size_, stride_, next_row_, next_col_;
  Eigen::Array2d first_centre_, last_cell_, last_pair_;
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
  if (points.cols() == 0) return {};
  const BilinearSampler ground(surface);
  const std::vector<HeightBand> bands = ground.bands(tolerance);
  Labels labels(static_cast<std::size_t>(points.cols()));
  constexpr Eigen::Index BLOCK = 512;
  const auto labelBlock = [&](Eigen::Index begin, Eigen::Index end) {
    std::array<Eigen::Index, BLOCK> undecided;
    std::size_t count = 0;
    for (Eigen::Index n = begin; n < end; ++n) {
      const HeightBand band = bands[ground.pairAt(points.col(n).head<2>().cast<double>())];
      const float height = points(2, n);
      labels[static_cast<std::size_t>(n)] = height > band.high ? Label::OBJECT : Label::GROUND;
      undecided[count] = n;
      count += ((height >= band.low) & (height <= band.high)) ? 1 : 0;
    }
    for (std::size_t u = 0; u < count; ++u) {
      const Eigen::Vector3d p = points.col(undecided[u]).cast<double>();
      const bool object = p.z() - ground(p.head<2>()) > tolerance;
      labels[static_cast<std::size_t>(undecided[u])] = object ? Label::OBJECT : Label::GROUND;
    }
  };
  forEachRange(points.cols(), POINTS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
    for (; begin < end; begin += BLOCK) labelBlock(begin, std::min(begin + BLOCK, end));
  });
  return labels;
}

GroundSurface planeSurface(const Eigen::Isometry3d& frame_from_input, const Bounds& bounds,
                           const Plane& plane) {
  const double longest = (bounds.high - bounds.low).head<2>().maxCoeff();
  const double cell_size = longest > 0 ? longest : 1.0;
  const Eigen::Vector2d first_centre = bounds.low.head<2>();
  GroundSurface surface{
      frame_from_input, {first_centre.array() - 0.5 * cell_size, cell_size, 2, 2}, Eigen::ArrayXXd(2, 2)};
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i)
      surface.height(i, j) = plane.slope.dot(first_centre + cell_size * Eigen::Vector2d(i, j)) + plane.offset;
  return surface;
}

}  // namespace pcl_fft_ground::core
