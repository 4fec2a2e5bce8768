#pragma once

#include <stdexcept>

namespace pcl_fft_ground::cli {

/// The work failed: something about a file, its points or the outputs. The command exits with 1.
class WorkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The command was called wrongly: an unknown option or a value out of range. The command exits with 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace pcl_fft_ground::cli
