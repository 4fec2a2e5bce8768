#include "pcl_fft_ground/core/robust_ground.h"

#include <algorithm>
#include <cmath>

#include "robust_openings.h"
#include "robust_surface.h"

namespace pcl_fft_ground::core {
namespace {

/// The value given, or the one chosen, which is then noted with its reason.
template <typename T>
T choose(const std::optional<T>& given, T chosen, const char* parameter, const char* reason,
         std::vector<RobustChoice>& choices) {
  if (given) return *given;
  choices.push_back({parameter, static_cast<double>(chosen), reason});
  return chosen;
}

/// 40 cells to the largest object, but no more than 4 cells to a point.
double chooseCellSize(const RobustParameters& parameters, double max_object_size, const Bounds& bounds,
                      Eigen::Index count, std::vector<RobustChoice>& choices) {
  constexpr double CELLS_PER_OBJECT = 40, CELLS_PER_POINT = 4;
  const double by_object = max_object_size / CELLS_PER_OBJECT;
  const double area = (bounds.high - bounds.low).head<2>().prod();
  const double by_spacing = std::sqrt(area / (CELLS_PER_POINT * static_cast<double>(count)));
  const double least = 1e-6 * std::max(1.0, (bounds.high - bounds.low).head<2>().maxCoeff());
  return choose(parameters.cell_size, std::max({by_object, by_spacing, least}), "cell_size",
                by_object > by_spacing ? "a fortieth of the largest object"
                                       : "the points are too sparse for smaller cells",
                choices);
}

/// Coarse to fine from the lower envelope: the largest object first, then shorter wavelengths.
std::vector<double> growGround(RobustSurface& surface, double coarsest, double finest) {
  constexpr double STEP = 2;
  constexpr int ITERATIONS = 15;
  surface.startBelowObjects(coarsest);
  std::vector<double> wavelengths;
  for (double wavelength = coarsest;; wavelength = std::max(wavelength / STEP, finest)) {
    surface.refine(wavelength, ITERATIONS);
    wavelengths.push_back(wavelength);
    if (wavelength <= finest) return wavelengths;
  }
}

/// From the cells that progressive openings leave, at the finest wavelength alone: where land breaks, a
/// surface of a longer one loses the terraces.
std::vector<double> openGround(RobustSurface& surface, const GridGeometry& cells,
                               const OpeningParameters& opening, double finest) {
  constexpr int ITERATIONS = 15;
  surface.startFrom(openedGround(surface.points(), cells, opening), finest);
  surface.refine(finest, ITERATIONS);
  return {finest};
}

/// How the points within `reach` of the surface lie around it.
Spread spreadOfPoints(const RobustSurface& surface, const PointsView& points, double reach) {
  std::vector<double> heights;
  heights.reserve(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Eigen::Vector3d p = points.col(n).cast<double>();
    const double height = p.z() - surface.grid().value(surface.heights(), surface.grid().at(p.x(), p.y()));
    if (std::abs(height) < reach) heights.push_back(height);
  }
  return medianSpread(heights);
}

/// Fits the surface to the ground points themselves: a cell may hold both ground and the foot of an object,
/// and its lowest points lie below the middle of the noise.
/// \return the spread of the points around it
double fitGroundPoints(RobustSurface& surface, const PointsView& points, const GridGeometry& cells) {
  constexpr double BAND = 3;  // scales
  Spread spread = surface.spread();
  double low = spread.centre - 3 * BAND * spread.scale;  // the lowest points stood for their cells
  for (int n = 0; n < 2; ++n) {
    const double high = spread.centre + BAND * spread.scale;
    const CellPoints ground = meanGroundPoints(points, cells, {surface.grid(), surface.heights(), low, high});
    if (!ground.positions.empty()) surface.fitTo(ground);
    spread = spreadOfPoints(surface, points, 2 * BAND * spread.scale);
    low = spread.centre - BAND * spread.scale;
  }
  return spread.scale;
}

/// Distance [m] of every cell from the nearest one that holds ground.
Eigen::ArrayXXd distanceFromGround(const CellPoints& ground, const GridGeometry& cells) {
  Mask observed = Mask::Constant(cells.rows, cells.cols, false);
  for (const Eigen::Index cell : ground.cells) observed.data()[cell] = true;
  const Eigen::ArrayXXd own_row =
      Eigen::ArrayXd::LinSpaced(cells.rows, 0, static_cast<double>(cells.rows - 1)).replicate(1, cells.cols);
  const Eigen::ArrayXXd own_col =
      Eigen::ArrayXd::LinSpaced(cells.cols, 0, static_cast<double>(cells.cols - 1))
          .transpose()
          .replicate(cells.rows, 1);
  Eigen::ArrayXXd row = own_row, col = own_col;
  fillEmptyCells(row, observed);
  fillEmptyCells(col, observed);
  return cells.cell_size * ((row - own_row).square() + (col - own_col).square()).sqrt();
}

/// Between points that lie so far apart [m] the ground is not known: on a slope it may differ by the slope
/// times this distance.
double pointSpacing(const ElevationGrid& elevation, Eigen::Index points) {
  const auto observed = static_cast<double>(elevation.observed.count());
  return elevation.geometry.cell_size * std::min(1.0, std::sqrt(observed / static_cast<double>(points)));
}

void chooseTolerances(RobustGround& ground, const RobustParameters& parameters, Eigen::Index points) {
  constexpr double SCALES = 3, SPACINGS = 1.25, SHARE_OF_OBJECT = 0.0094;
  const double by_noise = SCALES * ground.scale, by_size = SHARE_OF_OBJECT * ground.max_object_size;
  ground.tolerance = choose(
      parameters.height_tolerance, std::max(by_noise, by_size), "height_tolerance",
      by_noise > by_size ? "three times the spread of the ground points" : "0.94 % of the largest object",
      ground.choices);
  ground.slope_tolerance = SPACINGS * pointSpacing(ground.elevation, points);
  ground.depth_tolerance = std::max(1.0, 10 * ground.scale);
}

}  // namespace

RobustGround estimateRobustGround(const PointsView& points, const Eigen::Isometry3d& frame_from_input,
                                  const RobustParameters& parameters) {
  RobustGround ground;
  ground.surface.frame_from_input = frame_from_input;
  if (points.cols() == 0) return ground;
  const Bounds bounds = boundsOf(points);
  ground.extent = (bounds.high - bounds.low).head<2>().minCoeff();
  const double widest = std::max((bounds.high - bounds.low).head<2>().maxCoeff(), 1e-3);
  const double share_of_extent =
      parameters.relative_max_object_size * (ground.extent > 1e-3 * widest ? ground.extent : widest);
  ground.max_object_size = parameters.max_object_size.value_or(share_of_extent);
  const double size = ground.max_object_size;

  const GridGeometry cells =
      gridAround(bounds, chooseCellSize(parameters, size, bounds, points.cols(), ground.choices));
  const CellStatistic statistic = choose(
      parameters.statistic, CellStatistic::LOWEST, "statistic",
      "walls share cells with the ground; its points' mean takes over once it is found", ground.choices);
  ground.finest_wavelength =
      choose(parameters.finest_wavelength,
             std::max(size / (parameters.max_slope ? 12.5 : 10), 3.2 * cells.cell_size), "finest_wavelength",
             "a tenth of the largest object (less where land breaks), at least three cells", ground.choices);

  const double slope = parameters.max_slope ? *parameters.max_slope / 3 : 0.03;
  CellPoints cell_points = representativePoints(points, cells, statistic);
  ground.elevation = elevationOf(cell_points, cells);
  RobustSurface surface(std::move(cell_points), cells,
                        {ground.finest_wavelength, parameters.filter_order, parameters.passband_ripple},
                        {0.0015 * size, slope}, 1e-4 * size);
  ground.wavelengths =
      parameters.max_slope
          ? openGround(surface, cells, {size, *parameters.max_slope, 0.01 * size}, ground.finest_wavelength)
          : growGround(surface, std::max(size, ground.finest_wavelength), ground.finest_wavelength);
  ground.scale = fitGroundPoints(surface, points, cells);

  ground.surface.geometry = cells;
  ground.surface.height = resampled(surface.heights(), surface.grid(), cells);
  const Eigen::ArrayXXd distance = distanceFromGround(surface.points(), cells);
  ground.supported = distance <= ground.finest_wavelength;
  ground.uncertainty = (std::pow(ground.scale, 2) + (slope * distance).square()).sqrt();
  chooseTolerances(ground, parameters, points.cols());
  return ground;
}

}  // namespace pcl_fft_ground::core
