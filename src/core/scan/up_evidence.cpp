#include "scan/up_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "scan/point_sample.h"

namespace pcl_fft_ground::core {
namespace {

// Constants of the profile. Chosen on the shared land, table and street scans, upright: cells so large that
// ground shows in each of them, small enough to leave a few dozen of them.
constexpr double FINE_CELLS = 250, COARSE_CELLS = 90;         // that hold points
constexpr double FEWEST_IN_FINE = 12, FEWEST_IN_COARSE = 30;  // points in a cell on average
constexpr double ENOUGH_TO_DROP_TWO = 100;  // points in a cell, of which the two outermost may be outliers
constexpr double TRIMMED = 0.02;            // share of the largest second differences: outliers
constexpr std::size_t FEWEST_DIFFERENCES = 8;
constexpr double NOISE = 0.005;  // roughness that measuring errors alone may have
// Floor and ceiling: the far side as smooth as a tenth of the distance, which is most of the height.
constexpr double SHEET = 0.1, APART = 0.5;

constexpr double EMPTY = std::numeric_limits<double>::quiet_NaN();

/// Leaves out points far above or below the others: they would stand for the cells in which they are.
Points withoutOutliers(Points points) {
  constexpr double TAIL = 0.03;  // share of the points at either end
  constexpr float REACH = 1;     // of the height of the others, from their ends
  std::vector<float> heights(static_cast<std::size_t>(points.cols()));
  Eigen::Map<Eigen::RowVectorXf>(heights.data(), points.cols()) = points.row(2);
  const auto cut = static_cast<std::ptrdiff_t>(TAIL * static_cast<double>(heights.size()));
  const auto low = heights.begin() + cut, high = heights.end() - 1 - cut;
  std::nth_element(heights.begin(), low, heights.end());
  if (high > low) std::nth_element(low + 1, high, heights.end());
  const float reach = REACH * (*high - *low);
  Eigen::Index count = 0;
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    if (points(2, n) >= *low - reach && points(2, n) <= *high + reach) points.col(count++) = points.col(n);
  points.conservativeResize(Eigen::NoChange, count);
  return points;
}

Eigen::Matrix3f levelledTo(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d other =
      std::abs(direction.x()) < 0.7 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  Eigen::Matrix3d rotation;
  rotation.row(0) = direction.cross(other).normalized();
  rotation.row(1) = direction.cross(rotation.row(0).transpose());
  rotation.row(2) = direction;
  return rotation.cast<float>();
}

/// Points along a direction (third row) and across it, outliers left out.
Points alignedWith(const Points& points, const Eigen::Vector3d& direction) {
  return withoutOutliers(levelledTo(direction) * points);
}

/// Cells across a direction, each with the heights of its points.
struct HeightCells {
  Eigen::Index rows = 0, cols = 0;
  double side = 0;
  std::vector<std::vector<float>> heights;
};

struct Layout {
  Eigen::Array2d low;
  Eigen::Index rows, cols;
  double side;

  std::size_t cellOf(const Points& points, Eigen::Index n) const {
    const Eigen::Array2d at = (points.col(n).head<2>().cast<double>().array() - low) / side;
    const Eigen::Index i = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(at.x()), 0, rows - 1);
    const Eigen::Index j = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(at.y()), 0, cols - 1);
    return static_cast<std::size_t>(i + j * rows);
  }
};

Layout layoutOf(const Eigen::Array2d& low, const Eigen::Array2d& extents, double side) {
  const auto cells = [&](double extent) { return static_cast<Eigen::Index>(extent / side) + 1; };
  return {low, cells(extents.x()), cells(extents.y()), side};
}

std::size_t occupied(const Points& points, const Layout& layout) {
  std::vector<bool> seen(static_cast<std::size_t>(layout.rows * layout.cols), false);
  for (Eigen::Index n = 0; n < points.cols(); ++n) seen[layout.cellOf(points, n)] = true;
  return static_cast<std::size_t>(std::count(seen.begin(), seen.end(), true));
}

