#include "commands/survey/survey_run.h"

#include <mutex>
#include <stdexcept>

#include "commands/survey/survey_pairs.h"
#include "commands/survey/survey_report.h"
#include "errors.h"
#include "io/output_file.h"
#include "io/pose_table.h"
#include "pcl_fft_ground/core/scan/threads.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

/// A pair that is to be aligned by one method.
struct PairTask {
  std::string method;
  core::PlannedPair pair;
};

/// The pairs of the chain by every method, all other pairs that overlap by the one that makes the map; of a
/// shard its share of them.
std::vector<PairTask> tasksOf(const SurveyFolder& survey, const SurveyRequest& request) {
  std::vector<PairTask> tasks;
  for (const core::PlannedPair& pair : core::planPairs(survey.scans)) {
    if (pair.kind == core::PairKind::OTHER)
      tasks.push_back({request.mapping, pair});
    else
      for (const std::string& method : request.methods) tasks.push_back({method, pair});
  }
  if (!request.shard) return tasks;
  std::vector<PairTask> of_shard;
  for (std::size_t n = request.shard->number - 1; n < tasks.size(); n += request.shard->count)
    of_shard.push_back(tasks[n]);
  return of_shard;
}

/// Aligns one pair from where navigation has it, and measures what came of it. The scans are described.
core::PairResult alignPair(const PairTask& task, const SurveyFolder& survey, SurveyScans& scans,
                           const SurveyRequest& request) {
  const core::SubmapPair& pair = task.pair.scans;
  const Eigen::Isometry3d guess = core::guessOf(pair, survey.scans);
  const SubmapDescription& moving = scans.described(task.method, pair.moving);
  const SubmapDescription& reference = scans.described(task.method, pair.reference);
  const std::string& error = moving.error.empty() ? reference.error : moving.error;
  core::AlignmentParameters parameters = request.settings.alignment;
  if (segmenterOf(task.method) != task.method) parameters.fallback = core::Fallback::DENSE;
  // Relief knows no segments: it is for the map, not for comparing methods by what their segments align.
  if (task.method != request.mapping) parameters.relief = core::ReliefUse::OFF;
  const auto how = task.method == DENSE_ICP ? core::PairAlignment::DENSE : core::PairAlignment::SEGMENTS;
  core::PairResult result = error.empty() ? core::alignPair(task.pair, survey.scans, moving.segments,
                                                            reference.segments, guess, parameters, how)
                                          : core::notRun(task.pair, survey.scans, "not run: " + error);
  result.method = task.method;
  const auto moving_points = scans.points(pair.moving), reference_points = scans.points(pair.reference);
  result = core::withCrispness(std::move(result), guess, *moving_points, *reference_points);
  if (survey.truth.empty()) return result;
  return core::withErrors(std::move(result), survey.scans, survey.truth);
}

/// Aligns what the record does not have yet: the sub-maps are described one after the other, with all threads
/// to each, then each thread takes pairs.
std::vector<core::PairResult> alignPairs(const SurveyTask& task, SurveyRequest& request,
                                         const SurveyFolder& survey, Progress& progress) {
  std::vector<std::string> names;
  for (const Submap& submap : survey.submaps) names.push_back(submap.name);
  SurveyRecord record(task.directory, task.parameters, names, request.shard);
  SurveyScans scans(survey.submaps, request.settings, request.segmenters);
  const std::vector<PairTask> pairs = tasksOf(survey, request);
  std::vector<const PairTask*> open;
  for (const PairTask& pair : pairs)
    if (record.find(pair.method, pair.pair.scans) == nullptr) open.push_back(&pair);
  for (const PairTask* pair : open)
    for (const std::size_t submap : {pair->pair.scans.moving, pair->pair.scans.reference}) {
      progress.begin("describe", task.name + ": " + pair->method + " on " + names[submap]);
      scans.describe(pair->method, submap);
    }
  std::mutex mutex;
  std::size_t begun = pairs.size() - open.size();
  core::forEachPart(static_cast<Eigen::Index>(open.size()), [&](Eigen::Index n) {
    const PairTask& pair = *open[static_cast<std::size_t>(n)];
    {
      const std::lock_guard<std::mutex> lock(mutex);
      progress.begin("align", task.name + " [" + std::to_string(++begun) + "/" +
                                  std::to_string(pairs.size()) + "] " + names[pair.pair.scans.reference] +
                                  " and " + names[pair.pair.scans.moving] + ": " + pair.method);
    }
    const core::PairResult result = alignPair(pair, survey, scans, request);
    const std::lock_guard<std::mutex> lock(mutex);
    record.add(result);
  });
  std::vector<core::PairResult> results;
  for (const PairTask& pair : pairs) results.push_back(*record.find(pair.method, pair.pair.scans));
  if (!request.shard) record.finish(results);
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
  if (!survey.truth.empty()) placement.errors = core::poseErrors(survey.scans, survey.truth, poses);
  return placement;
}

/// Solves for the poses.
core::SurveyPoses posesOf(const SurveyTask& task, const SurveyFolder& survey,
                          const std::vector<core::PairResult>& pairs, const std::string& mapping) {
  try {
    return core::solveSurvey(survey.scans, pairs, mapping);
  } catch (const std::logic_error& error) {  // of the core, about covariances and the like
    throw WorkError(task.folder + ": global alignment by the pairs in " + task.directory +
                    "/pairs.csv: " + error.what());
  } catch (const std::runtime_error& error) {
    throw WorkError(task.folder + ": global alignment: " + error.what());
  }
}

/// What there is to tell of the sub-maps before anything is aligned.
SurveyOutcome begunOutcome(const SurveyTask& task, const SurveyFolder& survey,
                           const AlignmentSettings& settings) {
  SurveyOutcome outcome;
  outcome.name = task.name;
  outcome.submaps = survey.submaps.size();
  outcome.left_out = survey.left_out;
  outcome.remarks = survey.remarks;
  for (const Submap& submap : survey.submaps) {
    outcome.voxel_sizes[submap.name] = settings.segments.voxel_size.value_or(submap.voxel_size);
    if (!submap.origin.isZero()) outcome.origins[submap.name] = asList(submap.origin);
  }
  return outcome;
}

}  // namespace

SurveyOutcome processSurvey(const SurveyTask& task, SurveyRequest& request, Progress& progress) {
  const auto reportReading = [&](std::size_t submap) {
    progress.begin("read", task.name + ": reading sub-map " + std::to_string(submap));
  };
  const SurveyFolder survey = readSurvey(task.folder, request.sigmas, reportReading);
  SurveyOutcome outcome = begunOutcome(task, survey, request.settings);
  outcome.pairs = alignPairs(task, request, survey, progress);
  const core::SurveyPoses poses = posesOf(task, survey, outcome.pairs, request.mapping);
  outcome.edges = poses.edges;
  outcome.rejected_edges = poses.rejected_edges;
  writePoses(task.directory, survey, poses.global);
  const SiteCrispness voxels = writeSiteMap(task.directory, survey, poses, reportReading);
  outcome.placements = {placementOf("navigation", voxels.navigation, survey, poses.navigation),
                        placementOf("chained", voxels.chained, survey, poses.chained),
                        placementOf("global", voxels.global, survey, poses.global)};
  return outcome;
}

std::size_t processShard(const SurveyTask& task, SurveyRequest& request, Progress& progress) {
  const SurveyFolder survey = readSurvey(task.folder, request.sigmas, [&](std::size_t submap) {
    progress.begin("read", task.name + ": reading sub-map " + std::to_string(submap));
  });
  return alignPairs(task, request, survey, progress).size();
}

}  // namespace pcl_fft_ground::cli
