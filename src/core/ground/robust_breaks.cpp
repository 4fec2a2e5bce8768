#include "ground/robust_breaks.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include "grid/morphology.h"
#include "ground/robust_scale.h"
#include "scan/radix_sort.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double LEAST_HEIGHT = 0.01;  // of an object, as a share of the largest
constexpr double WAY_IN = 0.3;         // slope of a gentle rim

/// What lies around a region of cells that stand out of the ground.
struct Rim {
  double length = 0;   ///< of the region [largest objects]
  double area = 0;     ///< of the region [largest objects squared]
  double gentle = 0;   ///< share of the pairs with ground beside that climb gently
  double higher = 0;   ///< share of all pairs whose other cell, no ground, stands out of the region
  double border = 0;   ///< cells at the scan's border [largest objects]
  bool broad = false;  ///< holds a square of a fifth of the largest object
};

/// \param cell side of a cell [largest objects]
Rim rimOf(const StandingRegion& region, double cell) {
  const auto rows = static_cast<double>(region.high_row - region.low_row + 1),
             cols = static_cast<double>(region.high_col - region.low_col + 1);
  return {std::hypot(rows, cols) * cell,
          region.area * cell * cell,
          region.gentle_pairs / std::max(region.ground_pairs, 1.0),
          region.higher_pairs / std::max(region.pairs, 1.0),
          region.border * cell,
          region.broad};
}

class Rims {
 public:
  Rims(const CellMap& land, const Mask& ground, const RobustPlan& plan)
      : land_(land),
        ground_(ground),
        ends_(endsOf(land.cells(), plan.bounds)),
        cell_(land.cells().cell_size / plan.max_object_size),
        least_height_(LEAST_HEIGHT * plan.max_object_size),
        member_(Eigen::ArrayXXi::Zero(ground.rows(), ground.cols())) {}

  /// Half the side of the square that a broad region holds [cells].
  Eigen::Index breadth() const {
    constexpr double BREADTH = 0.2;
    return std::max<Eigen::Index>(static_cast<Eigen::Index>(std::round(0.5 * (BREADTH / cell_ - 1))), 0);
  }

  /// \param chosen the cells that joined() brought together
  /// \param cores what is broad enough of them
  StandingRegion of(const Region& region, const Mask& chosen, const Mask& cores) {
    return ofPart(region, chosen, cores, {0, 0, ground_.rows(), ground_.cols()});
  }

  /// Of those cells of the region that lie in a block of them.
  StandingRegion ofPart(const Region& region, const Mask& chosen, const Mask& cores, const CellBlock& block) {
    ++number_;
    for (const Eigen::Index cell : region.cells) member_.data()[cell] = number_;
    StandingRegion part;
    for (const Eigen::Index cell : region.cells) {
      const Eigen::Index i = cell % ground_.rows(), j = cell / ground_.rows();
      if (i < block.row || j < block.col || i >= block.row + block.rows || j >= block.col + block.cols)
        continue;
      include(i, j, part);
      part.broad = part.broad || cores.data()[cell];
      if (i == block.row || j == block.col || i + 1 == block.row + block.rows ||
          j + 1 == block.col + block.cols)
        part.seam.emplace_back(i, j);
      if (!chosen.data()[cell]) continue;
      part.area += 1;
      part.border += isAtBorder(cell) ? 1 : 0;
      lookAround(cell, part);
    }
    return part;
  }

 private:
  static void include(Eigen::Index i, Eigen::Index j, StandingRegion& part) {
    if (part.high_row < part.low_row) part.low_row = part.high_row = i, part.low_col = part.high_col = j;
    part.low_row = std::min(part.low_row, i), part.high_row = std::max(part.high_row, i);
    part.low_col = std::min(part.low_col, j), part.high_col = std::max(part.high_col, j);
  }

  /// On which sides the scan ends with the cells; on others it goes on, in another tile.
  struct Ends {
    bool low_row, high_row, low_col, high_col;
  };

  static Ends endsOf(const GridGeometry& cells, const Bounds& bounds) {
    const Eigen::Array2d first = bounds.low.head<2>() + 0.5 * cells.cell_size, last = bounds.high.head<2>();
    const Eigen::Array2d low = cells.origin;
    const Eigen::Array2d high =
        low +
        cells.cell_size * Eigen::Array2d(static_cast<double>(cells.rows), static_cast<double>(cells.cols)) +
        1e-6 * cells.cell_size;
    return {low.x() < first.x(), high.x() >= last.x(), low.y() < first.y(), high.y() >= last.y()};
  }

