#pragma once

#include <cstdint>
#include <vector>

namespace pcl_fft_ground::core {

/// What a point is said to be. The values are those of the `label` field in the files of the project.
enum class Label : std::uint8_t {
  GROUND = 0,   ///< on or below the ground surface
  OBJECT = 1,   ///< above the ground surface
  NEITHER = 2,  ///< not finite, or not to be scored
};

/// One label per point, in the order of the points.
using Labels = std::vector<Label>;

}  // namespace pcl_fft_ground::core