/// Cells of such a size that those with points hold `per_cell` of them on average.
HeightCells heightCells(const Points& points, double per_cell) {
  constexpr int TRIALS = 5;
  constexpr double CLOSE_ENOUGH = 1.1;
  const Eigen::Array2d low = points.topRows<2>().rowwise().minCoeff().cast<double>();
  const Eigen::Array2d extents = points.topRows<2>().rowwise().maxCoeff().cast<double>().array() - low;
  const auto count = static_cast<double>(points.cols());
  const double widest = extents.maxCoeff();
  if (!(widest > 0)) return {};
  Layout layout = layoutOf(low, extents,
                           std::max(std::sqrt(extents.prod() * per_cell / count), widest * per_cell / count));
  for (int n = 0; n < TRIALS; ++n) {
    const double in_cell = count / static_cast<double>(occupied(points, layout));
    if (in_cell <= CLOSE_ENOUGH * per_cell) break;
    layout = layoutOf(low, extents, layout.side * std::sqrt(per_cell / in_cell));
  }
  HeightCells cells{layout.rows, layout.cols, layout.side, {}};
  cells.heights.resize(static_cast<std::size_t>(layout.rows * layout.cols));
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    cells.heights[layout.cellOf(points, n)].push_back(points(2, n));
  return cells;
}

struct Envelopes {
  Eigen::ArrayXXd low, high;
  double side;
};

/// The lowest and the highest point of each cell that has enough, outliers left out.
Envelopes envelopesOf(HeightCells cells, double per_cell) {
  constexpr double LEAST_SHARE = 0.2;  // of the average number of points
  const std::size_t dropped = per_cell >= ENOUGH_TO_DROP_TWO ? 2 : per_cell >= FEWEST_IN_FINE ? 1 : 0;
  const auto fewest =
      std::max<std::size_t>(3 * dropped + 3, static_cast<std::size_t>(LEAST_SHARE * per_cell));
  Envelopes envelopes{Eigen::ArrayXXd::Constant(cells.rows, cells.cols, EMPTY), {}, cells.side};
  envelopes.high = envelopes.low;
  for (std::size_t n = 0; n < cells.heights.size(); ++n) {
    std::vector<float>& heights = cells.heights[n];
    if (heights.size() < fewest) continue;
    const auto low = heights.begin() + static_cast<std::ptrdiff_t>(dropped);
    const auto high = heights.end() - 1 - static_cast<std::ptrdiff_t>(dropped);
    std::nth_element(heights.begin(), low, heights.end());
    envelopes.low.data()[n] = *low;
    std::nth_element(low + 1, high, heights.end());
    envelopes.high.data()[n] = *high;
  }
  return envelopes;
}

std::vector<double> secondDifferences(const Eigen::ArrayXXd& heights) {
  std::vector<double> differences;
  const auto add = [&](double before, double here, double after) {
    const double difference = std::abs(before - 2 * here + after);
    if (std::isfinite(difference)) differences.push_back(difference);
  };
  for (Eigen::Index j = 0; j < heights.cols(); ++j)
    for (Eigen::Index i = 0; i < heights.rows(); ++i) {
      if (i > 0 && i + 1 < heights.rows()) add(heights(i - 1, j), heights(i, j), heights(i + 1, j));
      if (j > 0 && j + 1 < heights.cols()) add(heights(i, j - 1), heights(i, j), heights(i, j + 1));
    }
  return differences;
}

/// The mean second difference [m], the largest ones left out.
std::optional<double> bending(const Eigen::ArrayXXd& heights) {
  std::vector<double> differences = secondDifferences(heights);
  if (differences.size() < FEWEST_DIFFERENCES) return std::nullopt;
  std::sort(differences.begin(), differences.end());
  differences.resize(static_cast<std::size_t>((1 - TRIMMED) * static_cast<double>(differences.size())));
  double sum = 0;
  for (const double difference : differences) sum += difference;
  return sum / static_cast<double>(differences.size());
}

std::vector<double> finiteValues(const Eigen::ArrayXXd& values) {
  std::vector<double> result;
  for (const double value : values.reshaped())
    if (std::isfinite(value)) result.push_back(value);
  std::sort(result.begin(), result.end());
  return result;
}

