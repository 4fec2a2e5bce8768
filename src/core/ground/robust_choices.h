#pragma once

#include "pcl_fft_ground/core/ground/robust_ground.h"

namespace pcl_fft_ground::core {

/// Ground usually lies closer to the surface than this share of the largest object.
constexpr double USUAL_TOLERANCE = 0.0098;
/// Nor is ground deeper below it than this share.
constexpr double USUAL_DEPTH = 0.03;

}  // namespace pcl_fft_ground::core
