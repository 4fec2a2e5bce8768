#pragma once

#include <vector>

namespace pcl_fft_ground::core {

/** Sorts values in ascending order, digit by digit: for thousands of values several times as fast as by
 * comparisons, whose outcome no processor can foresee.
 * \param values no NaN
 */
void radixSort(std::vector<float>& values);

}  // namespace pcl_fft_ground::core
