#pragma once

#include <Eigen/Geometry>
#include <string>

#include "pcl_fft_ground/simulation/simulation.h"

namespace pcl_fft_ground::cli {

/// Whether a file gets a field `ground` (float32): z of the true ground at each point's x and y [m].
enum class GroundHeights { OMIT, WRITE };

/// Writes a simulated scan as a binary PCD file, whole or not at all: x y z [m], label and segment (int32).
/// \param viewpoint the pose that the file gives as VIEWPOINT
/// \throws WorkError naming the file
void writeSimulatedScan(const std::string& path, const core::SimulatedScan& scan,
                        const Eigen::Isometry3d& viewpoint, GroundHeights heights = GroundHeights::OMIT);

}  // namespace pcl_fft_ground::cli
