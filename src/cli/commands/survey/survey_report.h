#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "commands/survey/survey_run.h"

namespace pcl_fft_ground::cli {

/// The content of survey.json of one survey: both tables and the global alignment.
/// \param mapping the method whose pairs the global alignment rests on
nlohmann::ordered_json makeSurveyReport(const SurveyOutcome& outcome, const std::string& mapping);

/// Both tables in the paper's layout.
void printTables(std::ostream& out, const std::vector<core::PairResult>& pairs);

/// The tables and the global alignment for a reader.
void printSurvey(std::ostream& out, const SurveyOutcome& outcome, const std::string& mapping);

/** Several surveys taken together: all pairs in one table. Of the poses' errors the root mean square over all
 * sub-maps, the largest, and the median of the surveys' medians.
 *
 * \param outcomes one or more
 */
SurveyOutcome pooled(const std::vector<SurveyOutcome>& outcomes);

/// The page of HTML that shows the results, those in the directories of the surveys and those of the reports.
/// \param outcomes of each survey, then, of several, of all together; likewise the reports
std::string surveyPage(const SurveyRequest& request, const std::vector<SurveyOutcome>& outcomes,
                       const std::vector<nlohmann::ordered_json>& reports);

/// Voxels of 2 cm that all sub-maps together occupy: the fewer, the crisper the whole.
struct SiteCrispness {
  std::size_t navigation = 0;
  std::size_t chained = 0;
  std::size_t global = 0;
};

/** Writes merged.pcd, all sub-maps as the global alignment places them (a point per cubic centimetre, with
 * the number of its sub-map), and the pictures site_before.png and site_after.png.
 *
 * Where the coordinates are large merged.pcd is relative to whole metres, which its VIEWPOINT gives.
 * The sub-maps are read once more, one at a time.
 *
 * \param report called with the number of each sub-map before it is read
 * \throws WorkError naming the file that cannot be read or written
 */
SiteCrispness writeSiteMap(const std::string& folder, const SurveyFolder& survey,
                           const core::SurveyPoses& poses, const std::function<void(std::size_t)>& report);

}  // namespace pcl_fft_ground::cli
