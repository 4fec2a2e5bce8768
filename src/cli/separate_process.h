#pragma once

#include <functional>
#include <optional>
#include <string>

namespace pcl_fft_ground::cli {

/// How a function that ran in a process of its own came to its end.
enum class End {
  DONE,
  REFUSED,        ///< it threw a WorkError
  OUT_OF_MEMORY,  ///< or threw something else
  CRASHED,
  OUT_OF_TIME
};

/// What became of a function that ran in a process of its own.
struct Outcome {
  End end = End::DONE;
  std::string bytes;  ///< what the function returned, or the message of its WorkError
  int signal = 0;     ///< that ended it where it crashed
};

/** Runs a function of somebody else's library in a process of its own: one that never ends is stopped, one
 * that crashes takes nothing along. It must not rely on other threads, which a fork does not take along.
 *
 * \param time_limit after which it is stopped [s]; none: never
 * \throws std::system_error where there can be no process
 */
Outcome runApart(const std::function<std::string()>& function, std::optional<double> time_limit = {});

}  // namespace pcl_fft_ground::cli
