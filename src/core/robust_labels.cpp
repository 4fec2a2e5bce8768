#include "pcl_fft_ground/core/robust_ground.h"
#include "robust_grid.h"

namespace pcl_fft_ground::core {
namespace {

/// The surface continued by a row and a column, as interpolation wants two of each.
Eigen::ArrayXXd continued(const Eigen::ArrayXXd& heights) {
  Eigen::ArrayXXd result(heights.rows() + 1, heights.cols() + 1);
  result.topLeftCorner(heights.rows(), heights.cols()) = heights;
  result.bottomRows(1).leftCols(heights.cols()) = heights.bottomRows(1);
  result.rightCols(1) = result.col(heights.cols() - 1);
  return result;
}

}  // namespace

RobustLabels labelRobust(const PointsView& points, const RobustGround& ground) {
  RobustLabels result{Labels(static_cast<std::size_t>(points.cols()), Label::GROUND), 0};
  if (ground.surface.height.size() == 0) return result;
  const Eigen::ArrayXXd heights = continued(ground.surface.height);
  GridGeometry geometry = ground.surface.geometry;
  geometry.rows = heights.rows();
  geometry.cols = heights.cols();
  const BilinearGrid grid(geometry);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Footing footing = grid.at(points(0, n), points(1, n));
    const double height = points(2, n) - grid.value(heights, footing);
    const bool below = height < -ground.depth_tolerance;
    const double tolerance = ground.tolerance + ground.slope_tolerance * grid.slope(heights, footing);
    if (below || height > tolerance) result.labels[static_cast<std::size_t>(n)] = Label::OBJECT;
    if (below) ++result.below;
  }
  return result;
}

}  // namespace pcl_fft_ground::core