bool isEnclosed(const Envelopes& envelopes) {
  const std::vector<double> low = finiteValues(envelopes.low), high = finiteValues(envelopes.high),
                            apart = finiteValues(envelopes.high - envelopes.low);
  if (apart.empty()) return false;
  const double distance = apart[apart.size() / 2];
  const double span = high[high.size() * 95 / 100] - low[low.size() * 5 / 100];
  const std::optional<double> below = bending(envelopes.low), above = bending(envelopes.high);
  return below && above && distance > APART * span && std::max(*below, *above) < SHEET * distance;
}

/// Median of the values around a cell that are there.
double medianAround(const Eigen::ArrayXXd& values, Eigen::Index i, Eigen::Index j, Eigen::Index reach) {
  std::vector<double> around;
  for (Eigen::Index l = std::max<Eigen::Index>(j - reach, 0); l <= std::min(j + reach, values.cols() - 1);
       ++l)
    for (Eigen::Index k = std::max<Eigen::Index>(i - reach, 0); k <= std::min(i + reach, values.rows() - 1);
         ++k)
      if (std::isfinite(values(k, l))) around.push_back(values(k, l));
  if (around.empty()) return EMPTY;
  const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
  std::nth_element(around.begin(), middle, around.end());
  return *middle;
}

/// How high each cell's top is above the ground around it.
Eigen::ArrayXXd heightsAboveGround(const Envelopes& envelopes) {
  constexpr Eigen::Index REACH = 3;  // cells
  Eigen::ArrayXXd heights = envelopes.high;
  for (Eigen::Index j = 0; j < heights.cols(); ++j)
    for (Eigen::Index i = 0; i < heights.rows(); ++i)
      if (std::isfinite(heights(i, j))) heights(i, j) -= medianAround(envelopes.low, i, j, REACH);
  return heights;
}

/// Number of groups of at least so many flagged cells that touch by a side; the flags are used up.
int groupsOf(Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> flags, std::size_t fewest) {
  int groups = 0;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> waiting;
  const auto visit = [&](Eigen::Index i, Eigen::Index j) {
    if (i < 0 || j < 0 || i >= flags.rows() || j >= flags.cols() || !flags(i, j)) return;
    flags(i, j) = false;
    waiting.emplace_back(i, j);
  };
  for (Eigen::Index j = 0; j < flags.cols(); ++j)
    for (Eigen::Index i = 0; i < flags.rows(); ++i) {
      std::size_t size = 0;
      visit(i, j);
      while (!waiting.empty()) {
        const auto [k, l] = waiting.back();
        waiting.pop_back();
        ++size;
        visit(k - 1, l), visit(k + 1, l), visit(k, l - 1), visit(k, l + 1);
      }
      groups += size >= fewest ? 1 : 0;
    }
  return groups;
}

/// The geometric mean of two, or that which there is.
std::optional<double> meanOf(const std::optional<double>& a, const std::optional<double>& b) {
  if (a && b) return std::sqrt(*a * *b);
  return a ? a : b;
}

std::optional<double> roughness(const Eigen::ArrayXXd& heights, double side) {
  const std::optional<double> metres = bending(heights);
  return metres ? std::optional<double>(*metres / side + NOISE) : std::nullopt;
}

/// Where a direction from the origin meets a cube around it, in equal angles: side, 0 to 5, and two
/// coordinates in [0, 1].
struct CubePlace {
  int face;
  float u, v, log_distance;
};

std::vector<CubePlace> placesOnCube(const PointsView& points) {
  std::vector<CubePlace> places;
  const auto angle = [](float tangent) { return 0.5F + std::atan(tangent) / static_cast<float>(M_PI_2); };
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Eigen::Vector3f p = points.col(n);
    Eigen::Index axis = 0;
    const float along = p.cwiseAbs().maxCoeff(&axis);
    if (!(along > 0)) continue;  // what a sensor did not see, some files put at the origin
    const auto face = static_cast<int>(2 * axis + (p[axis] < 0 ? 1 : 0));
    const float distance = std::max(p.norm(), along);  // the squares of the least floats are 0
    places.push_back(
        {face, angle(p[(axis + 1) % 3] / along), angle(p[(axis + 2) % 3] / along), std::log(distance)});
  }
  return places;
}

