#pragma once

#include <ostream>
#include <vector>

#include "commands/evaluate/evaluation_row.h"

namespace pcl_fft_ground::cli {

/** Prints how the methods did, in at most 132 columns however many clouds there are.
 *
 * For each cloud, then for the means over several, a block with a row per method and a column per measure.
 * Where there are several clouds, the paper's Table I follows: a row per method, TPR, TNR and F1 side by side
 * for each cloud and for the mean, continued below where the page is full. A method that failed has its
 * reason in its row.
 */
void printTable(std::ostream& out, const std::vector<EvaluationRow>& rows);

}  // namespace pcl_fft_ground::cli
