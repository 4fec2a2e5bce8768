#include "commands/survey/survey_run.h"

#include <stdexcept>

#include "commands/survey/survey_alignment.h"
#include "commands/survey/survey_map.h"
#include "commands/survey/survey_record.h"
#include "errors.h"
#include "io/output_file.h"
#include "io/pose_table.h"

namespace pcl_fft_ground::cli {
namespace {

/// Aligns what the record does not have yet.
std::vector<PairResult> alignPairs(const SurveyTask& task, SurveyRequest& request, const SurveyFolder& survey,
                                   Progress& progress) {
  std::vector<std::string> names;
  for (const Submap& submap : survey.submaps) names.push_back(submap.name);
  SurveyRecord record(task.directory, task.parameters, names);
  SurveyScans scans(survey.submaps, request.settings, request.segmenters);
  const std::vector<PairTask> pairs = planPairs(survey, request.methods, request.mapping);
  std::vector<PairResult> results;
  for (const PairTask& pair : pairs) {
    const PairResult* known = record.find(pair);
    if (known == nullptr) {
      progress.begin("align", task.name + " [" + std::to_string(results.size() + 1) + "/" +
                                  std::to_string(pairs.size()) + "] " + names[pair.pair.reference] + " and " +
                                  names[pair.pair.moving] + ": " + pair.method);
      record.add(alignPair(pair, survey, scans, request.settings));
      known = &record.results().back();
    }
    results.push_back(*known);
  }
  return results;
}

void writePoses(const std::string& directory, const SurveyFolder& survey,
                const std::vector<Eigen::Isometry3d>& poses) {
  std::vector<NamedPose> table;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Submap& submap = survey.submaps[i];
    table.push_back({submap.name, poses[i] * Eigen::Translation3d(-submap.origin)});
  }
  writeText(directory + "/poses.csv", asCsv(table));
}

Placement placementOf(const char* name, std::size_t voxels, const SurveyFolder& survey,
                      const std::vector<Eigen::Isometry3d>& poses) {
  Placement placement{name, voxels, std::nullopt};
  if (!survey.truth.empty()) placement.errors = poseErrors(survey, poses);
  return placement;
}

/// Solves for the poses.
SurveyPoses posesOf(const SurveyTask& task, const SurveyFolder& survey, const std::vector<PairResult>& pairs,
                    const SurveyRequest& request) {
  try {
    return solveSurvey(survey, pairs, request.mapping, request.trust);
  } catch (const std::logic_error& error) {  // of the core, about covariances and the like
    throw WorkError(task.folder + ": global alignment by the pairs in " + task.directory +
                    "/pairs.csv: " + error.what());
  } catch (const std::runtime_error& error) {
    throw WorkError(task.folder + ": global alignment: " + error.what());
  }
}

}  // namespace

SurveyOutcome processSurvey(const SurveyTask& task, SurveyRequest& request, Progress& progress) {
  const auto reportReading = [&](std::size_t submap) {
    progress.begin("read", task.name + ": reading sub-map " + std::to_string(submap));
  };
  const SurveyFolder survey = readSurvey(task.folder, reportReading);
  SurveyOutcome outcome;
  outcome.name = task.name;
  outcome.submaps = survey.submaps.size();
  for (const Submap& submap : survey.submaps)
    if (!submap.origin.isZero())
      outcome.origins[submap.name] = {submap.origin.x(), submap.origin.y(), submap.origin.z()};
  outcome.pairs = alignPairs(task, request, survey, progress);
  const SurveyPoses poses = posesOf(task, survey, outcome.pairs, request);
  outcome.edges = poses.edges;
  outcome.rejected_edges = poses.rejected_edges;
  writePoses(task.directory, survey, poses.global);
  const SiteCrispness voxels = writeSiteMap(task.directory, survey, poses, reportReading);
  outcome.placements = {placementOf("navigation", voxels.navigation, survey, poses.navigation),
                        placementOf("chained", voxels.chained, survey, poses.chained),
                        placementOf("global", voxels.global, survey, poses.global)};
  return outcome;
}

}  // namespace pcl_fft_ground::cli
