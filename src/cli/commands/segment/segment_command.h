#pragma once

#include <string>
#include <vector>

namespace pcl_fft_ground::cli {

/** `pcl_fft_ground segment CLOUD -o DIR ...`: splits a scan into ground, objects and segments.
 * \param arguments what follows `segment` on the command line
 * \throws UsageError for unknown options and values out of range
 * \throws WorkError for anything about the cloud or the outputs
 */
void runSegment(const std::vector<std::string>& arguments);

}  // namespace pcl_fft_ground::cli
