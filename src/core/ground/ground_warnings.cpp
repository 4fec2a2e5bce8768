#include "pcl_fft_ground/core/ground/ground_warnings.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <sstream>

#include "grid/distances.h"
#include "pcl_fft_ground/core/scan/threads.h"

namespace pcl_fft_ground::core {
namespace {

// Of the scans with a total error of at most 4 % at the size of their largest object, the nearest to each
// bound is noted; bounds lie well apart from it.
constexpr double FEWEST_SPACINGS = 2;        // of the points in the largest object: 19 (mobile laser: 80)
constexpr double LEAST_FILLED = 0.1;         // of the bounding rectangle: 0.20 (a turn of a rotating laser)
constexpr double CELLS_TO_OBJECT = 8;        // of the cells with which that is measured
constexpr double PATCH = 1.25;               // of ground, in largest objects: 1.7 (a tile of less than two)
constexpr double LARGE_ENOUGH = 1.6;         // a scan in which a larger patch would fit, in largest objects
constexpr double LEAST_GROUND_CELLS = 0.25;  // of the cells with points: 0.33 (a town with yards)
constexpr double LITTLE_GROUND = 0.2, LITTLE_GROUND_CELLS = 0.45;  // of points and of cells, both: 0.29 and
                                                                   // 0.33 (that town), 0.13 and 0.62 (a room)
constexpr double WIDEST_SPREAD = 0.008;      // in largest objects: 0.0026 (a table, by a depth camera)
constexpr double MOST_WITHOUT_GROUND = 0.2;  // of the cells with points: 0.04 (a street between houses)
constexpr double MOST_HIDDEN = 0.05;         // of the points, without a size: 0.034 (sparse airborne laser)
constexpr double NOISE = 6;                  // spreads of the ground that explain a height

class Sentence {
 public:
  Sentence() { text_.precision(3); }
  template <typename T>
  Sentence& operator<<(const T& part) {
    text_ << part;
    return *this;
  }
  operator std::string() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

/// Which squares of a grid hold points.
struct Squares {
  Eigen::Index rows = 0, cols = 0;
  double side = 0;
  Mask occupied;

  double area() const { return static_cast<double>(occupied.count()) * side * side; }
};

/// From the cells that hold points; a square is no smaller than a cell.
Squares squaresOf(const Mask& cells, const GridGeometry& geometry, const Bounds& bounds, double least_side) {
  const double side = std::max(least_side, geometry.cell_size);
  const GridGeometry grid = gridAround(bounds, side);
  Squares squares{grid.rows, grid.cols, side, Mask::Constant(grid.rows, grid.cols, false)};
  const auto square = [&](Eigen::Index cell, Eigen::Index last) {  // in which the middle of a cell lies
    const double middle = (static_cast<double>(cell) + 0.5) * geometry.cell_size;
    return std::min(static_cast<Eigen::Index>(middle / side), last);
  };
  for (Eigen::Index j = 0; j < cells.cols(); ++j)
    for (Eigen::Index i = 0; i < cells.rows(); ++i)
      if (cells(i, j)) squares.occupied(square(i, grid.rows - 1), square(j, grid.cols - 1)) = true;
  return squares;
}

/// The longer side [m] of the largest patch of squares that touch.
double largestPatch(Squares squares) {
  Eigen::Index longest = 0;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> waiting;
  const auto visit = [&](Eigen::Index i, Eigen::Index j) {
    if (i < 0 || j < 0 || i >= squares.rows || j >= squares.cols || !squares.occupied(i, j)) return;
    squares.occupied(i, j) = false;
    waiting.emplace_back(i, j);
  };
  for (Eigen::Index j = 0; j < squares.cols; ++j)
    for (Eigen::Index i = 0; i < squares.rows; ++i) {
      Eigen::Index low_i = i, high_i = i, low_j = j, high_j = j;
      visit(i, j);
      while (!waiting.empty()) {
        const auto [k, l] = waiting.back();
        waiting.pop_back();
        low_i = std::min(low_i, k), high_i = std::max(high_i, k);
        low_j = std::min(low_j, l), high_j = std::max(high_j, l);
        longest = std::max({longest, high_i - low_i + 1, high_j - low_j + 1});
        for (Eigen::Index di = -1; di <= 1; ++di)
          for (Eigen::Index dj = -1; dj <= 1; ++dj) visit(k + di, l + dj);
      }
    }
  return static_cast<double>(longest) * squares.side;
}

/// The ground points and the cells that hold them.
struct GroundSeen {
  Eigen::Index points = 0;
  Mask cells;
};

GroundSeen groundSeen(const PointsView& points, const Labels& labels, const GridGeometry& cells) {
  std::vector<std::atomic<bool>> seen(static_cast<std::size_t>(cells.rows * cells.cols));
  const double per_metre = 1 / cells.cell_size, x = cells.origin.x(), y = cells.origin.y();
  const auto rows = static_cast<std::int32_t>(cells.rows), cols = static_cast<std::int32_t>(cells.cols);
  const auto counts =
      resultsOfRanges(points.cols(), POINTS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
        Eigen::Index count = 0;
        for (Eigen::Index n = begin; n < end; ++n) {
          if (labels[static_cast<std::size_t>(n)] != Label::GROUND) continue;
          ++count;
          const float* p = points.data() + 3 * n;
          const auto i = static_cast<std::int32_t>((static_cast<double>(p[0]) - x) * per_metre);
          const auto j = static_cast<std::int32_t>((static_cast<double>(p[1]) - y) * per_metre);
          const std::int32_t cell = std::clamp(i, 0, rows - 1) + std::clamp(j, 0, cols - 1) * rows;
          seen[static_cast<std::size_t>(cell)].store(true, std::memory_order_relaxed);
        }
        return count;
      });
  GroundSeen ground{std::accumulate(counts.begin(), counts.end(), Eigen::Index{0}),
                    Mask(cells.rows, cells.cols)};
  std::copy(seen.begin(), seen.end(), ground.cells.data());
  return ground;
}

/// Share of the cells with points that are farther from ground than a distance [m].
double shareWithoutGround(const Mask& observed, const Mask& ground, const GridGeometry& cells,
                          double distance) {
  if (!ground.any()) return 1;
  const Eigen::Index without = (observed && cells.cell_size * distancesFrom(ground) > distance).count();
  return static_cast<double>(without) / static_cast<double>(std::max<Eigen::Index>(observed.count(), 1));
}

/// The scan and what was found in it.
struct Findings {
  const RobustGround& ground;
  const PointsView& points;
  const Labels& labels;
  const RobustParameters& parameters;
  GroundSeen seen;
  double size = 0, widest = 0;  ///< of the largest object and of the scan [m]

