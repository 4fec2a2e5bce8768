#include "pcl_fft_ground/core/ground/robust_ground.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/openings.h"
#include "ground/robust_breaks.h"
#include "ground/robust_choices.h"
#include "ground/robust_surface.h"
#include "scan/point_sample.h"

namespace pcl_fft_ground::core {
namespace {

/// Coarse to fine from the lower envelope: the largest object first, then shorter wavelengths.
std::vector<double> growGround(RobustSurface& surface, double coarsest, double finest) {
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

/// From the cells that progressive openings leave, at the finest wavelength alone: where land breaks, a
/// surface of a longer one loses the terraces.
std::vector<double> openGround(RobustSurface& surface, const ElevationGrid& elevation,
                               const OpeningParameters& opening, double finest) {
  surface.startFrom(pointsIn(openedGround(elevation, opening), surface.points()), finest);
  surface.refine(finest);
  return {finest};
}

/// Cells that hold a point no higher than three scales above the surface.
Mask cellsOnSurface(const RobustSurface& surface, const GridGeometry& cells) {
  constexpr double GROUND_SCALES = 3;
  const double highest = surface.spread().centre + GROUND_SCALES * surface.spread().scale;
  Mask on_surface = Mask::Constant(cells.rows, cells.cols, false);
  const CellPoints& points = surface.points();
  for (std::size_t n = 0; n < points.positions.size(); ++n) {
    const Eigen::Vector3d& p = points.positions[n];
    const double height = surface.grid().value(surface.heights(), surface.grid().at(p.x(), p.y()));
    on_surface.data()[points.cells[n]] = p.z() - height <= highest;
  }
  return on_surface;
}

/// Fits the surface again where there is ground above breaks.
/// \return all ground cells; none where the land does not break
Mask bendAtBreaks(RobustSurface& surface, const ElevationGrid& elevation, const ObjectSize& object,
                  double finest) {
  const Mask ground = cellsOnSurface(surface, elevation.geometry);
  const Mask above = groundAboveBreaks(elevation, ground, object);
  if (!above.any()) return above;
  surface.startFrom(pointsIn(ground || above, surface.points()), finest);
  return ground || above;
}

/// How the ground was found.
struct Search {
  std::vector<double> wavelengths;
  Mask broken;  ///< all ground cells, where the land breaks; otherwise none
};

Search findGround(RobustSurface& surface, const RobustPlan& plan, const ElevationGrid& elevation,
                  const std::optional<double>& max_slope) {
  constexpr double LEAST_HEIGHT = 0.01;  // of an object, as a share of the largest
  const double size = plan.max_object_size, finest = plan.finest_wavelength;
  if (max_slope) return {openGround(surface, elevation, {size, *max_slope, LEAST_HEIGHT * size}, finest), {}};
  std::vector<double> wavelengths = growGround(surface, std::max(size, finest), finest);
  return {std::move(wavelengths), bendAtBreaks(surface, elevation, {size, LEAST_HEIGHT * size}, finest)};
}

/// Fits the surface to the ground points themselves: a cell may hold both ground and the foot of an object,
/// and its lowest points lie below the middle of the noise.
/// \return the spread of the points around it
double fitGroundPoints(RobustSurface& surface, const SortedPoints& points) {
  constexpr double BAND = 3;  // scales
  const Spread cells = surface.spread();
  // Of the cells the lowest points were looked at: first find where all points lie.
  const Spread points_before =
      spreadAround(points, {surface.grid(), surface.heights(), cells.centre - 3 * BAND * cells.scale,
                            cells.centre + BAND * cells.scale});
  const double band = BAND * points_before.scale;
  const CellPoints ground = meanGroundPoints(
      points, {surface.grid(), surface.heights(), points_before.centre - band, points_before.centre + band});
  if (!ground.positions.empty()) surface.fitTo(ground);
  return spreadAround(points, {surface.grid(), surface.heights(), -2 * band, 2 * band}).scale;
}

/// Distance [m] of every cell from the nearest one that holds ground.
Eigen::ArrayXXd distanceFromGround(const CellPoints& ground, const GridGeometry& cells) {
  Mask observed = Mask::Constant(cells.rows, cells.cols, false);
  for (const Eigen::Index cell : ground.cells) observed.data()[cell] = true;
  Eigen::ArrayXXd nearest(cells.rows, cells.cols);
  for (Eigen::Index cell = 0; cell < nearest.size(); ++cell) nearest.data()[cell] = static_cast<double>(cell);
  fillEmptyCells(nearest, observed);
  Eigen::ArrayXXd distance(cells.rows, cells.cols);
  for (Eigen::Index j = 0; j < cells.cols; ++j)
    for (Eigen::Index i = 0; i < cells.rows; ++i) {
      const auto cell = static_cast<Eigen::Index>(nearest(i, j));
      distance(i, j) = Eigen::Vector2d(cell % cells.rows - i, cell / cells.rows - j).norm();
    }
  return cells.cell_size * distance;
}

void describeSurface(const RobustSurface& surface, const RobustPlan& plan, RobustGround& ground) {
  ground.surface.geometry = plan.cells;
  ground.surface.height = resampled(surface.heights(), surface.grid(), plan.cells);
  const Eigen::ArrayXXd distance = distanceFromGround(surface.points(), plan.cells);
  ground.surface.supported = distance <= plan.finest_wavelength;
  ground.surface.uncertainty = (std::pow(ground.scale, 2) + (plan.slope * distance).square()).sqrt();
}

}  // namespace

RobustGround estimateRobustGround(const PointsView& points, const Eigen::Isometry3d& frame_from_input,
                                  const RobustParameters& parameters) {
  constexpr Eigen::Index POINTS_PER_CELL = 8;               // as many tell where its ground lies
  constexpr double LEAST_SCALE = 0.0015, PRECISION = 1e-4;  // as shares of the largest object
  RobustGround ground;
  ground.surface.frame_from_input = frame_from_input;
  if (points.cols() == 0) return ground;
  const Bounds bounds = boundsOf(points);
  const RobustPlan plan = planRobustGround(parameters, bounds, points.cols(), ground.choices);
  ground.extent = plan.extent;
  ground.max_object_size = plan.max_object_size;
  ground.finest_wavelength = plan.finest_wavelength;

  const Points sample = sampleOf(points, POINTS_PER_CELL * plan.cells.rows * plan.cells.cols);
  const SortedPoints sorted(sample, bounds, plan.cells);
  CellPoints cell_points = representativePoints(sorted, plan.statistic);
  ground.elevation = elevationOf(cell_points, plan.cells);
  RobustSurface surface(std::move(cell_points), plan.cells,
                        {plan.finest_wavelength, parameters.filter_order, parameters.passband_ripple},
                        {LEAST_SCALE * plan.max_object_size, plan.slope}, PRECISION * plan.max_object_size);
  Search search = findGround(surface, plan, ground.elevation, parameters.max_slope);
  ground.wavelengths = std::move(search.wavelengths);
  ground.scale = fitGroundPoints(surface, sorted);
  describeSurface(surface, plan, ground);
  chooseTolerances(parameters, points.cols(), ground);
  if (search.broken.any())
    followGround(ground.elevation, search.broken, ground.scale, ground.depth_tolerance,
                 ground.surface.height);
  return ground;
}

}  // namespace pcl_fft_ground::core
