#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "pcl_fft_ground/core/ground/robust_ground.h"
#include "pcl_fft_ground/core/scan/threads.h"
#include "scan/point_block.h"

namespace pcl_fft_ground::core {
namespace {

/// Between four cell centres: the bilinear surface, a + b u + c v + d u v, and how its slope s stretches what
/// is measured at a right angle.
struct Patch {
  float a, b, c, d;
  float stretch;  // sqrt(1 + s^2)
  float lean;     // height by which places differ that are not told apart [m]

  float heightAt(float u, float v) const { return a + b * u + (c + d * u) * v; }
};

/// Where points lie between four cell centres.
struct Places {
  std::array<std::int32_t, PointBlock::SIZE> patches, cells;
  std::array<float, PointBlock::SIZE> u, v;  // shares of the way to the next centre
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

  void locate(const PointBlock& points, Places& places) const {
    const auto x_first = static_cast<float>(first_.x()), y_first = static_cast<float>(first_.y());
    const auto per_metre = static_cast<float>(per_metre_);
    const float x_end = std::nextafter(static_cast<float>(rows_), 0.0F);
    const float y_end = std::nextafter(static_cast<float>(cols_), 0.0F);
    const int rows = rows_, cols = cols_;
    for (std::size_t n = 0; n < points.count; ++n) {
      const float x = std::min(std::max((points.x[n] - x_first) * per_metre, 0.0F), x_end);
      const float y = std::min(std::max((points.y[n] - y_first) * per_metre, 0.0F), y_end);
      const auto i = static_cast<std::int32_t>(x), j = static_cast<std::int32_t>(y);
      places.patches[n] = i + j * rows;
      places.u[n] = x - static_cast<float>(i);
      places.v[n] = y - static_cast<float>(j);
      // The nearest of the four centres is that of the point's own cell.
      const std::int32_t row = i - (places.u[n] < 0.5F ? 1 : 0), col = j - (places.v[n] < 0.5F ? 1 : 0);
      places.cells[n] = std::clamp(row, 0, rows - 2) + std::clamp(col, 0, cols - 2) * (rows - 1);
    }
  }

  const Patch& patch(std::int32_t n) const { return patches_[static_cast<std::size_t>(n)]; }

 private:
  Patch patchAt(const RobustGround& ground, Eigen::Index i, Eigen::Index j) const {
    const Eigen::ArrayXXd& h = ground.surface.height;
    const Eigen::Index low_i = std::max<Eigen::Index>(i - 1, 0), low_j = std::max<Eigen::Index>(j - 1, 0);
    const Eigen::Index high_i = std::min(i, h.rows() - 1), high_j = std::min(j, h.cols() - 1);
    const double a = h(low_i, low_j), b = h(high_i, low_j) - a, c = h(low_i, high_j) - a;
    const double d = h(high_i, high_j) - a - b - c;
    const double slope = per_metre_ * Eigen::Vector2d(b + 0.5 * d, c + 0.5 * d).norm();
    return {static_cast<float>(a),
            static_cast<float>(b),
            static_cast<float>(c),
            static_cast<float>(d),
            static_cast<float>(std::sqrt(1 + slope * slope)),
            static_cast<float>(ground.slope_tolerance * slope)};
  }

  int rows_, cols_;
  Eigen::Array2d first_;  // lower corner of patch (0, 0)
  double per_metre_;
  std::vector<Patch> patches_;
};

/// How far above the surface the ground of each cell ends [m]: the surface may bend up to the lowest point of
/// a cell, but not further than the greatest tolerance.
std::vector<float> reachesOf(const RobustGround& ground, const PatchGrid& grid) {
  const Eigen::Index rows = ground.surface.height.rows();
  std::vector<float> reaches(static_cast<std::size_t>(ground.surface.height.size()));
  for (Eigen::Index n = 0; n < ground.surface.height.size(); ++n) {
    const Patch& patch = grid.patch(static_cast<std::int32_t>(n % rows + 1 + (n / rows + 1) * (rows + 1)));
    const auto lowest = static_cast<double>(ground.lowest.data()[n]);
    const double bend =
        std::max(0.0, (lowest - static_cast<double>(patch.lean)) / static_cast<double>(patch.stretch));
    const bool seen = ground.elevation.observed.data()[n];
    const double usual =
        seen ? std::min(bend + ground.tolerance, ground.most_tolerance) : ground.most_tolerance;
    const float step = ground.steps.data()[n];
    reaches[static_cast<std::size_t>(n)] =
        std::max(static_cast<float>(usual), step > 0 ? step + static_cast<float>(ground.tolerance) : 0.0F);
  }
  return reaches;
}

}  // namespace

RobustLabels labelRobust(const PointsView& points, const RobustGround& ground) {
  RobustLabels result{Labels(static_cast<std::size_t>(points.cols()), Label::GROUND), 0};
  if (ground.surface.height.size() == 0) return result;
  const PatchGrid grid(ground);
  const std::vector<float> reaches = reachesOf(ground, grid);
  const auto deepest = static_cast<float>(-ground.depth_tolerance);
  const auto labelPart = [&](const PointsView& part, Label* labels) {
    PointBlock block;
    Places places;
    std::size_t count_below = 0;
    for (std::size_t begin = 0; begin < static_cast<std::size_t>(part.cols()); begin += block.count) {
      block.read(part, begin);
      grid.locate(block, places);
      for (std::size_t n = 0; n < block.count; ++n) {
        const Patch& patch = grid.patch(places.patches[n]);
        const float height = block.z[n] - patch.heightAt(places.u[n], places.v[n]);
        const bool below = height < deepest - patch.lean;
        const float highest = reaches[static_cast<std::size_t>(places.cells[n])] * patch.stretch + patch.lean;
        labels[begin + n] = below | (height > highest) ? Label::OBJECT : Label::GROUND;
        count_below += below ? 1 : 0;
      }
    }
    return count_below;
  };
  for (const std::size_t below :
       resultsOfRanges(points.cols(), POINTS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
         return labelPart(points.middleCols(begin, end - begin), result.labels.data() + begin);
       }))
    result.below += below;
  return result;
}

}  // namespace pcl_fft_ground::core
