#pragma once

#include <string>
#include <vector>

namespace pcl_fft_ground::cli {

/** `pcl_fft_ground evaluate CLOUD... `: runs methods on labelled clouds and prints the paper's Table I.
 * \param arguments what follows `evaluate` on the command line
 * \throws UsageError for unknown options and values out of range
 * \throws WorkError for a cloud that cannot be read or has no labels
 */
void runEvaluate(const std::vector<std::string>& arguments);

}  // namespace pcl_fft_ground::cli
