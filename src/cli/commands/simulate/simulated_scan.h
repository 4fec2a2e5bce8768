#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "errors.h"
#include "pcl_fft_ground/simulation/simulation.h"

namespace pcl_fft_ground::cli {

/// `pcl_fft_ground simulate survey wreck|pipes -o DIR ...`: writes a survey whose truth is known.
void runSimulateSurvey(const std::vector<std::string>& arguments);

/// A count, read as a signed number because the parser would take -1 for the largest unsigned one.
/// \throws UsageError for one below 0 or above `most`
template <typename Count>
Count toCount(const char* option, long long value, long long most) {
  if (value < 0 || value > most)
    throw UsageError(std::string("--") + option + " " + std::to_string(value) +
                     ": allowed is a whole number from 0 to " + std::to_string(most));
  return static_cast<Count>(value);
}

/// Runs a part of the simulation; its complaint about a parameter becomes one about the option that sets it.
/// \throws UsageError in place of std::invalid_argument
void withOptionNames(const std::function<void()>& simulate);

/// Whether a file gets a field `ground` (float32): z of the true ground at each point's x and y [m].
enum class GroundHeights { OMIT, WRITE };

/// Writes a simulated scan as a binary PCD file, whole or not at all: x y z [m], label and segment (int32).
/// \param viewpoint the pose that the file gives as VIEWPOINT
/// \throws WorkError naming the file
void writeSimulatedScan(const std::string& path, const core::SimulatedScan& scan,
                        const Eigen::Isometry3d& viewpoint, GroundHeights heights = GroundHeights::OMIT);

}  // namespace pcl_fft_ground::cli