/// The points in one of the solid angles: sums of integers do not depend on their order.
struct Bundle {
  std::int64_t count = 0, sum = 0, squares = 0;
};

std::vector<Bundle> bundlesOf(const std::vector<CubePlace>& places, int divisions) {
  constexpr double STEPS = 65536;
  const auto side = static_cast<std::size_t>(divisions);
  std::vector<Bundle> bundles(6 * side * side);
  const auto cell = [&](float share) {
    return static_cast<std::size_t>(
        std::clamp(static_cast<int>(share * static_cast<float>(divisions)), 0, divisions - 1));
  };
  for (const CubePlace& place : places) {
    const std::size_t column = static_cast<std::size_t>(place.face) * side + cell(place.u);
    Bundle& bundle = bundles[column * side + cell(place.v)];
    const auto steps =
        static_cast<std::int64_t>(std::lround(STEPS * static_cast<double>(place.log_distance)));
    ++bundle.count;
    bundle.sum += steps;
    bundle.squares += steps * steps;
  }
  return bundles;
}

/// How the number of points in a solid angle goes with their distance.
struct RayStatistics {
  double slope = 0;      ///< of the logarithm of the number over that of the distance; 2 in a map
  double distances = 0;  ///< standard deviation of the logarithms of the distances
  double numbers = 0;    ///< and of the numbers
  double depth = 0;      ///< median of the standard deviations within the solid angles
  std::size_t bundles = 0;
};

RayStatistics statisticsOf(const std::vector<Bundle>& bundles) {
  constexpr double STEPS = 65536;
  constexpr std::int64_t FEWEST = 3;
  RayStatistics result;
  double x_sum = 0, y_sum = 0, xx = 0, xy = 0, yy = 0;
  std::vector<double> depths;
  for (const Bundle& bundle : bundles) {
    if (bundle.count < FEWEST) continue;
    const auto count = static_cast<double>(bundle.count);
    const double x = static_cast<double>(bundle.sum) / count / STEPS, y = std::log(count);
    const double square = static_cast<double>(bundle.squares) / count / (STEPS * STEPS);
    depths.push_back(std::sqrt(std::max(0.0, square - x * x)));
    x_sum += x, y_sum += y, xx += x * x, xy += x * y, yy += y * y;
  }
  result.bundles = depths.size();
  if (depths.empty()) return result;
  const auto n = static_cast<double>(depths.size());
  const double variance = xx / n - x_sum * x_sum / (n * n);
  result.distances = std::sqrt(std::max(0.0, variance));
  result.numbers = std::sqrt(std::max(0.0, yy / n - y_sum * y_sum / (n * n)));
  result.slope = variance > 0 ? (xy / n - x_sum * y_sum / (n * n)) / variance : 0;
  std::nth_element(depths.begin(), depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2),
                   depths.end());
  result.depth = depths[depths.size() / 2];
  return result;
}

}  // namespace

double UpProfile::evidence() const {
  return rough_below && rough_above && !is_enclosed ? std::log(*rough_above / *rough_below) : 0.0;
}

UpProfile profileAlong(const Points& points, const Eigen::Vector3d& direction) {
  UpProfile profile;
  if (points.cols() == 0) return profile;
  const Points aligned = alignedWith(points, direction);
  const auto count = static_cast<double>(points.cols());
  const double in_fine = std::max(count / FINE_CELLS, FEWEST_IN_FINE);
  const double in_coarse = std::max(count / COARSE_CELLS, FEWEST_IN_COARSE);
  const Envelopes fine = envelopesOf(heightCells(aligned, in_fine), in_fine);
  Envelopes coarse = envelopesOf(heightCells(aligned, in_coarse), in_coarse);
  profile.rough_below = meanOf(roughness(fine.low, fine.side), roughness(coarse.low, coarse.side));
  profile.rough_above = meanOf(roughness(fine.high, fine.side), roughness(coarse.high, coarse.side));
  profile.is_enclosed = isEnclosed(coarse);
  profile.low = std::move(coarse.low);
  profile.high = std::move(coarse.high);
  return profile;
}

