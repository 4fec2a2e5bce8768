#include "robust/robust_openings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_fft_ground::core {
namespace {

/// Smallest of every 2 * reach + 1 neighbours of a line, in place (van Herk 1992): O(n) for every window.
class RunningMinimum {
 public:
  RunningMinimum(Eigen::Index length, Eigen::Index reach)
      : length_(length),
        reach_(reach),
        window_(2 * reach + 1),
        padded_((length + 2 * reach + window_ - 1) / window_ * window_),
        line_(Eigen::ArrayXd::Constant(padded_, std::numeric_limits<double>::infinity())),
        forward_(padded_),
        backward_(padded_) {}

  template <typename Line>
  void apply(Line&& line) {
    line_.segment(reach_, length_) = line;
    for (Eigen::Index i = 0; i < padded_; ++i)
      forward_[i] = i % window_ == 0 ? line_[i] : std::min(forward_[i - 1], line_[i]);
    for (Eigen::Index i = padded_ - 1; i >= 0; --i)
      backward_[i] = i % window_ == window_ - 1 ? line_[i] : std::min(backward_[i + 1], line_[i]);
    line = backward_.head(length_).min(forward_.segment(2 * reach_, length_));
  }

 private:
  Eigen::Index length_, reach_, window_, padded_;
  Eigen::ArrayXd line_, forward_, backward_;
};

void erode(Eigen::ArrayXXd& grid, Eigen::Index reach) {
  RunningMinimum along(grid.rows(), reach), across(grid.cols(), reach);
  for (Eigen::Index j = 0; j < grid.cols(); ++j) along.apply(grid.col(j));
  grid.transposeInPlace();
  for (Eigen::Index i = 0; i < grid.cols(); ++i) across.apply(grid.col(i));
  grid.transposeInPlace();
}

/// Smallest, then largest of the (2 reach + 1)^2 cells around each.
Eigen::ArrayXXd opened(Eigen::ArrayXXd grid, Eigen::Index reach) {
  erode(grid, reach);
  grid = -grid;
  erode(grid, reach);
  return -grid;
}

}  // namespace

std::vector<bool> openedGround(const CellPoints& points, const GridGeometry& cells,
                               const OpeningParameters& parameters) {
  constexpr double GROWTH = 1.5;
  const Eigen::ArrayXXd elevation = elevationOf(points, cells).elevation;
  const auto widest =
      static_cast<Eigen::Index>(std::clamp(std::ceil(0.5 * parameters.max_object_size / cells.cell_size), 1.0,
                                           static_cast<double>(std::max(cells.rows, cells.cols))));
  Eigen::ArrayXXd surface = elevation;
  Mask object = Mask::Constant(cells.rows, cells.cols, false);
  for (Eigen::Index reach = 1; reach > 0;) {
    const Eigen::ArrayXXd lower = opened(surface, reach);
    const double step = parameters.max_slope * static_cast<double>(reach) * cells.cell_size;
    object = object || surface - lower > std::max(step, parameters.least_height);
    surface = lower;
    const auto wider = static_cast<Eigen::Index>(GROWTH * static_cast<double>(reach));
    reach = reach == widest ? 0 : std::min(std::max(reach + 1, wider), widest);
  }
  std::vector<bool> ground;
  ground.reserve(points.cells.size());
  for (const Eigen::Index cell : points.cells) ground.push_back(!object.data()[cell]);
  return ground;
}

}  // namespace pcl_fft_ground::core
