#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/evaluation.h"

namespace pcl_fft_ground::cli {

/// How one method did on one cloud.
struct EvaluationRow {
  std::string cloud;
  std::string method;
  core::Confusion confusion;
  std::optional<double> surface_rmse;  ///< of the ground surface at the true ground points [m]
  double seconds = 0;                  ///< of the segmentation alone
  std::string failure;                 ///< why there are no scores; empty if there are
};

/// The table as in the paper's Table I: a row per method, TPR, TNR and F1 per cloud, then the means over the
/// clouds.
void printTable(std::ostream& out, const std::vector<EvaluationRow>& rows);

/// All measures, a line per cloud and method.
std::string asCsv(const std::vector<EvaluationRow>& rows);

/// All measures per cloud and method, and their means per method.
nlohmann::ordered_json asJson(const std::vector<EvaluationRow>& rows);

}  // namespace pcl_fft_ground::cli
