#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands/evaluate/evaluation_row.h"

namespace pcl_fft_ground::cli {

/// All counts and measures, a line per cloud and method; what a row does not have is left empty.
std::string asCsv(const std::vector<EvaluationRow>& rows);

/// All counts and measures per cloud and method ("results") and the means per method ("means").
nlohmann::ordered_json asJson(const std::vector<EvaluationRow>& rows);

}  // namespace pcl_fft_ground::cli
