#include "ground/robust_points.h"

#include <algorithm>

namespace pcl_fft_ground::core {
namespace {

std::vector<std::int32_t> cellsOf(const PointsView& points, const GridGeometry& cells) {
  const double per_metre = 1 / cells.cell_size, x = cells.origin.x(), y = cells.origin.y();
  const auto rows = static_cast<std::int32_t>(cells.rows), cols = static_cast<std::int32_t>(cells.cols);
  std::vector<std::int32_t> result(static_cast<std::size_t>(points.cols()));
  const float* p = points.data();
  for (std::int32_t& cell : result) {
    const auto i = static_cast<std::int32_t>((static_cast<double>(p[0]) - x) * per_metre);
    const auto j = static_cast<std::int32_t>((static_cast<double>(p[1]) - y) * per_metre);
    cell = std::min(i, rows - 1) + std::min(j, cols - 1) * rows;
    p += 3;
  }
  return result;
}

}  // namespace

SortedPoints::SortedPoints(const PointsView& points, const Bounds& bounds, const GridGeometry& cells)
    : bounds_(bounds), cells_(cells), positions_(3, points.cols()) {
  const std::vector<std::int32_t> cell_of = cellsOf(points, cells);
  std::vector<std::uint32_t> next(static_cast<std::size_t>(cells.rows * cells.cols), 0);
  for (const std::int32_t cell : cell_of) ++next[static_cast<std::size_t>(cell)];
  std::uint32_t begin = 0;
  for (std::size_t cell = 0; cell < next.size(); ++cell) {
    const std::uint32_t count = next[cell];
    next[cell] = begin;
    if (count == 0) continue;
    observed_.push_back(static_cast<std::int32_t>(cell));
    begins_.push_back(begin);
    begin += count;
  }
  begins_.push_back(begin);
  const float* from = points.data();
  float* const positions = positions_.data();
  for (const std::int32_t cell : cell_of) {
    float* const to = positions + 3 * next[static_cast<std::size_t>(cell)]++;
    for (int axis = 0; axis < 3; ++axis) to[axis] = from[axis];
    from += 3;
  }
}

}  // namespace pcl_fft_ground::core
