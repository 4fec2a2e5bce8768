#include "ground/robust_steps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ground/robust_clearance.h"

namespace pcl_fft_ground::core {
namespace {

using Choices = std::vector<RobustChoice>;

/// The value given, or the one chosen, which is then noted with its reason.
template <typename T>
T choose(const std::optional<T>& given, T chosen, const char* parameter, const char* reason,
         Choices& choices) {
  if (given) return *given;
  choices.push_back({parameter, static_cast<double>(chosen), reason});
  return chosen;
}

/// The larger extent [m]; of a single place, which has none, any length does.
double widestOf(const Eigen::Array2d& extents) {
  return extents.maxCoeff() > 0 ? extents.maxCoeff() : 1;
}

/// 36 cells to the largest object, but no more than 4 cells to a point.
double chooseCellSize(const std::optional<double>& given, double max_object_size,
                      const Eigen::Array2d& extents, Eigen::Index points, Choices& choices) {
  constexpr double CELLS_PER_OBJECT = 36, CELLS_PER_POINT = 4;
  const double by_object = max_object_size / CELLS_PER_OBJECT;
  const double most_cells = CELLS_PER_POINT * static_cast<double>(points);
  // A strip narrower than a cell has one row of them.
  const double by_spacing = std::max(std::sqrt(extents.prod() / most_cells), extents.maxCoeff() / most_cells);
  const double least = 1e-6 * widestOf(extents);
  return choose(given, std::max({by_object, by_spacing, least}), "cell_size",
                by_object > by_spacing ? "a thirty-sixth of the largest object"
                                       : "the points are too sparse for smaller cells",
                choices);
}

double chooseFinestWavelength(const RobustParameters& parameters, double max_object_size, double cell_size,
                              Choices& choices) {
  constexpr double LEAST_CELLS = 3, PER_OBJECT = 10;
  return choose(parameters.finest_wavelength, std::max(max_object_size / PER_OBJECT, LEAST_CELLS * cell_size),
                "finest_wavelength", "a tenth of the largest object, at least three cells", choices);
}

/// Between points that lie so far apart [m] the ground is not known: on a slope it may differ by the slope
/// times this distance.
double pointSpacing(double cell_size, Eigen::Index observed, Eigen::Index points) {
  return cell_size * std::min(1.0, std::sqrt(static_cast<double>(observed) / static_cast<double>(points)));
}

/// The height from which to call points objects with the least expected harm, in steps and of at most so
/// many, by what lies below.
std::size_t leastHarm(const ClearanceCounts& counts, std::size_t most) {
  constexpr long FALSE_OBJECT = 2;  // as bad as so many objects called ground
  std::size_t best = 0;
  long harm = 0, least = 0;
  for (std::size_t step = 0; step < most; ++step) {
    harm +=
        static_cast<long>(counts.above[step]) - (1 + FALSE_OBJECT) * static_cast<long>(counts.below[step]);
    if (harm < least) least = harm, best = step + 1;
  }
  return best;
}

}  // namespace

RobustPlan planRobustGround(const RobustParameters& parameters, const Bounds& bounds, Eigen::Index points) {
  constexpr Eigen::Index POINTS_PER_CELL = 10;  // as many tell where its ground lies
  constexpr double NARROWEST = 1e-3;            // of the other extent
  constexpr double SLOPE = 0.04;
  constexpr double BEYOND_ALL = 1000;  // times the scan: anything longer does the same
  constexpr double NYQUIST = 2;        // cells to the shortest wavelength that they hold
  const Eigen::Array2d extents = (bounds.high - bounds.low).head<2>();
  RobustPlan plan;
  Choices& choices = plan.choices;
  plan.bounds = bounds;
  plan.points = points;
  plan.extent = extents.minCoeff();
  const double widest = widestOf(extents);
  const double extent = plan.extent > NARROWEST * widest ? plan.extent : widest;
  const double largest = BEYOND_ALL * widest;
  plan.max_object_size =
      std::min(largest, parameters.max_object_size.value_or(parameters.relative_max_object_size * extent));
  plan.cells = gridAround(bounds, std::min(largest, chooseCellSize(parameters.cell_size, plan.max_object_size,
                                                                   extents, points, choices)));
  plan.statistic =
      choose(parameters.statistic, CellStatistic::LOWEST, "statistic",
             "walls share cells with the ground; its points' mean takes over once it is found", choices);
  plan.finest_wavelength =
      chooseFinestWavelength(parameters, plan.max_object_size, plan.cells.cell_size, choices);
  plan.finest_wavelength = std::clamp(plan.finest_wavelength, NYQUIST * plan.cells.cell_size,
                                      std::max(NYQUIST * plan.cells.cell_size, largest));
  plan.slope = SLOPE;
  plan.sample = POINTS_PER_CELL * plan.cells.rows * plan.cells.cols;
  return plan;
}

void chooseTolerances(const RobustParameters& parameters, const RobustPlan& plan, Eigen::Index observed,
                      RobustGround& ground) {
  constexpr double SCALES = 3, MORE_SCALES = 4.25, MOST_SCALES = 10, SPACINGS = 1.25;
  constexpr double DEPTH_SCALES = 10, LEAST_SPREAD = 4e-4;
  const double usual = USUAL_TOLERANCE * ground.max_object_size;
  // Nor is the surface known better than this where there is no noise at all.
  const double spread = std::max(ground.scale, LEAST_SPREAD * ground.max_object_size);
  const double noise = SCALES * spread, more_noise = MORE_SCALES * spread;
  ground.tolerance =
      choose(parameters.height_tolerance, std::max(noise, std::min(usual, more_noise)), "height_tolerance",
             more_noise < usual ? "4.25 times the spread of the ground points"
             : noise < usual    ? "0.98 % of the largest object"
                                : "three times the spread of the ground points",
             ground.choices);
  ground.most_tolerance =
      parameters.height_tolerance.value_or(std::max(noise, std::min(usual, MOST_SCALES * spread)));
  ground.slope_tolerance = SPACINGS * pointSpacing(plan.cells.cell_size, observed, plan.points);
  ground.depth_tolerance = std::max(USUAL_DEPTH * ground.max_object_size, DEPTH_SCALES * ground.scale);
}

void ClearanceCounts::add(const ClearanceCounts& part) {
  for (std::size_t step = 0; step < STEPS; ++step)
    above[step] += part.above[step], below[step] += part.below[step];
}

ClearanceCounts clearancesOf(const PointsView& points, const RobustGround& ground) {
  ClearanceCounts counts;
  if (!(ground.depth_tolerance > 0) || ground.surface.height.size() == 0) return counts;
  const Clearance clearance(ground, points);
  const auto per_metre = static_cast<float>(ClearanceCounts::STEPS / ground.depth_tolerance);
  const auto count = [&](float distance, std::array<std::uint64_t, ClearanceCounts::STEPS>& steps) {
    const float step = distance * per_metre;
    if (step > 0 && step < ClearanceCounts::STEPS) ++steps[static_cast<std::size_t>(step)];
  };
  Clearance::Block block;
  for (std::size_t begin = 0; begin < static_cast<std::size_t>(points.cols()); begin += block.count) {
    clearance.read(points, begin, block);
    for (std::size_t n = 0; n < block.count; ++n) {
      count(block.above[n], counts.above);
      count(block.below[n], counts.below);
    }
  }
  return counts;
}

void widenTolerance(const RobustParameters& parameters, const ClearanceCounts& counts, RobustGround& ground) {
  if (parameters.height_tolerance || !(ground.depth_tolerance > 0)) return;
  const double step = ground.depth_tolerance / ClearanceCounts::STEPS;
  const double most = std::min(ground.most_tolerance / step, 1.0 * ClearanceCounts::STEPS);
  const double wider = step * static_cast<double>(leastHarm(counts, static_cast<std::size_t>(most)));
  if (wider <= ground.tolerance) return;
  ground.tolerance = wider;
  RobustChoice& choice =
      *std::find_if(ground.choices.begin(), ground.choices.end(),
                    [](const RobustChoice& known) { return known.parameter == "height_tolerance"; });
  choice.value = wider;
  choice.reason = "as many points lie as far below the ground";
}

}  // namespace pcl_fft_ground::core
