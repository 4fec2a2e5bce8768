#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "pcl_fft_ground/simulation/evaluation.h"

namespace pcl_fft_ground::cli {

/// How one method did on one cloud.
struct EvaluationRow {
  std::string cloud;
  std::string method;
  core::Confusion confusion;
  std::optional<double> surface_rmse;  ///< of the estimated ground surface, where the method tells one,
                                       ///< against the true one [m]
  double seconds = 0;                  ///< of the segmentation alone
  std::string failure;                 ///< why there are no scores; empty if there are
};

/// A number that a row has.
struct Measure {
  const char* name;                                ///< as in the files
  std::function<double(const EvaluationRow&)> of;  ///< NaN where the row has none
};

/// Every measure, in the order of the files; the first three are those of the paper's Table I.
const std::vector<Measure>& measures();

/// The different values of a member, in the order of their first appearance.
std::vector<std::string> distinct(const std::vector<EvaluationRow>& rows, std::string EvaluationRow::*member);

/// Mean of a measure over the rows of a method that have it; NaN if none has.
double meanOf(const std::vector<EvaluationRow>& rows, const std::string& method, const Measure& measure);

/** Prints how the methods did, in at most 132 columns however many clouds there are.
 *
 * For each cloud, then for the means over several, a block with a row per method and a column per measure.
 * Where there are several clouds, the paper's Table I follows: a row per method, TPR, TNR and F1 side by side
 * for each cloud and for the mean, continued below where the page is full. A method that failed has its
 * reason in its row.
 */
void printTable(std::ostream& out, const std::vector<EvaluationRow>& rows);

/// All counts and measures, a line per cloud and method; what a row does not have is left empty.
std::string asCsv(const std::vector<EvaluationRow>& rows);

/// All counts and measures per cloud and method ("results") and the means per method ("means").
nlohmann::ordered_json asJson(const std::vector<EvaluationRow>& rows);

}  // namespace pcl_fft_ground::cli
