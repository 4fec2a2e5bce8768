#pragma once

#include <string>
#include <vector>

namespace pcl_fft_ground::cli {

/** \brief `pcl_fft_ground align REFERENCE MOVING -o DIR ...`: aligns two overlapping scans by their segments.
 *  \param arguments what follows `align` on the command line
 *  \throws UsageError for unknown options and values out of range
 *  \throws WorkError where a scan cannot be used or an output cannot be written */
void runAlign(const std::vector<std::string>& arguments);

}  // namespace pcl_fft_ground::cli
