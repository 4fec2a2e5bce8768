#include "robust_cells.h"

#include <array>
#include <cmath>
#include <cstdint>

namespace pcl_fft_ground::core {
namespace {

/// Maps a point to the storage index of its cell.
class CellIndex {
 public:
  explicit CellIndex(const GridGeometry& cells)
      : origin_(cells.origin), cell_size_(cells.cell_size), rows_(cells.rows) {}
  Eigen::Index operator()(const PointsView& points, Eigen::Index n) const {
    const auto i = static_cast<Eigen::Index>((static_cast<double>(points(0, n)) - origin_.x()) / cell_size_);
    const auto j = static_cast<Eigen::Index>((static_cast<double>(points(1, n)) - origin_.y()) / cell_size_);
    return i + j * rows_;
  }

 private:
  Eigen::Vector2d origin_;
  double cell_size_;
  Eigen::Index rows_;
};

constexpr std::int32_t NONE = -1;

/// Numbers of the two lowest points of a cell and how many there are.
struct Lowest {
  std::int32_t first = NONE, second = NONE, count = 0;
};

/// Lower, or at the same height and before in x and y: any order that is not that of the points.
bool isBelow(const PointsView& points, std::int32_t a, std::int32_t b) {
  for (const int axis : {2, 0, 1})
    if (points(axis, a) != points(axis, b)) return points(axis, a) < points(axis, b);
  return false;
}

CellPoints lowestPoints(const PointsView& points, const GridGeometry& cells) {
  constexpr std::int32_t ENOUGH_TO_DROP_ONE = 4;
  std::vector<Lowest> lowest(static_cast<std::size_t>(cells.rows * cells.cols));
  const CellIndex cell_of(cells);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    Lowest& cell = lowest[static_cast<std::size_t>(cell_of(points, n))];
    const auto number = static_cast<std::int32_t>(n);
    ++cell.count;
    if (cell.first == NONE || isBelow(points, number, cell.first)) {
      cell.second = cell.first;
      cell.first = number;
    } else if (cell.second == NONE || isBelow(points, number, cell.second)) {
      cell.second = number;
    }
  }
  CellPoints result;
  for (std::size_t c = 0; c < lowest.size(); ++c) {
    if (lowest[c].count == 0) continue;
    const bool drop_one = lowest[c].count >= ENOUGH_TO_DROP_ONE;
    result.positions.push_back(points.col(drop_one ? lowest[c].second : lowest[c].first).cast<double>());
    result.cells.push_back(static_cast<Eigen::Index>(c));
  }
  return result;
}

/// Means of points, cell by cell. Sums of integers do not depend on the order of the points.
class CellMeans {
 public:
  explicit CellMeans(const PointsView& points, const GridGeometry& cells)
      : bounds_(boundsOf(points)),
        step_(std::max((bounds_.high - bounds_.low).maxCoeff(), 1e-9) * 0x1p-30),
        sums_(static_cast<std::size_t>(cells.rows * cells.cols), Sum{0, 0, 0, 0}) {}

  void add(Eigen::Index cell, const Eigen::Vector3d& point) {
    const Eigen::Array3d q = (point.array() - bounds_.low) / step_;
    Sum& sum = sums_[static_cast<std::size_t>(cell)];
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum[axis] += static_cast<std::int64_t>(q[static_cast<Eigen::Index>(axis)] + 0.5);
    ++sum[3];
  }

  CellPoints means() const {
    CellPoints result;
    for (std::size_t c = 0; c < sums_.size(); ++c) {
      if (sums_[c][3] == 0) continue;
      const Eigen::Array3d sum(static_cast<double>(sums_[c][0]), static_cast<double>(sums_[c][1]),
                               static_cast<double>(sums_[c][2]));
      result.positions.push_back(bounds_.low + step_ * sum / static_cast<double>(sums_[c][3]));
      result.cells.push_back(static_cast<Eigen::Index>(c));
    }
    return result;
  }

 private:
  using Sum = std::array<std::int64_t, 4>;  // x, y, z, count
  Bounds bounds_;
  double step_;
  std::vector<Sum> sums_;
};

}  // namespace

CellPoints representativePoints(const PointsView& points, const GridGeometry& cells,
                                CellStatistic statistic) {
  if (statistic == CellStatistic::LOWEST) return lowestPoints(points, cells);
  CellMeans means(points, cells);
  const CellIndex cell_of(cells);
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    means.add(cell_of(points, n), points.col(n).cast<double>());
  return means.means();
}

CellPoints meanGroundPoints(const PointsView& points, const GridGeometry& cells, const GroundBand& band) {
  CellMeans means(points, cells);
  const CellIndex cell_of(cells);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Eigen::Vector3d p = points.col(n).cast<double>();
    const double height = p.z() - band.grid.value(band.surface, band.grid.at(p.x(), p.y()));
    if (height >= band.low && height <= band.high) means.add(cell_of(points, n), p);
  }
  return means.means();
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
