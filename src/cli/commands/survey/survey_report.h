#pragma once

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "commands/survey/survey_run.h"

namespace pcl_fft_ground::cli {

/// The content of survey.json of one survey: both tables and the global alignment.
/// \param mapping the method whose pairs the global alignment rests on
nlohmann::ordered_json makeSurveyReport(const SurveyOutcome& outcome, const std::string& mapping);

/// The tables and the global alignment for a reader.
void printSurvey(std::ostream& out, const SurveyOutcome& outcome, const std::string& mapping);

/** Several surveys taken together: all pairs in one table. Of the poses' errors the root mean square over all
 * sub-maps, the largest, and the median of the surveys' medians.
 *
 * \param outcomes one or more
 */
SurveyOutcome pooled(const std::vector<SurveyOutcome>& outcomes);

}  // namespace pcl_fft_ground::cli
