#include <algorithm>
#include <cmath>
#include <vector>

#include "pcl_fft_ground/core/robust_ground.h"

namespace pcl_fft_ground::core {
namespace {

/// Between four cell centres: the bilinear surface, a + b u + c v + d u v, and how far above it ground ends.
struct Patch {
  float a, b, c, d;
  float tolerance;
};

/// The patches of a surface, one more along each axis than there are pairs of cells: beyond the outermost
/// centres the border continues.
class PatchGrid {
 public:
  explicit PatchGrid(const RobustGround& ground)
      : rows_(static_cast<int>(ground.surface.height.rows()) + 1),
        cols_(static_cast<int>(ground.surface.height.cols()) + 1),
        first_(ground.surface.geometry.origin.array() - 0.5 * ground.surface.geometry.cell_size),
        per_metre_(1 / ground.surface.geometry.cell_size) {
    patches_.reserve(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_));
    for (int j = 0; j < cols_; ++j)
      for (int i = 0; i < rows_; ++i) patches_.push_back(patchAt(ground, i, j));
  }

  /// Height [m] of a point above the surface, and above the end of the ground.
  struct Height {
    float above_surface, above_ground;
  };
  Height heightOf(const float* p) const {
    const double x = std::clamp((static_cast<double>(p[0]) - first_.x()) * per_metre_, 0.0, rows_ - 1e-6);
    const double y = std::clamp((static_cast<double>(p[1]) - first_.y()) * per_metre_, 0.0, cols_ - 1e-6);
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    const auto u = static_cast<float>(x - i), v = static_cast<float>(y - j);
    const Patch& patch = patches_[static_cast<std::size_t>(i + j * rows_)];
    const float height = p[2] - (patch.a + patch.b * u + (patch.c + patch.d * u) * v);
    return {height, height - patch.tolerance};
  }

 private:
  Patch patchAt(const RobustGround& ground, Eigen::Index i, Eigen::Index j) const {
    const Eigen::ArrayXXd& h = ground.surface.height;
    const Eigen::Index low_i = std::max<Eigen::Index>(i - 1, 0), low_j = std::max<Eigen::Index>(j - 1, 0);
    const Eigen::Index high_i = std::min(i, h.rows() - 1), high_j = std::min(j, h.cols() - 1);
    const double a = h(low_i, low_j), b = h(high_i, low_j) - a, c = h(low_i, high_j) - a;
    const double d = h(high_i, high_j) - a - b - c;
    const double slope = per_metre_ * std::hypot(b + 0.5 * d, c + 0.5 * d);
    return {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c), static_cast<float>(d),
            static_cast<float>(ground.tolerance + ground.slope_tolerance * slope)};
  }

  int rows_, cols_;
  Eigen::Array2d first_;  // lower corner of patch (0, 0)
  double per_metre_;
  std::vector<Patch> patches_;
};

}  // namespace

RobustLabels labelRobust(const PointsView& points, const RobustGround& ground) {
  RobustLabels result{Labels(static_cast<std::size_t>(points.cols()), Label::GROUND), 0};
  if (ground.surface.height.size() == 0) return result;
  const PatchGrid grid(ground);
  const auto deepest = static_cast<float>(-ground.depth_tolerance);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const PatchGrid::Height height = grid.heightOf(points.data() + 3 * n);
    const bool below = height.above_surface < deepest;
    result.labels[static_cast<std::size_t>(n)] =
        below | (height.above_ground > 0) ? Label::OBJECT : Label::GROUND;
    result.below += below ? 1 : 0;
  }
  return result;
}

}  // namespace pcl_fft_ground::core
