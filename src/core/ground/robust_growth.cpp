#include "ground/robust_steps.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "grid/morphology.h"
#include "pcl_fft_ground/core/scan/threads.h"

namespace pcl_fft_ground::core {
namespace {

// 3.5 leaks on to objects, 6 stalls.
constexpr double DISC_REACH = 4.5;    ///< radius of the ground looked at [distances between observed cells]
constexpr double STEEPEST = 2;        ///< what rises faster lies across a step [m/m]
constexpr double GENTLE = 0.5;        ///< where that finds a step too many, the ground is asked without [m/m]
constexpr double STEP_SPREADS = 6;    ///< the same, as far as noise goes
constexpr double ABOVE = 3;           ///< ground is no higher above what is expected [standard deviations]
constexpr double BELOW = 10;          ///< nor deeper below
constexpr double LIKELY_SLOPE = 3;    ///< prior: standard deviation of the slope [m/m]
constexpr int FEWEST = 6;             ///< cells of ground that a quadric needs
constexpr double LEAST_SHARE = 0.25;  ///< of ground in the disc: thin tongues are how objects leak
constexpr double LEAST_ACCEPTED =
    0.6;  ///< of a region's cells judged from outside: hills .68 to 1, objects up to .55

using Quadric = Eigen::Matrix<double, 6, 1>;
using Normal = Eigen::Matrix<double, 6, 6>;

/// For the columns of a disc about a cell, from the first one on, how far it reaches along them [cells].
std::vector<Eigen::Index> discOf(double radius) {
  std::vector<Eigen::Index> disc;
  const auto reach = static_cast<Eigen::Index>(radius);
  for (Eigen::Index j = -reach; j <= reach; ++j) {
    Eigen::Index i = 0;
    while (static_cast<double>((i + 1) * (i + 1) + j * j) <= radius * radius) ++i;
    disc.push_back(i);
  }
  return disc;
}

/// Sums of the terms of a quadric and of their products; uu and vv are halves of squares.
struct Moments {
  double u = 0, v = 0, uu = 0, uv = 0, vv = 0;
  double u_uu = 0, v_uu = 0, u_vv = 0, v_vv = 0;
  double uu_uu = 0, uu_uv = 0, uu_vv = 0, uv_vv = 0, vv_vv = 0;

  Normal products(double count) const {
    Normal m;
    m << count, u, v, uu, uv, vv,                         //
        u, 2 * uu, uv, u_uu, 2 * v_uu, u_vv,              //
        v, uv, 2 * vv, v_uu, 2 * u_vv, v_vv,              //
        uu, u_uu, v_uu, uu_uu, uu_uv, uu_vv,              //
        uv, 2 * v_uu, 2 * u_vv, uu_uv, 4 * uu_vv, uv_vv,  //
        vv, u_vv, v_vv, uu_vv, uv_vv, vv_vv;
    return m;
  }
};

/// Ground about a point, as sums for a quadric z = a + bu + cv + du2/2 + euv + fv2/2, u and v in cells.
struct Surroundings {
  Normal products = Normal::Zero();
  Quadric heights = Quadric::Zero();
  double squares = 0;
  int ground = 0, observed = 0;
};

/// How curved the land is and how its points spread.
struct Shape {
  double spread;     ///< [m]
  double curvature;  ///< [1/m]
};

class Land {
 public:
  Land(const CellMap& map, double spread)
      : map_(map),
        rows_(map.cells().rows),
        cols_(map.cells().cols),
        step_height_(STEP_SPREADS * spread),
        disc_(discOf(DISC_REACH / std::sqrt(map.density()))) {}

  /// visit(number, cell) of the observed cells in the disc about one, or in the square beside it.
  template <typename Visit>
  void around(Eigen::Index cell, const Visit& visit) const {
    const auto reach = static_cast<Eigen::Index>(disc_.size() / 2);
    visitColumns(
        cell, reach, [&](Eigen::Index j) { return disc_[static_cast<std::size_t>(j + reach)]; }, visit);
  }

  template <typename Visit>
  void beside(Eigen::Index cell, const Visit& visit) const {
    visitColumns(
        cell, map_.reach(), [&](Eigen::Index) { return map_.reach(); }, visit);
  }

  bool isAcrossAStep(const Eigen::Vector3d& offset, double steepest = STEEPEST) const {
    return std::abs(offset.z()) > steepest * offset.head<2>().lpNorm<1>() + step_height_;
  }

