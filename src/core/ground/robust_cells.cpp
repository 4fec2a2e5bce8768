#include "ground/robust_cells.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "pcl_fft_ground/core/scan/threads.h"

namespace pcl_fft_ground::core {
namespace {

std::vector<std::int32_t> cellsOf(const PointsView& points, const GridGeometry& cells) {
  const double per_metre = 1 / cells.cell_size, x = cells.origin.x(), y = cells.origin.y();
  const auto rows = static_cast<std::int32_t>(cells.rows), cols = static_cast<std::int32_t>(cells.cols);
  std::vector<std::int32_t> result(static_cast<std::size_t>(points.cols()));
  forEachRange(points.cols(), POINTS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
    const float* p = points.data() + 3 * begin;
    for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n, p += 3) {
      const auto i = static_cast<std::int32_t>((static_cast<double>(p[0]) - x) * per_metre);
      const auto j = static_cast<std::int32_t>((static_cast<double>(p[1]) - y) * per_metre);
      result[n] = std::min(i, rows - 1) + std::min(j, cols - 1) * rows;
    }
  });
  return result;
}

/// Lower, or at the same height and before in x and y: any order that is not that of the points.
bool isBelow(const float* a, const float* b) {
  if (a[2] != b[2]) return a[2] < b[2];
  return a[0] != b[0] ? a[0] < b[0] : a[1] < b[1];
}

/// The lowest point of a cell; the second lowest if there are enough to drop one.
const float* lowestPoint(const float* begin, const float* end) {
  constexpr std::ptrdiff_t ENOUGH_TO_DROP_ONE = 4;
  const float* first = begin;
  const float* second = nullptr;
  for (const float* p = begin + 3; p < end; p += 3) {
    if (isBelow(p, first)) {
      second = first;
      first = p;
    } else if (second == nullptr || isBelow(p, second)) {
      second = p;
    }
  }
  return end - begin >= 3 * ENOUGH_TO_DROP_ONE ? second : first;
}

/// For about as many points as a thread works on at a time.
Eigen::Index cellsAtATime(const SortedPoints& points) {
  const auto cells = static_cast<Eigen::Index>(points.size());
  return std::max<Eigen::Index>(
      1, cells * POINTS_AT_A_TIME / std::max<Eigen::Index>(points.positions().cols(), cells));
}

/// Calls work(n) for every cell that holds points.
template <typename Work>
void forEachCell(const SortedPoints& points, const Work& work) {
  forEachRange(static_cast<Eigen::Index>(points.size()), cellsAtATime(points),
               [&](Eigen::Index begin, Eigen::Index end) {
                 for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
                   work(n);
               });
}

/// The points that find(n) has for the cells that hold points, nothing for some of them.
template <typename Find>
CellPoints pointsOfCells(const SortedPoints& points, const Find& find) {
  const auto parts = resultsOfRanges(static_cast<Eigen::Index>(points.size()), cellsAtATime(points),
                                     [&](Eigen::Index begin, Eigen::Index end) {
                                       CellPoints part;
                                       part.positions.reserve(static_cast<std::size_t>(end - begin));
                                       part.cells.reserve(static_cast<std::size_t>(end - begin));
                                       for (auto n = static_cast<std::size_t>(begin);
                                            n < static_cast<std::size_t>(end); ++n) {
                                         const std::optional<Eigen::Vector3d> found = find(n);
                                         if (!found) continue;
                                         part.positions.push_back(*found);
                                         part.cells.push_back(points.cell(n));
                                       }
                                       return part;
                                     });
  CellPoints result;
  result.positions.reserve(points.size());
  result.cells.reserve(points.size());
  for (const CellPoints& part : parts) {
    result.positions.insert(result.positions.end(), part.positions.begin(), part.positions.end());
    result.cells.insert(result.cells.end(), part.cells.begin(), part.cells.end());
  }
  return result;
}

