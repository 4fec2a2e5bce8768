#pragma once

#include <vector>

#include "scan/radix_sort.h"

namespace pcl_fft_ground::core {

/// Where values lie and how far they spread, whatever a minority of them does.
struct Spread {
  double centre = 0;  ///< [m]
  double scale = 0;   ///< of a normal distribution, its standard deviation [m], >= 0
};

/// Median and 1.4826 times the median distance from it; zero for no values. The values are reordered.
Spread medianSpread(std::vector<float>& values, RadixSort& sort);

/** The lowest significant peak of the values' histogram, and the spread below it: where the ground lies if
 * objects stand on it.
 * \param reach only values within [-reach, reach] are looked at [m], > 0
 */
Spread lowestMode(const std::vector<double>& values, double reach);

}  // namespace pcl_fft_ground::core
