#pragma once

#include <functional>
#include <string>

#include "errors.h"

namespace pcl_fft_ground::cli {

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

}  // namespace pcl_fft_ground::cli