double heightToBreadth(const Points& points, const Eigen::Vector3d& direction) {
  constexpr double TAIL = 0.1;
  if (points.cols() == 0) return 0;
  const Points aligned = levelledTo(direction) * points;
  Eigen::Array3d spreads;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> values = finiteValues(aligned.row(axis).cast<double>().array());
    const auto cut = static_cast<std::size_t>(TAIL * static_cast<double>(values.size()));
    spreads[axis] = values[values.size() - 1 - cut] - values[cut];
  }
  const double breadth = std::min(spreads.x(), spreads.y());
  return breadth > 0 ? spreads.z() / breadth : std::numeric_limits<double>::infinity();
}

int thingsStandingOut(const Points& points, const Eigen::Vector3d& up) {
  constexpr double CELLS = 1200, FEWEST_IN_CELL = 4;
  constexpr double NOISES = 8, SHARE_OF_HIGHEST = 0.3;
  const double per_cell = std::max(static_cast<double>(points.cols()) / CELLS, FEWEST_IN_CELL);
  const Envelopes envelopes = envelopesOf(heightCells(alignedWith(points, up), per_cell), per_cell);
  const Eigen::ArrayXXd heights = heightsAboveGround(envelopes);
  const std::vector<double> sorted = finiteValues(heights);
  if (sorted.empty()) return 0;
  const double noise = bending(envelopes.low).value_or(0);
  const double least = std::max(NOISES * noise, SHARE_OF_HIGHEST * sorted[sorted.size() * 99 / 100]);
  return groupsOf((heights > least).eval(), 2);
}

double shareAbove(const Eigen::ArrayXXd& heights, double height) {
  const std::vector<double> values = finiteValues(heights);
  const auto above = values.end() - std::upper_bound(values.begin(), values.end(), height);
  return values.empty() ? 0 : static_cast<double>(above) / static_cast<double>(values.size());
}

bool showsSensorAtOrigin(const PointsView& points) {
  // Scans of rotating lasers and depth cameras have slopes from -0.3 to 0.25, numbers that vary by 0.2 to
  // 0.5; maps and tables slopes from 0.4 to 2.7 and numbers that vary by 0.5 to 1.2.
  constexpr double FLATTEST = 0.35, EVEN = 0.5, NARROW = 0.1, APART_ENOUGH = 0.1;
  constexpr double IN_BUNDLE = 10, CLOSE_ENOUGH = 1.3;
  constexpr Eigen::Index ENOUGH = 60000;
  constexpr int TRIALS = 12, FINEST = 300;
  constexpr std::size_t FEWEST_BUNDLES = 50;
  const std::vector<CubePlace> places = placesOnCube(sampleOf(points, ENOUGH));
  std::vector<Bundle> bundles;
  int divisions = 4;
  for (int n = 0; n < TRIALS; ++n) {
    bundles = bundlesOf(places, divisions);
    const auto seen =
        std::count_if(bundles.begin(), bundles.end(), [](const Bundle& b) { return b.count > 0; });
    const double in_bundle = static_cast<double>(places.size()) / std::max(1.0, static_cast<double>(seen));
    if (in_bundle < CLOSE_ENOUGH * IN_BUNDLE) break;
    divisions =
        static_cast<int>(std::ceil(divisions * std::max(1.1, 0.8 * std::sqrt(in_bundle / IN_BUNDLE))));
    if (divisions > FINEST) return false;  // a small far thing: nothing can be told
  }
  const RayStatistics rays = statisticsOf(bundles);
  return rays.bundles >= FEWEST_BUNDLES && std::abs(rays.slope) < FLATTEST && rays.numbers < EVEN &&
         rays.depth < NARROW && rays.distances > APART_ENOUGH;
}

}  // namespace pcl_fft_ground::core