CellPoints lowestPoints(const SortedPoints& points) {
  const float* positions = points.positions().data();
  return pointsOfCells(points, [&](std::size_t n) -> std::optional<Eigen::Vector3d> {
    const float* lowest = lowestPoint(positions + 3 * points.begin(n), positions + 3 * points.end(n));
    return Eigen::Map<const Eigen::Vector3f>(lowest).cast<double>();
  });
}

/// The tangent of a surface amid a cell: within a cell the two are the same.
struct Tangent {
  double height = 0, along = 0, across = 0;  // at the origin of the level frame [m], slopes

  Tangent() = default;
  Tangent(const GroundBand& band, const Eigen::Vector2d& place) {
    const Footing footing = band.grid.at(place.x(), place.y());
    const Eigen::Vector2d slope = band.grid.gradient(band.surface, footing);
    height = band.grid.value(band.surface, footing) - slope.dot(place);
    along = slope.x();
    across = slope.y();
  }

  double heightAbove(const float* p) const {
    return static_cast<double>(p[2]) - height - along * static_cast<double>(p[0]) -
           across * static_cast<double>(p[1]);
  }
};

/// Mean of points. Sums of integers do not depend on the order of the points.
class PointMean {
 public:
  PointMean(const Eigen::Array3d& low, const Eigen::Array3d& steps_per_metre)
      : low_(low), steps_per_metre_(steps_per_metre) {}

  void add(const float* p) {
    x_ += steps(p, 0), y_ += steps(p, 1), z_ += steps(p, 2);
    ++count_;
  }
  bool isEmpty() const { return count_ == 0; }
  Eigen::Vector3d mean() const {
    const Eigen::Array3d sum(static_cast<double>(x_), static_cast<double>(y_), static_cast<double>(z_));
    return low_ + sum / (steps_per_metre_ * static_cast<double>(count_));
  }

 private:
  std::int64_t steps(const float* p, int axis) const {
    return static_cast<std::int64_t>((static_cast<double>(p[axis]) - low_[axis]) * steps_per_metre_[axis]);
  }

  Eigen::Array3d low_, steps_per_metre_;
  std::int64_t x_ = 0, y_ = 0, z_ = 0, count_ = 0;
};

/// The mean of the points of each cell that lie between two heights above the cell's tangent.
template <typename TangentOf>
CellPoints meanPoints(const SortedPoints& points, double low, double high, const TangentOf& tangent_of) {
  const double height = std::max((points.bounds().high - points.bounds().low).z(), 1e-9);
  const Eigen::Array3d steps_per_metre =
      Eigen::Array3d(0x1p20, 0x1p20, 0x1p30) /
      Eigen::Array3d(points.cells().cell_size, points.cells().cell_size, height);
  const float* positions = points.positions().data();
  return pointsOfCells(points, [&](std::size_t n) -> std::optional<Eigen::Vector3d> {
    const Tangent tangent = tangent_of(n);
    const Eigen::Vector2d corner = points.corner(n);
    PointMean mean({corner.x(), corner.y(), points.bounds().low.z()}, steps_per_metre);
    for (Eigen::Index k = points.begin(n); k < points.end(n); ++k) {
      const float* p = positions + 3 * k;
      const double above = tangent.heightAbove(p);
      if (above >= low && above <= high) mean.add(p);
    }
    return mean.isEmpty() ? std::nullopt : std::optional<Eigen::Vector3d>(mean.mean());
  });
}

Eigen::Vector2d centreOf(const SortedPoints& points, std::size_t n) {
  return points.corner(n).array() + 0.5 * points.cells().cell_size;
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
    float* const to = positions + std::size_t{3} * next[static_cast<std::size_t>(cell)]++;
    for (int axis = 0; axis < 3; ++axis) to[axis] = from[axis];
    from += 3;
  }
}