  bool isAtBorder(Eigen::Index cell) const {
    constexpr Eigen::Index OUTER = 2;
    const Eigen::Index rows = ground_.rows(), cols = ground_.cols(), i = cell % rows, j = cell / rows;
    return (ends_.low_row && i < OUTER) || (ends_.low_col && j < OUTER) ||
           (ends_.high_row && i >= rows - OUTER) || (ends_.high_col && j >= cols - OUTER);
  }

  void lookAround(Eigen::Index cell, StandingRegion& part) const {
    const Eigen::Index rows = ground_.rows(), cols = ground_.cols(), reach = land_.reach();
    const Eigen::Index row = cell % rows, col = cell / rows;
    for (Eigen::Index j = std::max<Eigen::Index>(col - reach, 0); j <= std::min(col + reach, cols - 1); ++j)
      for (Eigen::Index i = std::max<Eigen::Index>(row - reach, 0); i <= std::min(row + reach, rows - 1);
           ++i) {
        const Eigen::Index other = i + j * rows;
        if (member_.data()[other] == number_ || !land_.isObserved(other)) continue;
        const Eigen::Vector3d offset = land_.point(other) - land_.point(cell);
        const double climb = WAY_IN * offset.head<2>().norm();
        ++part.pairs;
        if (ground_.data()[other]) {
          ++part.ground_pairs;
          if (std::abs(offset.z()) <= climb + 0.25 * least_height_) ++part.gentle_pairs;
        } else if (offset.z() > climb + least_height_) {
          ++part.higher_pairs;
        }
      }
  }

  const CellMap& land_;
  const Mask& ground_;
  Ends ends_;
  double cell_, least_height_;
  Eigen::ArrayXXi member_;  // number of the region that was looked at last
  int number_ = 0;
};

/// Large enough to prove that the land breaks: hedges and rows of cars are not.
bool isLarge(double length, double area) {
  return length > 1.25 && area > 0.12;
}

/// Land, with certainty: nothing else is as large, has such a rim and carries things, or goes on beyond the
/// scan.
bool provesABreak(const Rim& rim) {
  const bool carries = rim.gentle > 0.2 && (rim.higher > 0.1 || rim.border > 0);
  const bool goes_on = rim.border > 0.3 && rim.higher > 0.5 && rim.gentle > 0.05;
  return isLarge(rim.length, rim.area) && (carries || goes_on);
}

/// Too large for an object and too broad for a wall, whatever its rim.
bool isNoObject(const Rim& rim) {
  return rim.length > 1.25 && rim.area >= 1 && rim.broad;
}

/// Land, where the land is known to break: it does so again in smaller pieces.
bool isLand(const Rim& rim) {
  return provesABreak(rim) || isNoObject(rim) || (rim.gentle > 0.2 && rim.area > 0.005 && rim.length > 0.2);
}

bool anyLargeRegion(const Mask& cells, double cell) {
  for (const Region& region : regionsOf(cells))
    if (isLarge(region.length * cell, static_cast<double>(region.cells.size()) * cell * cell)) return true;
  return false;
}

/// What is known of the regions of one slope by some of their cells.
class KnownVerdicts {
 public:
  KnownVerdicts(const std::vector<BreakVerdict>& verdicts, BreakSlope slope, Eigen::Index rows,
                Eigen::Index cols) {
    for (const BreakVerdict& verdict : verdicts)
      if (verdict.slope == slope && verdict.row >= 0 && verdict.col >= 0 && verdict.row < rows &&
          verdict.col < cols)
        by_cell_.emplace(verdict.row + verdict.col * rows, verdict.is_land);
  }

  std::optional<bool> of(const Region& region) const {
    if (by_cell_.empty()) return std::nullopt;
    for (const Eigen::Index cell : region.cells)
      if (const auto known = by_cell_.find(cell); known != by_cell_.end()) return known->second;
    return std::nullopt;
  }

 private:
  std::unordered_map<Eigen::Index, bool> by_cell_;
};

}  // namespace

