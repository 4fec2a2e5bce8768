#include "ground/robust_breaks.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "grid/openings.h"
#include "ground/robust_regions.h"
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
  Rim of(const Region& region, const Mask& chosen, const Mask& cores) {
    ++number_;
    for (const Eigen::Index cell : region.cells) member_.data()[cell] = number_;
    Pairs pairs;
    Rim rim;
    for (const Eigen::Index cell : region.cells) {
      rim.broad = rim.broad || cores.data()[cell];
      if (!chosen.data()[cell]) continue;
      rim.area += 1;
      rim.border += isAtBorder(cell) ? 1 : 0;
      lookAround(cell, pairs);
    }
    rim.length = region.length * cell_;
    rim.area *= cell_ * cell_;
    rim.border *= cell_;
    rim.gentle = pairs.gentle / std::max(pairs.ground, 1.0);
    rim.higher = pairs.higher / std::max(pairs.all, 1.0);
    return rim;
  }

 private:
  struct Pairs {
    double all = 0, ground = 0, gentle = 0, higher = 0;
  };

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

  void lookAround(Eigen::Index cell, Pairs& pairs) const {
    const Eigen::Index rows = ground_.rows(), cols = ground_.cols(), reach = land_.reach();
    const Eigen::Index row = cell % rows, col = cell / rows;
    for (Eigen::Index j = std::max<Eigen::Index>(col - reach, 0); j <= std::min(col + reach, cols - 1); ++j)
      for (Eigen::Index i = std::max<Eigen::Index>(row - reach, 0); i <= std::min(row + reach, rows - 1);
           ++i) {
        const Eigen::Index other = i + j * rows;
        if (member_.data()[other] == number_ || !land_.isObserved(other)) continue;
        const Eigen::Vector3d offset = land_.point(other) - land_.point(cell);
        const double climb = WAY_IN * offset.head<2>().norm();
        ++pairs.all;
        if (ground_.data()[other]) {
          ++pairs.ground;
          if (std::abs(offset.z()) <= climb + 0.25 * least_height_) ++pairs.gentle;
        } else if (offset.z() > climb + least_height_) {
          ++pairs.higher;
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

}  // namespace

AboveBreaks groundAboveBreaks(const CellMap& land, const ElevationGrid& elevation, const Mask& ground,
                              const RobustPlan& plan, const std::optional<double>& max_slope) {
  constexpr float GENTLE = 0.15F, PROOF = 0.3F, BROKEN = 0.4F;  // slopes
  const double largest_object = plan.max_object_size;
  const Mask& observed = elevation.observed;
  const Mask above = observed && !ground, none = Mask::Constant(above.rows(), above.cols(), false);
  const bool is_known = max_slope || plan.land_breaks;
  if (!is_known && !anyLargeRegion(joined(above, observed), land.cells().cell_size / largest_object))
    return {none, false};

  const Eigen::ArrayXXf steepness =
      steepnessByOpenings(elevation, {largest_object, LEAST_HEIGHT * largest_object});
  Rims rims(land, ground, plan);
  const auto landUpTo = [&](float slope, bool (*judge)(const Rim&)) {
    const Mask chosen = above && steepness <= slope;
    const Mask filled = joined(chosen, observed);
    const Mask cores = eroded(filled, rims.breadth());
    Mask result = none;
    for (const Region& region : regionsOf(filled))
      if (judge(rims.of(region, chosen, cores)))
        for (const Eigen::Index cell : region.cells) result.data()[cell] = chosen.data()[cell];
    return result;
  };
  if (max_slope) return {landUpTo(static_cast<float>(*max_slope), isLand), true};
  const Mask proof = landUpTo(PROOF, provesABreak) || landUpTo(GENTLE, isNoObject);
  if (!plan.land_breaks && !proof.any()) return {none, false};
  return {proof || landUpTo(BROKEN, isLand), true};
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
