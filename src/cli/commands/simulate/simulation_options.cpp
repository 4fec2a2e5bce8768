#include "commands/simulate/simulation_options.h"

#include <algorithm>
#include <stdexcept>

namespace pcl_fft_ground::cli {
namespace {

/// "tilt_degrees = 90: ..." becomes "--tilt = 90: ...".
std::string asOption(const std::string& message) {
  const std::size_t end = message.find(' ');
  std::string name = message.substr(0, end);
  if (name == "tilt_degrees") name = "tilt";
  std::replace(name.begin(), name.end(), '_', '-');
  return "--" + name + message.substr(end);
}

}  // namespace

void withOptionNames(const std::function<void()>& simulate) {
  try {
    simulate();
  } catch (const std::invalid_argument& error) {
    throw UsageError(asOption(error.what()));
  }
}

}  // namespace pcl_fft_ground::cli
