#pragma once

#include <boost/program_options.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands/align/alignment_options.h"
#include "commands/survey/survey_poses.h"

namespace pcl_fft_ground::cli {

/// One of the surveys asked for.
struct SurveyTask {
  std::string name;                   ///< of its folder
  std::string folder;                 ///< of the sub-maps
  std::string directory;              ///< for the results
  nlohmann::ordered_json parameters;  ///< all that the results depend on
};

/// What the user wants done with surveys.
struct SurveyRequest {
  std::string directory;             ///< for the results of all
  std::vector<SurveyTask> surveys;   ///< at least one; a single one has the directory for itself
  std::vector<std::string> methods;  ///< in the order of the tables
  std::string mapping;               ///< method of the global alignment
  NavigationTrust trust;
  AlignmentSettings settings;
  std::vector<Segmenter> segmenters;  ///< one for each method that needs one
};

/// The options of the command but those of the alignment and the segmentation.
boost::program_options::options_description surveyOptions();

/// What the options ask for.
/// \throws UsageError naming the option, the value and what is allowed
/// \throws WorkError naming the folder that holds no survey
SurveyRequest parseSurveyRequest(const boost::program_options::variables_map& values);

}  // namespace pcl_fft_ground::cli
