#pragma once

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "survey/survey_map.h"
#include "survey/survey_poses.h"

namespace pcl_fft_ground::cli {

/// What the global alignment came to.
struct GlobalResult {
  std::string method;  ///< whose pairs were used
  SurveyPoses poses;
  SiteCrispness crispness;
};

/// The content of survey.json: parameters, both tables and the global alignment.
nlohmann::ordered_json makeSurveyReport(const SurveyFolder& survey, const std::vector<PairResult>& results,
                                        const GlobalResult& global, const nlohmann::ordered_json& parameters);

/// The tables and the global alignment for a reader.
void printSurvey(std::ostream& out, const SurveyFolder& survey, const std::vector<PairResult>& results,
                 const GlobalResult& global);

}  // namespace pcl_fft_ground::cli
