#pragma once

#include <cstdint>
#include <vector>

namespace pcl_fft_ground::core {

/** Sorts values in ascending order, digit by digit: for thousands of values several times as fast as by
 * comparisons, whose outcome no processor can foresee. An object keeps its scratch space for the next time.
 */
class RadixSort {
 public:
  /// \param values no NaN
  void operator()(std::vector<float>& values);

 private:
  std::vector<std::uint32_t> keys_, sorted_;
};

}  // namespace pcl_fft_ground::core
