#pragma once

#include <string>
#include <vector>

namespace pcl_fft_ground::cli {

/** \brief `pcl_fft_ground simulate wreck|pipes|reef -o FILE ...`: writes one labelled scan.
 *
 *  `simulate survey ...` is passed on to runSimulateSurvey().
 *  \param arguments what follows `simulate` on the command line
 *  \throws UsageError for unknown options and values out of range
 *  \throws WorkError where the file cannot be written */
void runSimulate(const std::vector<std::string>& arguments);

}  // namespace pcl_fft_ground::cli
