#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pcl_fft_ground/core/align/nearest_neighbours.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"

namespace pcl_fft_ground::core {
namespace {

/// Points sorted by the column that they stand in.
class ColumnNeighbours final : public NearestNeighbours {
 public:
  ColumnNeighbours(const PointsView& points, double spacing);

  Neighbour nearest(const Eigen::Vector3f& query, float reach) const override;
  void within(const Eigen::Vector3f& query, float radius, std::vector<Eigen::Index>& found) const override;

 private:
  struct Cell {
    int row, col;
  };
  struct Found {
    float squared_distance;
    std::size_t position;
  };

  Cell cellOf(float x, float y) const;
  /// True if no column lies outside of the ring.
  bool reachesAround(const Cell& centre, int ring) const {
    return centre.row - ring <= 0 && centre.col - ring <= 0 && centre.row + ring >= rows_ - 1 &&
           centre.col + ring >= cols_ - 1;
  }
  void searchRow(int row, int first, int last, const Eigen::Vector3f& query, Found& best) const;
  void searchColumn(int col, int first, int last, const Eigen::Vector3f& query, Found& best) const;
  /// First ring around a cell that has columns of the grid.
  int firstRing(const Cell& centre) const {
    return std::max({0, -centre.row, -centre.col, centre.row - rows_ + 1, centre.col - cols_ + 1});
  }
  bool searchRing(const Cell& centre, int ring, const Eigen::Vector3f& query, Found& best) const;

  Eigen::Array2f origin_;
  float cell_size_;
  int rows_, cols_;
  std::vector<std::uint32_t> starts_;  // per cell, the first of its points; columns of a row side by side
  Points sorted_;
  std::vector<Eigen::Index> index_;
};

/// Sides of the columns: twice the spacing, but no more than a few columns per point.
float columnSize(const Eigen::Array2d& extent, Eigen::Index count, double spacing) {
  constexpr double COLUMNS_PER_POINT = 4;
  const double least = std::sqrt(extent.prod() / (COLUMNS_PER_POINT * static_cast<double>(count)));
  const double longest = extent.maxCoeff() / (COLUMNS_PER_POINT * static_cast<double>(count));
  return static_cast<float>(std::max({2 * spacing, least, longest}));
}

ColumnNeighbours::ColumnNeighbours(const PointsView& points, double spacing) {
  const Bounds bounds = boundsOf(points);
  const Eigen::Array2d extent = (bounds.high - bounds.low).head<2>();
  origin_ = bounds.low.head<2>().cast<float>();
  cell_size_ = columnSize(extent, std::max<Eigen::Index>(1, points.cols()), spacing);
  rows_ = static_cast<int>(extent.x() / cell_size_) + 1;
  cols_ = static_cast<int>(extent.y() / cell_size_) + 1;

  starts_.assign(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_) + 1, 0);
  std::vector<std::uint32_t> cell_of_point(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Cell cell = cellOf(points(0, n), points(1, n));
    const auto row = static_cast<std::uint32_t>(std::clamp(cell.row, 0, rows_ - 1));
    const auto col = static_cast<std::uint32_t>(std::clamp(cell.col, 0, cols_ - 1));
    cell_of_point[static_cast<std::size_t>(n)] = row * static_cast<std::uint32_t>(cols_) + col;
    ++starts_[cell_of_point[static_cast<std::size_t>(n)]];
  }
  // Ends of the cells first; filling from behind turns them into starts and keeps the order within a cell.
  for (std::size_t cell = 1; cell < starts_.size(); ++cell) starts_[cell] += starts_[cell - 1];
  sorted_.resize(3, points.cols());
  index_.resize(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index n = points.cols() - 1; n >= 0; --n) {
    const std::uint32_t position = --starts_[cell_of_point[static_cast<std::size_t>(n)]];
    sorted_.col(position) = points.col(n);
    index_[position] = n;
  }
}

ColumnNeighbours::Cell ColumnNeighbours::cellOf(float x, float y) const {
  static constexpr float FAR = 1e6F;  // beyond any grid, within an int
  const auto cell = [this](float coordinate, float origin) {
    const float place = std::clamp((coordinate - origin) / cell_size_, -FAR, FAR);
    const int towards_zero = static_cast<int>(place);
    return towards_zero - (static_cast<float>(towards_zero) > place ? 1 : 0);
  };
  return {cell(x, origin_.x()), cell(y, origin_.y())};
}

/// Columns of a row lie one behind the other, so their points are a single run.
void ColumnNeighbours::searchRow(int row, int first, int last, const Eigen::Vector3f& query,
                                 Found& best) const {
  first = std::max(first, 0);
  last = std::min(last, cols_ - 1);
  if (row < 0 || row >= rows_ || first > last) return;
  const std::size_t start = static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_);
  const std::size_t end = starts_[start + static_cast<std::size_t>(last) + 1];
  for (std::size_t n = starts_[start + static_cast<std::size_t>(first)]; n < end; ++n) {
    const float distance = (sorted_.col(static_cast<Eigen::Index>(n)) - query).squaredNorm();
    if (distance < best.squared_distance) best = {distance, n};
  }
}

