#pragma once

#include <cstdint>
#include <optional>

#include "pcl_fft_ground/core/ground/ground_surface.h"
#include "pcl_fft_ground/core/scan/points.h"
#include "pcl_fft_ground/export.h"

namespace pcl_fft_ground {

/// Settings of fitPlane(); the defaults are those of the paper's benchmark, as far as it names them.
struct PlaneFitParameters {
  double distance_threshold = 0.02;   ///< distance up to which a point lies on the plane [m], > 0
  int max_iterations = 1000;          ///< most planes to try, >= 1
  double probability = 0.99;          ///< of having tried a sample without outliers, (0, 1)
  bool optimize_coefficients = true;  ///< whether the plane is fitted to all of its inliers in the end
  std::uint32_t seed = 1;             ///< of the samples
};

/** Fits a plane by PCL's MLESAC (Sec. V-B2).
 *
 * The points are sorted first, so that the plane depends on their set only, not on their order.
 *
 * \param points points in the level frame
 * \return nothing where no plane is found, or only one that stands upright (within 0.6 degrees)
 */
PCL_FFT_GROUND_FILTERS_EXPORT std::optional<core::Plane> fitPlane(const core::Points& points,
                                                                  const PlaneFitParameters& parameters);

}  // namespace pcl_fft_ground
