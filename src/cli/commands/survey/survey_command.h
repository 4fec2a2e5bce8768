#pragma once

#include <string>
#include <vector>

namespace pcl_fft_ground::cli {

/** \brief `pcl_fft_ground survey FOLDER... -o DIR ...`: aligns the sub-maps of a survey: Table II and global
 * alignment.
 *
 * \param arguments what follows `survey` on the command line
 * \throws UsageError for unknown options and values out of range
 * \throws WorkError where a sub-map cannot be used or an output cannot be written
 */
void runSurvey(const std::vector<std::string>& arguments);

}  // namespace pcl_fft_ground::cli
