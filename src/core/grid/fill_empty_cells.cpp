#include <cstdint>
#include <vector>

#include "pcl_fft_ground/core/grid/elevation_grid.h"

namespace pcl_fft_ground::core {
namespace {

using RowIndex = std::int32_t;
using NearestRows = Eigen::Array<RowIndex, Eigen::Dynamic, Eigen::Dynamic>;
constexpr RowIndex NONE = -1;

/// For every cell the row of the nearest observed cell in its own column, NONE for a column without any.
NearestRows nearestRowsInColumns(const Mask& observed) {
  NearestRows nearest(observed.rows(), observed.cols());
  const auto rows = static_cast<RowIndex>(observed.rows());
  for (Eigen::Index j = 0; j < observed.cols(); ++j) {
    RowIndex above = NONE;
    for (RowIndex i = 0; i < rows; ++i) nearest(i, j) = above = observed(i, j) ? i : above;
    RowIndex below = NONE;
    for (RowIndex i = rows - 1; i >= 0; --i) {
      if (observed(i, j)) below = i;
      const bool below_is_nearer = nearest(i, j) == NONE || (below != NONE && below - i < i - nearest(i, j));
      if (below_is_nearer) nearest(i, j) = below;
    }
  }
  return nearest;
}

/// Holds the product of a squared and a plain distance along the longest grid: 1e8 cells in a line.
__extension__ using Wide = __int128;

/// A column and the squared distance of its nearest observed cell to the row at hand.
struct Parabola {
  std::int64_t column;
  std::int64_t height;

  std::int64_t at(std::int64_t j) const { return (j - column) * (j - column) + height; }
};

/// True if b is nowhere the lowest of a, b, c (columns ascending), or only where it ties with a lower column.
bool isHidden(const Parabola& a, const Parabola& b, const Parabola& c) {
  // The lower branch leaves a for b where 2 j (b - a) > (b^2 + h_b) - (a^2 + h_a), and likewise b for c.
  const auto rise = [](const Parabola& p, const Parabola& q) {
    return Wide(q.column * q.column + q.height - p.column * p.column - p.height);
  };
  return rise(b, c) * (b.column - a.column) <= rise(a, b) * (c.column - b.column);
}

/// The parabolas that are the lowest somewhere, by column.
void lowerEnvelope(const NearestRows& nearest_rows, Eigen::Index row, std::vector<Parabola>& envelope) {
  envelope.clear();
  for (Eigen::Index j = 0; j < nearest_rows.cols(); ++j) {
    if (nearest_rows(row, j) == NONE) continue;
    const std::int64_t distance = nearest_rows(row, j) - row;
    const Parabola next{j, distance * distance};
    while (envelope.size() >= 2 && isHidden(envelope[envelope.size() - 2], envelope.back(), next))
      envelope.pop_back();
    envelope.push_back(next);
  }
}

}  // namespace

void fillEmptyCells(Eigen::ArrayXXd& values, const Mask& observed) {
  if (observed.all() || !observed.any()) return;
  const NearestRows nearest_rows = nearestRowsInColumns(observed);
  std::vector<Parabola> envelope;
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    if (observed.row(i).all()) continue;
    lowerEnvelope(nearest_rows, i, envelope);
    std::size_t lowest = 0;
    for (Eigen::Index j = 0; j < values.cols(); ++j) {
      while (lowest + 1 < envelope.size() && envelope[lowest + 1].at(j) < envelope[lowest].at(j)) ++lowest;
      const std::int64_t column = envelope[lowest].column;
      if (!observed(i, j)) values(i, j) = values(nearest_rows(i, column), column);
    }
  }
}

}  // namespace pcl_fft_ground::core
