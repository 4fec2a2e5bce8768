#pragma once

#include <boost/program_options.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "align/alignment_options.h"
#include "survey/survey_poses.h"

namespace pcl_fft_ground::cli {

/// What the user wants done with a survey.
struct SurveyRequest {
  std::string folder;                ///< of the sub-maps
  std::string directory;             ///< for the results
  std::vector<std::string> methods;  ///< in the order of the tables
  std::string mapping;               ///< method of the global alignment
  NavigationTrust trust;
  AlignmentSettings settings;
  std::vector<Segmenter> segmenters;  ///< one for each method that needs one
  nlohmann::ordered_json parameters;  ///< all that the results depend on
};

/// The options of the command but those of the alignment and the segmentation.
boost::program_options::options_description surveyOptions();

/// What the options ask for.
/// \throws UsageError naming the option, the value and what is allowed
/// \throws WorkError naming the folder that holds no survey
SurveyRequest parseSurveyRequest(const boost::program_options::variables_map& values);

}  // namespace pcl_fft_ground::cli
