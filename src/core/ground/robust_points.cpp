#include "ground/robust_steps.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "grid/morphology.h"
#include "scan/radix_sort.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double BAND = 3;  // spreads

GroundBand bandAround(const RobustSurface& surface, double low, double high) {
  return {surface.grid(), surface.heights(), low, high};
}

Spread spreadIn(const SortedPoints& points, const GroundBand& band) {
  RadixSort sort;
  std::vector<float> heights = heightsIn(points, band);
  return medianSpread(heights, sort);
}

void fitToMeans(RobustSurface& surface, const SortedPoints& points, double low, double high) {
  const CellPoints ground = meanGroundPoints(points, bandAround(surface, low, high));
  if (!ground.positions.empty()) surface.fitTo(ground);
}

/// Third moment over the 3/2 power of the second one.
double skewnessOf(const std::vector<float>& values) {
  double sum = 0, squares = 0, cubes = 0;
  for (const float value : values) sum += static_cast<double>(value);
  const double mean = sum / std::max(1.0, static_cast<double>(values.size()));
  for (const float value : values) {
    const double d = static_cast<double>(value) - mean;
    squares += d * d, cubes += d * d * d;
  }
  const auto count = static_cast<double>(values.size());
  return squares > 0 ? cubes / count / std::pow(squares / count, 1.5) : 0;
}

/// Noise is symmetric where nothing stands; what grows there makes it skewed.
bool growsOnTheGround(const RobustSurface& surface, const SortedPoints& points, const Spread& spread,
                      double usual) {
  constexpr std::size_t FEWEST = 100;
  constexpr double LEAST_SKEWNESS = 0.1;  // forests .12 to 1.6, other scans at most .09
  if (BAND * spread.scale <= usual) return false;
  const double reach = BAND * spread.scale;
  const GroundBand band = bandAround(surface, spread.centre - reach, spread.centre + reach);
  const Mask standing = dilated(cellsReachingAbove(points, band), 1);
  std::vector<float> heights = heightsIn(points, band, &standing);
  if (heights.size() < FEWEST) heights = heightsIn(points, band);  // plants stand everywhere
  return skewnessOf(heights) >= LEAST_SKEWNESS;
}

/// One-sided fits, each with the spread of what lies below the surface.
/// \return the spread
double sinkThroughPlants(RobustSurface& surface, const SortedPoints& points, double spread, double usual) {
  constexpr int ITERATIONS = 15;
  constexpr double ENOUGH = 0.6, LOW = 3, HIGH = 0.7, DEEPEST = 6, NORMAL_FROM_MEDIAN = 1.4826;
  for (int n = 0; n < ITERATIONS && BAND * spread > ENOUGH * usual; ++n) {
    std::vector<float> depths = heightsIn(points, bandAround(surface, -DEEPEST * spread, 0));
    if (depths.empty()) break;
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    spread = std::min(spread, -NORMAL_FROM_MEDIAN * static_cast<double>(*middle));
    fitToMeans(surface, points, -LOW * spread, HIGH * spread);
  }
  return spread;
}

}  // namespace

GroundPoints fitGroundPoints(RobustSurface& surface, const SortedPoints& points, double usual) {
  const Spread cells = surface.spread();
  // Of the cells the lowest points were looked at: first find where all points lie.
  const Spread before = spreadIn(
      points, bandAround(surface, cells.centre - 3 * BAND * cells.scale, cells.centre + BAND * cells.scale));
  const double band = BAND * before.scale;
  fitToMeans(surface, points, before.centre - band, before.centre + band);
  const Spread fitted = spreadIn(points, bandAround(surface, -2 * band, 2 * band));
  GroundPoints ground{fitted.scale};
  if (growsOnTheGround(surface, points, fitted, usual)) {
    ground.spread = sinkThroughPlants(surface, points, fitted.scale, usual);
    ground.sunk = true;
  }
  return ground;
}

}  // namespace pcl_fft_ground::core
