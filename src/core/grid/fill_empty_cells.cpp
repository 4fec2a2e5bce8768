#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "grid/distances.h"

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
/// Shorter grids do with 64 bits.
constexpr Eigen::Index LONGEST_FOR_64_BITS = 1 << 20;

/// A column and the squared distance of its nearest observed cell to the row at hand.
struct Parabola {
  std::int64_t column;
  std::int64_t height;

  std::int64_t at(std::int64_t j) const { return (j - column) * (j - column) + height; }
};

/// True if b is nowhere the lowest of a, b, c (columns ascending), or only where it ties with a lower column.
template <typename Product>
bool isHidden(const Parabola& a, const Parabola& b, const Parabola& c) {
  // The lower branch leaves a for b where 2 j (b - a) > (b^2 + h_b) - (a^2 + h_a), and likewise b for c.
  const auto rise = [](const Parabola& p, const Parabola& q) {
    return Product(q.column * q.column + q.height - p.column * p.column - p.height);
  };
  return rise(b, c) * (b.column - a.column) <= rise(a, b) * (c.column - b.column);
}

/// The parabolas that are the lowest somewhere, by column.
template <typename Product>
void lowerEnvelope(const NearestRows& nearest_rows, Eigen::Index row, std::vector<Parabola>& envelope) {
  envelope.clear();
  for (Eigen::Index j = 0; j < nearest_rows.cols(); ++j) {
    if (nearest_rows(row, j) == NONE) continue;
    const std::int64_t distance = nearest_rows(row, j) - row;
    const Parabola next{j, distance * distance};
    while (envelope.size() >= 2 && isHidden<Product>(envelope[envelope.size() - 2], envelope.back(), next))
      envelope.pop_back();
    envelope.push_back(next);
  }
}

/// Calls visit(row, column, parabola of the nearest observed cell) for all cells, row by row. Some are
/// observed.
template <typename Visit>
void forEachNearest(const NearestRows& nearest_rows, const Visit& visit) {
  const bool is_short = std::max(nearest_rows.rows(), nearest_rows.cols()) <= LONGEST_FOR_64_BITS;
  std::vector<Parabola> envelope;
  for (Eigen::Index i = 0; i < nearest_rows.rows(); ++i) {
    if (is_short)
      lowerEnvelope<std::int64_t>(nearest_rows, i, envelope);
    else
      lowerEnvelope<Wide>(nearest_rows, i, envelope);
    const Parabola* lowest = envelope.data();
    const Parabola* const last = lowest + envelope.size() - 1;
    for (Eigen::Index j = 0; j < nearest_rows.cols(); ++j) {
      while (lowest < last && lowest[1].at(j) < lowest->at(j)) ++lowest;
      visit(i, j, *lowest);
    }
  }
}

}  // namespace

void fillEmptyCells(Eigen::ArrayXXd& values, const Mask& observed) {
  if (observed.all() || !observed.any()) return;
  const NearestRows nearest_rows = nearestRowsInColumns(observed);
  forEachNearest(nearest_rows, [&](Eigen::Index i, Eigen::Index j, const Parabola& nearest) {
    if (nearest.column != j || nearest.height != 0)
      values(i, j) = values(nearest_rows(i, nearest.column), nearest.column);
  });
}

Eigen::ArrayXXd distancesFrom(const Mask& chosen) {
  Eigen::ArrayXXd distances = Eigen::ArrayXXd::Zero(chosen.rows(), chosen.cols());
  if (chosen.all() || !chosen.any()) return distances;
  forEachNearest(nearestRowsInColumns(chosen), [&](Eigen::Index i, Eigen::Index j, const Parabola& nearest) {
    distances(i, j) = std::sqrt(static_cast<double>(nearest.at(j)));
  });
  return distances;
}

}  // namespace pcl_fft_ground::core