AboveBreaks groundAboveBreaks(const CellMap& land, const ElevationGrid& elevation, const Mask& ground,
                              const RobustPlan& plan, const std::optional<double>& max_slope) {
  constexpr float GENTLE = 0.15F, PROOF = 0.3F, BROKEN = 0.4F;  // slopes
  const double largest_object = plan.max_object_size;
  const Mask& observed = elevation.observed;
  const Mask above = observed && !ground, none = Mask::Constant(above.rows(), above.cols(), false);
  if (!max_slope && plan.land_breaks == false) return {none, false, {}};
  const bool is_known = max_slope || plan.land_breaks;
  if (!is_known && !anyLargeRegion(joined(above, observed), land.cells().cell_size / largest_object))
    return {none, false, {}};

  const Eigen::ArrayXXf steepness =
      steepnessByOpenings(elevation, {largest_object, LEAST_HEIGHT * largest_object});
  Rims rims(land, ground, plan);
  const double cell = land.cells().cell_size / largest_object;
  std::vector<StandingRegion> standing;
  const auto landUpTo = [&](float steepest, bool (*judge)(const Rim&), BreakSlope slope) {
    const Mask chosen = above && steepness <= steepest;
    const Mask filled = joined(chosen, observed);
    const Mask cores = eroded(filled, rims.breadth());
    const KnownVerdicts known(plan.verdicts, slope, above.rows(), above.cols());
    Mask result = none;
    for (const Region& region : regionsOf(filled)) {
      const bool is_land = known.of(region).value_or(judge(rimOf(rims.of(region, chosen, cores), cell)));
      if (is_land)
        for (const Eigen::Index n : region.cells) result.data()[n] = chosen.data()[n];
      if (!plan.own || max_slope) continue;
      StandingRegion part = rims.ofPart(region, chosen, cores, *plan.own);
      if (part.high_row < part.low_row) continue;
      part.slope = slope;
      part.is_land = is_land;
      standing.push_back(std::move(part));
    }
    return result;
  };
  if (max_slope) return {landUpTo(static_cast<float>(*max_slope), isLand, BreakSlope::BROKEN), true, {}};
  const Mask proof =
      landUpTo(PROOF, provesABreak, BreakSlope::PROOF) || landUpTo(GENTLE, isNoObject, BreakSlope::GENTLE);
  const bool breaks = plan.land_breaks || proof.any();
  // A tile that proves nothing has a say in what is land should another one prove it.
  if (!breaks && !plan.own) return {none, false, {}};
  const Mask broken = landUpTo(BROKEN, isLand, BreakSlope::BROKEN);
  return {breaks ? proof || broken : none, breaks, std::move(standing)};
}

bool isLand(const StandingRegion& region, double cell) {
  const Rim rim = rimOf(region, cell);
  return region.slope == BreakSlope::PROOF    ? provesABreak(rim)
         : region.slope == BreakSlope::GENTLE ? isNoObject(rim)
                                              : isLand(rim);
}

void followGround(const CellMap& land, const Mask& ground, double spread, Eigen::ArrayXXd& surface) {
  constexpr double SPREADS = 3;
  // A cell's height is that of its lowest points, the surface lies amid them.
  std::vector<float> residuals;
  RadixSort sort;
  const auto residualOf = [&](Eigen::Index cell) { return land.point(cell).z() - surface.data()[cell]; };
  for (Eigen::Index n = 0; n < surface.size(); ++n)
    if (ground.data()[n] && std::abs(residualOf(n)) < 2 * SPREADS * spread)
      residuals.push_back(static_cast<float>(residualOf(n)));
  const double offset = medianSpread(residuals, sort).centre;
  for (Eigen::Index n = 0; n < surface.size(); ++n)
    if (ground.data()[n] && std::abs(residualOf(n) - offset) > SPREADS * spread)
      surface.data()[n] += residualOf(n) - offset;
}

Eigen::ArrayXXf stepsOfGround(const CellMap& land, const Mask& ground, const Eigen::ArrayXXd& surface) {
  constexpr double STEEPEST = 2;  // what rises faster is a step [m/m]
  const Eigen::Index rows = ground.rows(), cols = ground.cols(), reach = land.reach();
  Eigen::ArrayXXf steps = Eigen::ArrayXXf::Zero(rows, cols);
  for (Eigen::Index col = 0; col < cols; ++col)
    for (Eigen::Index row = 0; row < rows; ++row) {
      if (!ground(row, col)) continue;
      for (Eigen::Index j = std::max<Eigen::Index>(col - reach, 0); j <= std::min(col + reach, cols - 1); ++j)
        for (Eigen::Index i = std::max<Eigen::Index>(row - reach, 0); i <= std::min(row + reach, rows - 1);
             ++i) {
          if (!ground(i, j)) continue;
          const double distance = land.cells().cell_size * std::hypot(i - row, j - col);
          const double rise = surface(i, j) - surface(row, col);
          if (rise > STEEPEST * distance)
            steps(row, col) = std::max(steps(row, col), static_cast<float>(rise));
        }
    }
  return steps;
}

}  // namespace pcl_fft_ground::core
