#include "pcl_fft_ground/core/tiles/tile_ground.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "ground/robust_breaks.h"

namespace pcl_fft_ground::core {
namespace {

/// Neighbouring surfaces go over into one another within this share of the margin on either side of a border.
constexpr double BLENDED = 0.25;
/// Cells around a tile that interpolation within it asks for.
constexpr Eigen::Index RING = 2;

Eigen::Index blendWidth(const Tiling& tiling) {
  return std::max<Eigen::Index>(
      1, static_cast<Eigen::Index>(std::floor(BLENDED * static_cast<double>(tiling.margin()))));
}

template <typename Array>
void crop(Array& values, const CellWindow& from, const CellWindow& to) {
  if (values.size() == 0) return;
  values = Array(values.block(to.row - from.row, to.col - from.col, to.rows, to.cols));
}

/// The parts of a ground that lie in a smaller window.
void crop(RobustGround& ground, const CellWindow& from, const CellWindow& to, const GridGeometry& geometry) {
  ground.elevation.geometry = ground.surface.geometry = geometry;
  crop(ground.elevation.elevation, from, to);
  crop(ground.elevation.observed, from, to);
  crop(ground.surface.height, from, to);
  crop(ground.surface.supported, from, to);
  crop(ground.surface.uncertainty, from, to);
  crop(ground.lowest, from, to);
  crop(ground.steps, from, to);
}

/// A ground of empty cells.
RobustGround emptyGround(const GridGeometry& cells) {
  RobustGround ground;
  ground.elevation = {cells, Eigen::ArrayXXd::Zero(cells.rows, cells.cols),
                      Mask::Constant(cells.rows, cells.cols, false)};
  ground.surface.geometry = cells;
  ground.surface.height = ground.surface.uncertainty = ground.elevation.elevation;
  ground.surface.supported = ground.elevation.observed;
  ground.lowest = ground.steps = Eigen::ArrayXXf::Zero(cells.rows, cells.cols);
  return ground;
}

bool hasPoints(const TileGround& tile) {
  return tile.ground.scale > 0 || tile.ground.elevation.observed.any();
}

/// Weight of a tile along an axis: 1 within, 1/2 at its border, 0 beyond; 1 up to the border of the site.
double weightAlong(Eigen::Index cell, Eigen::Index begin, Eigen::Index end, Eigen::Index site,
                   Eigen::Index width) {
  const auto ramp = [&](Eigen::Index inside) {  // of the cell's centre, from the border
    const double t = 0.5 + (static_cast<double>(inside) + 0.5) / (2 * static_cast<double>(width));
    const double u = std::clamp(t, 0.0, 1.0);
    return u * u * (3 - 2 * u);
  };
  const double low = begin == 0 ? 1 : ramp(cell - begin);
  const double high = end == site ? 1 : ramp(end - 1 - cell);
  return low * high;
}

/// Weights of a tile in the cells of a window.
Eigen::ArrayXXd weightsIn(const CellWindow& window, const CellWindow& core, const Tiling& tiling) {
  const Eigen::Index width = blendWidth(tiling);
  Eigen::ArrayXd along(window.rows), across(window.cols);
  for (Eigen::Index i = 0; i < window.rows; ++i)
    along[i] = weightAlong(window.row + i, core.row, core.row + core.rows, tiling.site().rows, width);
  for (Eigen::Index j = 0; j < window.cols; ++j)
    across[j] = weightAlong(window.col + j, core.col, core.col + core.cols, tiling.site().cols, width);
  return (along.matrix() * across.matrix().transpose()).array();
}

/// The cells that two windows have in common; none where they have none.
CellWindow common(const CellWindow& a, const CellWindow& b) {
  const Eigen::Index row = std::max(a.row, b.row), col = std::max(a.col, b.col);
  return {row, col, std::max<Eigen::Index>(std::min(a.row + a.rows, b.row + b.rows) - row, 0),
          std::max<Eigen::Index>(std::min(a.col + a.cols, b.col + b.cols) - col, 0)};
}

/// Sums of values over the tiles, each weighted.
class Blend {
 public:
  explicit Blend(const CellWindow& window)
      : window_(window),
        weights(Eigen::ArrayXXd::Zero(window.rows, window.cols)),
        heights(weights),
        uncertainties(weights),
        lowest(weights) {}