  Surroundings surroundingsOf(Eigen::Index cell, const Mask& ground, double steepest = STEEPEST) const {
    Surroundings result;
    Moments moments;
    const double per_cell = 1 / map_.cells().cell_size;
    const Eigen::Vector3d& centre = map_.point(cell);
    around(cell, [&](std::size_t number, Eigen::Index other) {
      ++result.observed;
      if (!ground.data()[other]) return;
      const Eigen::Vector3d offset = map_.pointOf(number) - centre;
      if (isAcrossAStep(offset, steepest)) return;
      ++result.ground;
      const double u = offset.x() * per_cell, v = offset.y() * per_cell, z = offset.z();
      const double uu = 0.5 * u * u, uv = u * v, vv = 0.5 * v * v;
      moments.u += u, moments.v += v, moments.uu += uu, moments.uv += uv, moments.vv += vv;
      moments.u_uu += u * uu, moments.v_uu += v * uu, moments.u_vv += u * vv, moments.v_vv += v * vv;
      moments.uu_uu += uu * uu, moments.uu_uv += uu * uv, moments.uu_vv += uu * vv;
      moments.uv_vv += uv * vv, moments.vv_vv += vv * vv;
      Quadric terms;
      terms << 1, u, v, uu, uv, vv;
      result.heights += z * terms;
      result.squares += z * z;
    });
    result.products = moments.products(result.ground);
    return result;
  }

  /// True if all of the observed cells around one are ground, and so many of them.
  bool isAmidGround(Eigen::Index cell, const Mask& ground, double fewest) const {
    double count = 0;
    bool all = true;
    around(cell, [&](std::size_t, Eigen::Index other) {
      ++count;
      all = all && ground.data()[other];
    });
    return all && count >= fewest;
  }

  const CellMap& map() const { return map_; }
  Eigen::Index discSize() const {
    return std::accumulate(disc_.begin(), disc_.end(), Eigen::Index{0},
                           [](Eigen::Index sum, Eigen::Index reach) { return sum + 2 * reach + 1; });
  }

 private:
  /// Column by column, at most `reach` columns and along each reachAlong(offset) cells away.
  template <typename ReachAlong, typename Visit>
  void visitColumns(Eigen::Index cell, Eigen::Index reach, const ReachAlong& reachAlong,
                    const Visit& visit) const {
    const Eigen::Index row = cell % rows_, col = cell / rows_;
    for (Eigen::Index j = std::max(-reach, -col); j <= std::min(reach, cols_ - 1 - col); ++j) {
      const Eigen::Index along = reachAlong(j), first = (col + j) * rows_;
      map_.visitColumn(first + std::max<Eigen::Index>(row - along, 0),
                       first + std::min(row + along, rows_ - 1), visit);
    }
  }