void ColumnNeighbours::searchColumn(int col, int first, int last, const Eigen::Vector3f& query,
                                    Found& best) const {
  if (col < 0 || col >= cols_) return;
  for (int row = std::max(0, first); row <= std::min(rows_ - 1, last); ++row)
    searchRow(row, col, col, query, best);
}

/// Searches those sides of a ring that may hold a nearer point. \return false if none of them may
bool ColumnNeighbours::searchRing(const Cell& centre, int ring, const Eigen::Vector3f& query,
                                  Found& best) const {
  const Eigen::Array2f low =
      query.head<2>().array() - origin_ -
      cell_size_ * Eigen::Array2f(static_cast<float>(centre.row), static_cast<float>(centre.col));
  const Eigen::Array2f high = cell_size_ - low;
  bool searched = false;
  const auto searchIfNear = [&](float to_side, const auto& search_side) {
    const float distance = to_side + static_cast<float>(ring - 1) * cell_size_;
    if (distance > 0 && distance * distance >= best.squared_distance) return;
    search_side();
    searched = true;
  };
  const auto searchWholeRow = [&](int row) {
    searchRow(row, centre.col - ring, centre.col + ring, query, best);
  };
  const auto searchBetweenRows = [&](int col) {
    searchColumn(col, centre.row - ring + 1, centre.row + ring - 1, query, best);
  };
  searchIfNear(low.x(), [&] { searchWholeRow(centre.row - ring); });
  if (ring == 0) return true;
  searchIfNear(high.x(), [&] { searchWholeRow(centre.row + ring); });
  searchIfNear(low.y(), [&] { searchBetweenRows(centre.col - ring); });
  searchIfNear(high.y(), [&] { searchBetweenRows(centre.col + ring); });
  return searched;
}

Neighbour ColumnNeighbours::nearest(const Eigen::Vector3f& query, float reach) const {
  const Cell centre = cellOf(query.x(), query.y());
  const std::size_t none = index_.size();
  Found best{std::nextafter(reach * reach, std::numeric_limits<float>::max()), none};
  for (int ring = firstRing(centre); searchRing(centre, ring, query, best); ++ring)
    if (reachesAround(centre, ring)) break;
  if (best.position == none) return {};
  return {index_[best.position], best.squared_distance};
}

void ColumnNeighbours::within(const Eigen::Vector3f& query, float radius,
                              std::vector<Eigen::Index>& found) const {
  found.clear();
  const Cell low = cellOf(query.x() - radius, query.y() - radius);
  const Cell high = cellOf(query.x() + radius, query.y() + radius);
  const int first = std::max(low.col, 0);
  const int last = std::min(high.col, cols_ - 1);
  if (first > last) return;
  for (int row = std::max(low.row, 0); row <= std::min(high.row, rows_ - 1); ++row) {
    const std::size_t start = static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_);
    const std::size_t end = starts_[start + static_cast<std::size_t>(last) + 1];
    for (std::size_t n = starts_[start + static_cast<std::size_t>(first)]; n < end; ++n)
      if ((sorted_.col(static_cast<Eigen::Index>(n)) - query).squaredNorm() <= radius * radius)
        found.push_back(index_[n]);
  }
}

}  // namespace

std::unique_ptr<NearestNeighbours> columnNeighbours(const PointsView& points, double spacing) {
  return std::make_unique<ColumnNeighbours>(points, spacing);
}

}  // namespace pcl_fft_ground::core
