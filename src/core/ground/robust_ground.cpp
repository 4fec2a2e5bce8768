#include "pcl_fft_ground/core/ground/robust_ground.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/distances.h"
#include "ground/robust_breaks.h"
#include "ground/robust_steps.h"
#include "ground/robust_surface.h"
#include "ground/robust_uncertainty.h"
#include "scan/point_sample.h"

namespace pcl_fft_ground::core {
namespace {

/// Coarse to fine from the lower envelope: the largest object first, then shorter wavelengths.
std::vector<double> growFromBelow(RobustSurface& surface, double coarsest, double finest) {
  const double octaves = std::round(std::log2(coarsest / finest));
  const double ratio = std::pow(coarsest / finest, 1 / std::max(octaves, 1.0));
  surface.startBelowObjects(coarsest);
  std::vector<double> wavelengths{coarsest};
  surface.refine(coarsest);
  while (wavelengths.back() > finest) {
    const double shorter = wavelengths.back() / ratio;
    wavelengths.push_back(shorter < 1.001 * finest ? finest : shorter);
    surface.refine(wavelengths.back());
  }
  return wavelengths;
}

std::vector<bool> pointsIn(const Mask& cells, const CellPoints& points) {
  std::vector<bool> chosen;
  chosen.reserve(points.cells.size());
  for (const Eigen::Index cell : points.cells) chosen.push_back(cells.data()[cell]);
  return chosen;
}

/// Cells whose point lies so far below and above the surface [m].
Mask cellsAtSurface(const RobustSurface& surface, const GridGeometry& cells, double low, double high) {
  Mask at_surface = Mask::Constant(cells.rows, cells.cols, false);
  const CellPoints& points = surface.points();
  for (std::size_t n = 0; n < points.positions.size(); ++n) {
    const Eigen::Vector3d& p = points.positions[n];
    const double height = p.z() - surface.grid().value(surface.heights(), surface.grid().at(p.x(), p.y()));
    at_surface.data()[points.cells[n]] = height >= low && height <= high;
  }
  return at_surface;
}

/// The ground that the surface has not reached, and the surface through it.
/// \return all ground cells; none if the surface has reached them all
Mask completeGround(RobustSurface& surface, const RobustPlan& plan, const ElevationGrid& elevation,
                    const std::optional<double>& max_slope, RobustGround& result) {
  constexpr int ROUNDS = 2;
  constexpr double ABOVE = 3, BELOW = 8;  // scales: outliers below would wreck the fit
  constexpr double LEAST_HEIGHT = 0.01;
  const double size = plan.max_object_size;
  const CellMap land(surface.points(), plan.cells);
  const auto band = [&](double low, double high) {
    const Spread spread = surface.spread();
    return cellsAtSurface(surface, plan.cells, spread.centre - low * spread.scale,
                          std::max(spread.centre + ABOVE * spread.scale, high));
  };
  Mask gained = Mask::Constant(plan.cells.rows, plan.cells.cols, false);
  for (int round = 0; round < ROUNDS; ++round) {
    const Mask ground = band(BELOW, 0) || gained;
    const Mask more = continuedGround(land, ground, surface.spread().scale, size);
    if (!more.any()) break;
    gained = gained || more;
    surface.refit(pointsIn(ground || gained, surface.points()));
  }
  const Mask ground = cellsAtSurface(surface, plan.cells, -USUAL_DEPTH * size,
                                     std::max(surface.spread().centre + ABOVE * surface.spread().scale,
                                              LEAST_HEIGHT * size)) ||
                      gained;
  AboveBreaks breaks = groundAboveBreaks(land, elevation, ground, plan, max_slope);
  result.land_breaks = breaks.is_known;
  result.standing = std::move(breaks.standing);
  const Mask& above = breaks.cells;
  if (!above.any()) return gained.any() ? band(BELOW, 0) || gained : gained;
  surface.refit(pointsIn(ground || above, surface.points()));
  return ground || above;
}

/// Distance [m] of every cell from the nearest one that holds ground.
Eigen::ArrayXXd distanceFromGround(const CellPoints& ground, const GridGeometry& cells) {
  Mask observed = Mask::Constant(cells.rows, cells.cols, false);
  for (const Eigen::Index cell : ground.cells) observed.data()[cell] = true;
  return cells.cell_size * distancesFrom(observed);
}

void describeSurface(const RobustSurface& surface, const SortedPoints& points, const RobustPlan& plan,
                     RobustGround& ground) {
  constexpr double DEEPEST = 10;  // spreads: further down there is no ground
  ground.surface.geometry = plan.cells;
  ground.surface.height = resampled(surface.heights(), surface.grid(), plan.cells);
  const Eigen::ArrayXXd distance = distanceFromGround(surface.points(), plan.cells);
  ground.surface.supported = distance <= plan.finest_wavelength;
  // Above the surface objects begin.
  std::vector<float> below =
      heightsIn(points, {surface.grid(), surface.heights(), -DEEPEST * ground.scale, 0});
  ground.surface.uncertainty =
      surfaceUncertainty(ground.surface.height, distance, plan.cells.cell_size, plan.finest_wavelength,
                         std::max(ground.scale, deviationOf(below)));
}

/// fitRobustGround() to the planned sample of so many points.
RobustGround fitSample(const Points& sample, Eigen::Index total, const Eigen::Isometry3d& frame_from_input,
                       const RobustPlan& plan, const RobustParameters& parameters) {
  constexpr double LEAST_SCALE = 0.0015, PRECISION = 1e-4;  // as shares of the largest object
  RobustGround ground;
  ground.surface.frame_from_input = frame_from_input;
  ground.choices = plan.choices;
  ground.extent = plan.extent;
  ground.max_object_size = plan.max_object_size;
  ground.finest_wavelength = plan.finest_wavelength;

  ground.bounds = plan.bounds;
  ground.spacing = spacingOf({sample, total}, plan.bounds);
  const SortedPoints sorted(sample, plan.bounds, plan.cells);
  CellPoints cell_points = representativePoints(sorted, plan.statistic);
  ground.elevation = elevationOf(cell_points, plan.cells);
  RobustSurface surface(std::move(cell_points), plan.cells,
                        {plan.finest_wavelength, parameters.filter_order, parameters.passband_ripple},
                        {LEAST_SCALE * plan.max_object_size, plan.slope}, PRECISION * plan.max_object_size);
  ground.wavelengths =
      growFromBelow(surface, std::max(plan.max_object_size, plan.finest_wavelength), plan.finest_wavelength);
  const CellPoints lowest = surface.points();
  const Mask completed = completeGround(surface, plan, ground.elevation, parameters.max_slope, ground);
  const GroundPoints found = fitGroundPoints(surface, sorted, USUAL_TOLERANCE * plan.max_object_size);
  ground.scale = found.spread;
  describeSurface(surface, sorted, plan, ground);
  ground.lowest = lowestHeights(sorted, {surface.grid(), surface.heights(), 0, 0});
  ground.steps.setZero(plan.cells.rows, plan.cells.cols);
  if (completed.any()) {
    const CellMap land(lowest, plan.cells);
    const Eigen::ArrayXXd smooth = ground.surface.height;
    followGround(land, completed, ground.scale, ground.surface.height);
    ground.lowest -= (ground.surface.height - smooth).cast<float>();
    ground.steps = stepsOfGround(land, completed, ground.surface.height);
  }
  return ground;
}

}  // namespace

RobustGround estimateRobustGround(const PointsView& points, const Eigen::Isometry3d& frame_from_input,
                                  const RobustParameters& parameters) {
  if (points.cols() == 0) {
    RobustGround nothing;
    nothing.surface.frame_from_input = frame_from_input;
    return nothing;
  }
  const RobustPlan plan = planRobustGround(parameters, boundsOf(points), points.cols());
  const Points sample = plannedSample(points, plan);
  RobustGround ground = fitSample(sample, points.cols(), frame_from_input, plan, parameters);
  chooseTolerances(parameters, plan, ground.elevation.observed.count(), ground);
  const ClearanceCounts clearances = clearancesOf(sample, ground);
  widenTolerance(parameters, clearances, ground);
  ground.shares = groundShares(clearances, ground);
  return ground;
}

Points plannedSample(const PointsView& points, const RobustPlan& plan) {
  return sampleOfSample(points, plan.points, plan.sample);
}

RobustGround fitRobustGround(const PointsView& points, const Eigen::Isometry3d& frame_from_input,
                             const RobustPlan& plan, const RobustParameters& parameters) {
  return fitSample(plannedSample(points, plan), points.cols(), frame_from_input, plan, parameters);
}

}  // namespace pcl_fft_ground::core
