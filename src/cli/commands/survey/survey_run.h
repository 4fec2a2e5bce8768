#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands/survey/survey_pairs.h"
#include "commands/survey/survey_scans.h"
#include "progress.h"

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
  core::NavigationSigmas sigmas;
  AlignmentSettings settings;
  std::vector<Segmenter> segmenters;  ///< one for each method that needs one
  std::optional<Shard> shard;         ///< of the pairs, where other runs do the rest
};

/// The sub-maps placed in one way.
struct Placement {
  const char* name = "";
  std::size_t voxels = 0;  ///< of 2 cm that all sub-maps together occupy: the fewer, the crisper
  std::optional<core::PoseErrors> errors;  ///< where the truth is known
};

/// What came of a survey.
struct SurveyOutcome {
  std::string name;
  std::size_t submaps = 0;
  std::vector<LeftOut> left_out;
  std::vector<FileRemark> remarks;  ///< what there is to say of how the files were read
  std::vector<core::PairResult> pairs;
  nlohmann::ordered_json origins;      ///< by sub-map, what is subtracted from its coordinates, where that is
  nlohmann::ordered_json voxel_sizes;  ///< by sub-map [m]; of a pair the larger of the two is in force
  std::size_t edges = 0;               ///< aligned pairs that the global alignment rests on
  std::size_t rejected_edges = 0;      ///< of these, such that it found false
  std::array<Placement, 3> placements;  ///< by navigation, chained and by the global alignment
};

/** Aligns the sub-maps of a survey pair by pair, then all of them, and writes the results but the report.
 *
 * What an earlier run with the same parameters has done is not done again.
 *
 * \throws WorkError naming the file or folder that cannot be read or written
 */
SurveyOutcome processSurvey(const SurveyTask& task, SurveyRequest& request, Progress& progress);

/** Aligns the pairs of the request's shard and leaves the rest to other runs: one of all pairs goes on from
 * there.
 * \return how many pairs the shard has
 */
std::size_t processShard(const SurveyTask& task, SurveyRequest& request, Progress& progress);

}  // namespace pcl_fft_ground::cli