  const GridGeometry& cells() const { return ground.elevation.geometry; }
  const Mask& observed() const { return ground.elevation.observed; }
};

using Warnings = std::vector<std::string>;

/// True where it has warned.
bool checkUnit(const Findings& found, Warnings& warnings) {
  const std::size_t before = warnings.size();
  const Eigen::Array3d sides = found.ground.bounds.high - found.ground.bounds.low;
  const bool given = found.parameters.max_object_size.has_value();
  if (given && found.size < FEWEST_SPACINGS * found.ground.spacing)
    warnings.push_back(Sentence() << "the largest object, " << found.size
                                  << " m, is not clearly larger than the distance of the points, "
                                  << found.ground.spacing
                                  << " m: are the coordinates in metres? see --max-object-size");
  constexpr double MUCH_HIGHER = 20;
  if (sides.z() > MUCH_HIGHER * found.widest)
    warnings.push_back(
        Sentence() << "the scan is " << sides.z() << " m high but only " << found.widest
                   << " m wide: are x and y in degrees, or another axis up? see --up-direction");
  return warnings.size() > before;
}

void checkCoverage(const Findings& found, Warnings& warnings) {
  const double side = std::max({found.size / CELLS_TO_OBJECT, found.ground.spacing, found.widest / 4000});
  const Squares squares = squaresOf(found.observed(), found.cells(), found.ground.bounds, side);
  const double filled = squares.occupied.cast<double>().mean();
  if (filled < LEAST_FILLED)
    warnings.push_back(Sentence() << "only " << 100 * filled
                                  << " % of the bounding rectangle holds points: the ground between them is "
                                     "guessed; segment the parts one by one");
}

/// True where it has warned: what is said of little ground is of no use then.
bool checkPatches(const Findings& found, Warnings& warnings) {
  if (found.widest < LARGE_ENOUGH * found.size || found.size > found.ground.extent) return false;
  const double side =
      std::max({found.size / CELLS_TO_OBJECT, 2.5 * found.ground.spacing, found.widest / 4000});
  const double patch = largestPatch(squaresOf(found.seen.cells, found.cells(), found.ground.bounds, side));
  if (patch >= PATCH * found.size) return false;
  warnings.push_back(
      Sentence() << "no ground is seen: what was taken for it lies in patches of at most " << patch
                 << " m, no larger than the largest object, " << found.size
                 << " m; if the ground was removed before, all points are objects; if not, see "
                    "--max-object-size");
  return true;
}

void checkAmount(const Findings& found, Warnings& warnings) {
  const Mask& observed = found.observed();
  const double of_points = static_cast<double>(found.seen.points) / static_cast<double>(found.points.cols());
  const double of_cells = static_cast<double>((observed && found.seen.cells).count()) /
                          static_cast<double>(std::max<Eigen::Index>(observed.count(), 1));
  const double spread = found.ground.scale;
  const bool is_little =
      of_cells < LEAST_GROUND_CELLS || (of_points < LITTLE_GROUND && of_cells < LITTLE_GROUND_CELLS);
  if (!is_little && spread <= WIDEST_SPREAD * found.size) return;
  warnings.push_back(
      Sentence() << "little or no ground was seen, as under vegetation or where it was removed: "
                 << 100 * of_points << " % of the points, in " << 100 * of_cells
                 << " % of the cells with points, spread by " << spread << " m; what is lower than "
                 << found.ground.tolerance << " m counts as ground, see --height-tolerance");
}

void checkReach(const Findings& found, Warnings& warnings) {
  const double without = shareWithoutGround(found.observed(), found.seen.cells, found.cells(), found.size);
  if (without >= MOST_WITHOUT_GROUND)
    warnings.push_back(Sentence() << 100 * without
                                  << " % of the cells have no ground within the largest object, "
                                  << found.size << " m: their ground is guessed; see --max-object-size");
}

/// Without a size half of the extent is taken, and on a large tile the tolerance grows with it.
void checkTolerance(const Findings& found, Warnings& warnings) {
  const double least = NOISE * found.ground.scale, most = found.ground.most_tolerance;
  if (found.parameters.height_tolerance || found.parameters.max_object_size || most <= least) return;
  Eigen::Index hidden = 0;
  for (Eigen::Index n = 0; n < found.points.cols(); ++n) {
    if (found.labels[static_cast<std::size_t>(n)] != Label::GROUND) continue;
    const Eigen::Vector3d p = found.points.col(n).cast<double>();
    hidden += p.z() - found.ground.surface.heightAt(p.x(), p.y()) > least ? 1 : 0;
  }
  const double share = static_cast<double>(hidden) / static_cast<double>(found.points.cols());
  if (share <= MOST_HIDDEN) return;
  warnings.push_back(
      Sentence() << 100 * share << " % of the points are more than " << least
                 << " m above the ground and still ground, as what is lower than " << most
                 << " m may be where half of the scan's extent is taken for the largest object, "
                 << found.size
                 << " m: low objects may be lost; see --max-object-size and --height-tolerance");
}

}  // namespace

std::vector<std::string> warningsAbout(const RobustGround& ground, const PointsView& level_points,
                                       const Labels& labels, const RobustParameters& parameters) {
  constexpr Eigen::Index FEWEST_POINTS = 100;  // of fewer nothing can be said but that
  Warnings warnings;
  if (ground.surface.height.size() == 0) return warnings;
  if (parameters.max_object_size && ground.max_object_size > ground.extent)
    warnings.push_back(Sentence() << "the maximum object size of " << ground.max_object_size
                                  << " m exceeds the extent of the scan, " << ground.extent
                                  << " m: are the coordinates in metres, not in kilometres or degrees? see "
                                     "--max-object-size");
  if (level_points.cols() < FEWEST_POINTS) {
    if (std::find(labels.begin(), labels.end(), Label::GROUND) == labels.end())
      warnings.push_back(Sentence() << "no point was found to be ground: see --max-object-size, "
                                    << ground.max_object_size << " m, and --up-direction");
    return warnings;
  }
  Findings found{ground, level_points, labels, parameters, {}};
  found.size = ground.max_object_size;
  found.widest = (ground.bounds.high - ground.bounds.low).head<2>().maxCoeff();
  if (!(found.widest > 0)) return warnings;
  if (checkUnit(found, warnings)) return warnings;  // the rest would follow from it
  checkCoverage(found, warnings);
  found.seen = groundSeen(level_points, labels, found.cells());
  if (!checkPatches(found, warnings)) checkAmount(found, warnings);
  checkReach(found, warnings);
  checkTolerance(found, warnings);
  return warnings;
}

}  // namespace pcl_fft_ground::core