  void add(const TileGround& tile, const Eigen::ArrayXXd& weight, const CellWindow& shared) {
    const auto to = [&](Eigen::ArrayXXd& sums) {
      return sums.block(shared.row - window_.row, shared.col - window_.col, shared.rows, shared.cols);
    };
    const auto from = [&](const auto& values) {
      return values
          .block(shared.row - tile.window.row, shared.col - tile.window.col, shared.rows, shared.cols)
          .template cast<double>();
    };
    const GroundSurface& surface = tile.ground.surface;
    to(weights) += weight;
    to(heights) += weight * from(surface.height);
    to(uncertainties) += weight * from(surface.uncertainty);
    to(lowest) += weight * (from(surface.height) + from(tile.ground.lowest));
  }

 private:
  CellWindow window_;

 public:
  Eigen::ArrayXXd weights, heights, uncertainties, lowest;
};

/// What cannot be blended is that of the tile to which a cell belongs.
void takeOwn(const TileGround& tile, const CellWindow& own, TileGround& result) {
  const auto copy = [&](auto& to, const auto& from) {
    to.block(own.row - result.window.row, own.col - result.window.col, own.rows, own.cols) =
        from.block(own.row - tile.window.row, own.col - tile.window.col, own.rows, own.cols);
  };
  copy(result.ground.elevation.elevation, tile.ground.elevation.elevation);
  copy(result.ground.elevation.observed, tile.ground.elevation.observed);
  copy(result.ground.surface.supported, tile.ground.surface.supported);
  copy(result.ground.steps, tile.ground.steps);
}

void moveBy(Eigen::Index rows, Eigen::Index cols, StandingRegion& region) {
  region.low_row += rows, region.high_row += rows, region.low_col += cols, region.high_col += cols;
  for (auto& [row, col] : region.seam) row += rows, col += cols;
}

void add(const StandingRegion& part, StandingRegion& whole) {
  whole.low_row = std::min(whole.low_row, part.low_row),
  whole.low_col = std::min(whole.low_col, part.low_col);
  whole.high_row = std::max(whole.high_row, part.high_row);
  whole.high_col = std::max(whole.high_col, part.high_col);
  whole.area += part.area, whole.border += part.border, whole.pairs += part.pairs;
  whole.ground_pairs += part.ground_pairs, whole.gentle_pairs += part.gentle_pairs;
  whole.higher_pairs += part.higher_pairs;
  whole.broad = whole.broad || part.broad;
}

/// The first of the parts that are one with a part, each part knowing one before it.
std::size_t firstOf(std::vector<std::size_t>& before, std::size_t part) {
  while (before[part] != part) part = before[part] = before[before[part]];
  return part;
}

/// Which parts of regions touch over a seam: for each the first of those that are one with it.
std::vector<std::size_t> joinedParts(const std::vector<StandingRegion>& parts) {
  std::vector<std::size_t> before(parts.size());
  std::iota(before.begin(), before.end(), std::size_t{0});
  std::map<std::tuple<BreakSlope, Eigen::Index, Eigen::Index>, std::size_t> at;
  for (std::size_t n = 0; n < parts.size(); ++n)
    for (const auto& [row, col] : parts[n].seam) {
      for (Eigen::Index j = col - 1; j <= col + 1; ++j)
        for (Eigen::Index i = row - 1; i <= row + 1; ++i) {
          const auto other = at.find({parts[n].slope, i, j});
          if (other == at.end()) continue;
          const std::size_t a = firstOf(before, n), b = firstOf(before, other->second);
          before[std::max(a, b)] = std::min(a, b);
        }
      at.emplace(std::make_tuple(parts[n].slope, row, col), n);
    }
  for (std::size_t n = 0; n < parts.size(); ++n) before[n] = firstOf(before, n);
  return before;
}

}  // namespace

SiteBreaks breaksOf(const RobustPlan& plan, const std::vector<StandingRegion>& standing) {
  const std::vector<std::size_t> first = joinedParts(standing);
  std::vector<StandingRegion> wholes = standing;
  for (std::size_t n = 0; n < standing.size(); ++n)
    if (first[n] != n) add(standing[n], wholes[first[n]]);
  SiteBreaks breaks;
  for (std::size_t n = 0; n < standing.size(); ++n) {
    const bool is_land = isLand(wholes[first[n]], plan.cells.cell_size / plan.max_object_size);
    if (is_land && standing[n].slope != BreakSlope::BROKEN) breaks.land_breaks = true;
    if (is_land != standing[n].is_land && !standing[n].seam.empty())
      breaks.verdicts.push_back(
          {standing[n].slope, standing[n].seam.front().first, standing[n].seam.front().second, is_land});
  }
  return breaks;
}

bool contradicts(const TileGround& tile, const SiteBreaks& breaks, const Tiling& tiling, std::size_t number) {
  if (tile.ground.land_breaks != breaks.land_breaks) return true;
  const CellWindow seen = tiling.grown(tiling.core(number), blendWidth(tiling) + RING);
  return breaks.land_breaks &&
         std::any_of(breaks.verdicts.begin(), breaks.verdicts.end(),
                     [&](const BreakVerdict& verdict) { return seen.contains(verdict.row, verdict.col); });
}

RobustPlan withBreaks(RobustPlan plan, const SiteBreaks& breaks) {
  plan.land_breaks = breaks.land_breaks;
  plan.verdicts = breaks.verdicts;
  return plan;
}

Tiling tilingOf(const RobustPlan& plan, double tile_size) {
  return {plan.cells, tile_size, TILE_MARGIN * std::max(plan.max_object_size, plan.finest_wavelength)};
}

TileGround fitTile(const PointsView& points, const Eigen::Isometry3d& frame_from_input,
                   const RobustPlan& plan, const RobustParameters& parameters, const Tiling& tiling,
                   std::size_t tile) {
  const CellWindow seen = tiling.seen(tile);
  RobustPlan of_tile = plan;
  of_tile.cells = tiling.geometryOf(seen);
  for (BreakVerdict& verdict : of_tile.verdicts) verdict.row -= seen.row, verdict.col -= seen.col;
  const CellWindow core = tiling.core(tile);
  of_tile.own = CellBlock{core.row - seen.row, core.col - seen.col, core.rows, core.cols};
  TileGround result{tiling.grown(tiling.core(tile), blendWidth(tiling) + RING), {}};
  result.ground = points.cols() > 0 ? fitRobustGround(points, frame_from_input, of_tile, parameters)
                                    : emptyGround(of_tile.cells);
  result.ground.surface.frame_from_input = frame_from_input;
  result.ground.land_breaks = plan.land_breaks.value_or(result.ground.land_breaks);
  for (StandingRegion& region : result.ground.standing) moveBy(seen.row, seen.col, region);
  crop(result.ground, seen, result.window, tiling.geometryOf(result.window));
  return result;
}

std::vector<std::size_t> blendedTiles(const Tiling& tiling, std::size_t tile) {
  return tiling.tilesIn(tiling.grown(tiling.core(tile), blendWidth(tiling) + RING));
}

TileGround blendedGround(const Tiling& tiling, std::size_t tile, const std::vector<TileGround>& grounds) {
  const std::vector<std::size_t> tiles = blendedTiles(tiling, tile);
  TileGround result{tiling.grown(tiling.core(tile), RING), {}};
  result.ground = emptyGround(tiling.geometryOf(result.window));
  Blend blend(result.window);
  for (std::size_t n = 0; n < tiles.size(); ++n) {
    const TileGround& other = grounds[n];
    const CellWindow core = tiling.core(tiles[n]);
    takeOwn(other, common(core, result.window), result);
    if (tiles[n] == tile) {
      result.ground.surface.frame_from_input = other.ground.surface.frame_from_input;
      result.ground.scale = other.ground.scale;
    }
    const CellWindow shared = common(other.window, result.window);
    if (hasPoints(other) && shared.rows > 0 && shared.cols > 0)
      blend.add(other, weightsIn(shared, core, tiling), shared);
  }
  const Eigen::ArrayXXd per_weight = (blend.weights > 0).select(blend.weights.inverse(), 0.0);
  result.ground.surface.height = blend.heights * per_weight;
  result.ground.surface.uncertainty = blend.uncertainties * per_weight;
  result.ground.lowest =
      result.ground.elevation.observed.select(blend.lowest * per_weight - result.ground.surface.height, 0.0)
          .cast<float>();
  return result;
}

TileSpread spreadOf(const TileGround& tile, const CellWindow& core) {
  return {tile.ground.scale,
          tile.ground.elevation.observed
              .block(core.row - tile.window.row, core.col - tile.window.col, core.rows, core.cols)
              .count()};
}

double siteSpread(std::vector<TileSpread> tiles) {
  std::sort(tiles.begin(), tiles.end(),
            [](const TileSpread& a, const TileSpread& b) { return a.scale < b.scale; });
  Eigen::Index all = 0, below = 0;
  for (const TileSpread& tile : tiles) all += tile.observed;
  for (const TileSpread& tile : tiles) {
    below += tile.observed;
    if (2 * below >= all && tile.observed > 0) return tile.scale;
  }
  return 0;
}

}  // namespace pcl_fft_ground::core