CellMap::CellMap(const CellPoints& points, const GridGeometry& cells)
    : points_(points), cells_(cells), before_(static_cast<std::size_t>(cells.rows * cells.cols) + 1) {
  std::size_t from = 0;
  for (std::size_t n = 0; n <= points.cells.size(); ++n) {
    const std::size_t to =
        n < points.cells.size() ? static_cast<std::size_t>(points.cells[n]) + 1 : before_.size();
    std::fill(before_.begin() + static_cast<std::ptrdiff_t>(from),
              before_.begin() + static_cast<std::ptrdiff_t>(to), static_cast<std::uint32_t>(n));
    from = to;
  }
}

double CellMap::density() const {
  return static_cast<double>(points_.cells.size()) / static_cast<double>(size());
}

Eigen::Index CellMap::reach() const {
  return std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::round(1 / std::sqrt(density()))));
}

CellPoints representativePoints(const SortedPoints& points, CellStatistic statistic) {
  if (statistic == CellStatistic::LOWEST) return lowestPoints(points);
  constexpr double ANY = std::numeric_limits<double>::infinity();
  return meanPoints(points, -ANY, ANY, [](std::size_t) { return Tangent(); });
}

CellPoints meanGroundPoints(const SortedPoints& points, const GroundBand& band) {
  return meanPoints(points, band.low, band.high,
                    [&](std::size_t n) { return Tangent(band, centreOf(points, n)); });
}

std::vector<float> heightsIn(const SortedPoints& points, const GroundBand& band, const Mask* left_out) {
  constexpr Eigen::Index ENOUGH = 20000;
  const auto one_in = static_cast<std::size_t>(std::max<Eigen::Index>(points.positions().cols() / ENOUGH, 1));
  std::vector<float> heights;
  heights.reserve(2 * ENOUGH);
  for (std::size_t n = 0; n < points.size(); n += one_in) {
    if (left_out != nullptr && left_out->data()[points.cell(n)]) continue;
    const Tangent tangent(band, centreOf(points, n));
    for (Eigen::Index k = points.begin(n); k < points.end(n); ++k) {
      const double height = tangent.heightAbove(points.positions().data() + 3 * k);
      if (height >= band.low && height <= band.high) heights.push_back(static_cast<float>(height));
    }
  }
  return heights;
}

Eigen::ArrayXXf lowestHeights(const SortedPoints& points, const GroundBand& band) {
  Eigen::ArrayXXf lowest = Eigen::ArrayXXf::Zero(points.cells().rows, points.cells().cols);
  forEachCell(points, [&](std::size_t n) {
    const Tangent tangent(band, centreOf(points, n));
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index k = points.begin(n); k < points.end(n); ++k)
      least = std::min(least, tangent.heightAbove(points.positions().data() + 3 * k));
    lowest.data()[points.cell(n)] = static_cast<float>(least);
  });
  return lowest;
}

Mask cellsReachingAbove(const SortedPoints& points, const GroundBand& band) {
  Mask above = Mask::Constant(points.cells().rows, points.cells().cols, false);
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Tangent tangent(band, centreOf(points, n));
    for (Eigen::Index k = points.begin(n); k < points.end(n); ++k)
      if (tangent.heightAbove(points.positions().data() + 3 * k) > band.high)
        above.data()[points.cell(n)] = true;
  }
  return above;
}

ElevationGrid elevationOf(const CellPoints& points, const GridGeometry& cells) {
  ElevationGrid grid{cells, Eigen::ArrayXXd::Zero(cells.rows, cells.cols),
                     Mask::Constant(cells.rows, cells.cols, false)};
  for (std::size_t n = 0; n < points.cells.size(); ++n) {
    grid.elevation.data()[points.cells[n]] = points.positions[n].z();
    grid.observed.data()[points.cells[n]] = true;
  }
  fillEmptyCells(grid.elevation, grid.observed);
  return grid;
}

}  // namespace pcl_fft_ground::core
