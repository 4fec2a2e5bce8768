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

/// Chosen cells and the empty ones between those of them that lie close to each other.
Mask joined(const Mask& chosen, const Mask& observed) {
  constexpr Eigen::Index REACH = 2;  // as there may be but one point to four cells
  const Mask closed = !dilated(!dilated(chosen, REACH), REACH);
  return chosen || (closed && !observed);
}

/// The regions of a mask that are longer and cover more than the largest object, and are not thin.
Mask largeRegions(const Mask& mask, double object_cells) {
  constexpr double LONGER = 1.25, BREADTH = 0.2;  // of the largest object
  const auto reach = static_cast<Eigen::Index>(std::round(0.5 * (BREADTH * object_cells - 1)));
  return regionsAround(mask, eroded(mask, std::max<Eigen::Index>(reach, 0)),
                       {LONGER * object_cells, object_cells * object_cells});
}

}  // namespace

Mask groundAboveBreaks(const ElevationGrid& elevation, const Mask& ground, const ObjectSize& object) {
  constexpr double GENTLE = 0.15, STEEP = 0.3;  // slopes
  constexpr Eigen::Index BESIDE = 2;            // cells
  const Mask& observed = elevation.observed;
  const double object_cells = object.largest / elevation.geometry.cell_size;
  const Mask above = observed && !ground;
  const Mask none = Mask::Constant(above.rows(), above.cols(), false);
  if (!largeRegions(joined(above, observed), object_cells).any()) return none;

  const auto standing = [&](double slope) -> Mask {
    return above && openedGround(elevation, {object.largest, slope, object.least_height});
  };
  const Mask gentle = standing(GENTLE);
  const Mask large = largeRegions(joined(gentle, observed), object_cells);
  if (!large.any()) return none;
  const Mask steep = standing(STEEP) && !(gentle && large);
  const Mask beside = regionsAround(joined(steep, observed), dilated(large, BESIDE), {object_cells});
  return (gentle && large) || (steep && beside);
}

void followGround(const ElevationGrid& elevation, const Mask& ground, double spread, double deepest,
                  Eigen::ArrayXXd& surface) {
  constexpr double SPREADS = 3;
  // A cell's height is that of its lowest points, the surface lies amid them.
  std::vector<float> residuals;
  RadixSort sort;
  for (Eigen::Index n = 0; n < surface.size(); ++n) {
    const double residual = elevation.elevation.data()[n] - surface.data()[n];
    if (ground.data()[n] && std::abs(residual) < 2 * SPREADS * spread)
      residuals.push_back(static_cast<float>(residual));
  }
  const double offset = medianSpread(residuals, sort).centre;
  for (Eigen::Index n = 0; n < surface.size(); ++n) {
    const double residual = elevation.elevation.data()[n] - surface.data()[n] - offset;
    if (ground.data()[n] && std::abs(residual) > SPREADS * spread && residual > -deepest)
      surface.data()[n] += residual;
  }
}

}  // namespace pcl_fft_ground::core