  const CellMap& map_;
  Eigen::Index rows_, cols_;
  double step_height_;
  std::vector<Eigen::Index> disc_;
};

double quantile(std::vector<double>& values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// From places where all around is ground; none if there are hardly any.
std::optional<Shape> shapeOf(const Land& land, const Mask& ground, double spread, double largest_object) {
  constexpr Eigen::Index LOOKED_AT = 500;
  constexpr std::size_t FEWEST_PLACES = 10;
  constexpr double FILLED = 0.6, LEAST_CURVED = 1e-3, MOST_CURVED = 5, TYPICAL = 0.75, MORE_CURVED = 1.5;
  constexpr int FEWEST_CELLS = 10;
  std::vector<Eigen::Index> candidates;
  for (Eigen::Index n = 0; n < ground.size(); ++n)
    if (ground.data()[n]) candidates.push_back(n);
  const double fewest =
      std::max<double>(FEWEST_CELLS, FILLED * land.map().density() * static_cast<double>(land.discSize()));
  const double per_cell2 = std::pow(land.map().cells().cell_size, -2);
  std::vector<double> misfits, curvatures;
  const std::size_t one_in = std::max<std::size_t>(candidates.size() / (4 * LOOKED_AT), 1);
  for (std::size_t n = 0; n < candidates.size() && misfits.size() < LOOKED_AT; n += one_in) {
    if (!land.isAmidGround(candidates[n], ground, fewest)) continue;
    const Surroundings all = land.surroundingsOf(candidates[n], ground);
    if (all.ground < all.observed || all.ground < fewest) continue;
    const Eigen::LDLT<Normal> solver(all.products + 1e-12 * all.products.trace() * Normal::Identity());
    const Quadric shape = solver.solve(all.heights);
    misfits.push_back(std::sqrt(std::max(0.0, all.squares - shape.dot(all.heights)) / all.ground));
    curvatures.push_back(per_cell2 *
                         std::sqrt(shape[3] * shape[3] + 2 * shape[4] * shape[4] + shape[5] * shape[5]));
  }
  if (misfits.size() < FEWEST_PLACES) return std::nullopt;
  return Shape{std::max(quantile(misfits, 0.5), 0.5 * spread),
               std::clamp(MORE_CURVED * quantile(curvatures, TYPICAL), LEAST_CURVED / largest_object,
                          MOST_CURVED / largest_object)};
}

enum class Verdict : unsigned char { UNDECIDED, GROUND, NO_GROUND };

/// Judges a cell by the ground around it that no more than this slope leads to.
Verdict judgeUpTo(double steepest, const Land& land, Eigen::Index cell, const Mask& ground,
                  const Shape& shape) {
  const Surroundings near = land.surroundingsOf(cell, ground, steepest);
  if (near.ground < FEWEST || near.ground < LEAST_SHARE * near.observed) return Verdict::UNDECIDED;
  const double variance = shape.spread * shape.spread;
  const double side = land.map().cells().cell_size;
  const double sloping = std::pow(LIKELY_SLOPE * side, -2);
  const double bent = std::pow(shape.curvature * side * side, -2);
  Quadric prior;
  prior << 0, sloping, sloping, bent, 2 * bent, bent;
  Normal information = near.products / variance;
  information.diagonal() += prior;
  const Eigen::LDLT<Normal> solver(information);
  const Quadric first = solver.solve(Quadric::Unit(0));  // of the covariance
  const double expected = first.dot(near.heights) / variance;
  const double deviation = std::sqrt(std::max(0.0, first[0]) + variance);
  return -expected <= ABOVE * deviation && -expected >= -BELOW * deviation ? Verdict::GROUND
                                                                           : Verdict::NO_GROUND;
}

/// Beside a pit or a wall the ground across the step counts only where land is steep.
Verdict judge(const Land& land, Eigen::Index cell, const Mask& ground, const Shape& shape) {
  const Verdict verdict = judgeUpTo(STEEPEST, land, cell, ground, shape);
  const bool again =
      verdict == Verdict::NO_GROUND && judgeUpTo(GENTLE, land, cell, ground, shape) == Verdict::GROUND;
  return again ? Verdict::GROUND : verdict;
}

/// Keeps the regions that follow from the ground around them.
Mask followingRegions(const Mask& gained, const std::vector<Verdict>& first, const Mask& observed) {
  const Mask filled = joined(gained, observed);
  const Mask cores = eroded(filled, 1);
  Mask kept = Mask::Constant(gained.rows(), gained.cols(), false);
  for (const Region& region : regionsOf(filled)) {
    double decided = 0, accepted = 0;
    bool broad = false;
    for (const Eigen::Index cell : region.cells) {
      const Verdict verdict = first[static_cast<std::size_t>(cell)];
      broad = broad || cores.data()[cell];
      if (!gained.data()[cell]) continue;
      if (verdict != Verdict::UNDECIDED) ++decided;
      if (verdict == Verdict::GROUND) ++accepted;
    }
    if (!broad || accepted < LEAST_ACCEPTED * decided) continue;
    for (const Eigen::Index cell : region.cells) kept.data()[cell] = gained.data()[cell];
  }
  return kept;
}

}  // namespace

Mask continuedGround(const CellMap& map, const Mask& ground, double spread, double largest_object) {
  constexpr Eigen::Index CELLS_AT_A_TIME = 256;
  const Land land(map, spread);
  Mask gained = Mask::Constant(ground.rows(), ground.cols(), false);
  const std::optional<Shape> shape = shapeOf(land, ground, spread, largest_object);
  if (!shape) return gained;

  std::vector<Verdict> first(static_cast<std::size_t>(ground.size()), Verdict::UNDECIDED);
  Mask all = ground, asked = gained;
  std::vector<Eigen::Index> fresh, open;
  std::vector<Verdict> verdicts;
  for (Eigen::Index n = 0; n < ground.size(); ++n)
    if (ground.data()[n]) fresh.push_back(n);
  for (int round = 0; !fresh.empty(); ++round) {
    open.clear();
    const auto ask = [&](std::size_t number, Eigen::Index cell) {
      if (all.data()[cell] || asked.data()[cell]) return;
      bool reachable = false;
      land.beside(cell, [&](std::size_t beside, Eigen::Index other) {
        reachable = reachable ||
                    (all.data()[other] && !land.isAcrossAStep(map.pointOf(beside) - map.pointOf(number)));
      });
      if (!reachable) return;
      asked.data()[cell] = true;
      open.push_back(cell);
    };
    for (const Eigen::Index cell : fresh)
      if (round == 0)
        land.beside(cell, ask);
      else
        land.around(cell, ask);
    fresh.clear();
    verdicts.resize(open.size());
    forEachRange(static_cast<Eigen::Index>(open.size()), CELLS_AT_A_TIME,
                 [&](Eigen::Index begin, Eigen::Index end) {
                   for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
                     verdicts[n] = judge(land, open[n], all, *shape);
                 });
    for (std::size_t n = 0; n < open.size(); ++n) {
      if (round == 0) first[static_cast<std::size_t>(open[n])] = verdicts[n];
      if (verdicts[n] == Verdict::GROUND) fresh.push_back(open[n]);
    }
    for (const Eigen::Index cell : open) asked.data()[cell] = false;
    for (const Eigen::Index cell : fresh) all.data()[cell] = gained.data()[cell] = true;
  }
  Mask observed(ground.rows(), ground.cols());
  for (Eigen::Index n = 0; n < observed.size(); ++n) observed.data()[n] = map.isObserved(n);
  return followingRegions(gained, first, observed);
}

}  // namespace pcl_fft_ground::core
