#pragma once

#include <string>
#include <vector>

namespace pcl_fft_ground::cli {

/** \brief `pcl_fft_ground simulate survey wreck|pipes -o DIR ...`: writes the sub-maps of a survey and their
 *  true poses.
 *  \param arguments what follows `simulate survey` on the command line
 *  \throws UsageError for unknown options and values out of range
 *  \throws WorkError where a file cannot be written */
void runSimulateSurvey(const std::vector<std::string>& arguments);

}  // namespace pcl_fft_ground::cli
