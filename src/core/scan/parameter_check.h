#pragma once

#include <sstream>
#include <stdexcept>

namespace pcl_fft_ground::core {

/// \throws std::invalid_argument "name = value: allowed is ..." where a parameter is not valid
inline void require(bool valid, const char* name, double value, const char* allowed) {
  if (valid) return;
  std::ostringstream message;
  message << name << " = " << value << ": allowed is " << allowed;
  throw std::invalid_argument(message.str());
}

/// As above, for a value that is outside its range or no number.
inline void requireWithin(const char* name, double value, double low, double high, const char* allowed) {
  require(value >= low && value <= high, name, value, allowed);  // false for NaN too
}

}  // namespace pcl_fft_ground::core
