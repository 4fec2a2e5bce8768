#include "commands/survey/survey_alignment.h"

#include <chrono>

#include "pcl_fft_ground/core/align/crispness.h"
#include "pcl_fft_ground/core/align/dense_alignment.h"

namespace pcl_fft_ground::cli {
namespace {

Eigen::Isometry3d relativePose(const std::vector<Eigen::Isometry3d>& poses, const core::SubmapPair& pair) {
  return poses[pair.reference].inverse() * poses[pair.moving];
}

std::vector<Eigen::Isometry3d> navigationOf(const SurveyFolder& survey) {
  std::vector<Eigen::Isometry3d> poses;
  for (const Submap& submap : survey.submaps) poses.push_back(submap.navigation);
  return poses;
}

core::Alignment align(const PairTask& task, const core::ScanSegments& moving,
                      const core::ScanSegments& reference, const Eigen::Isometry3d& guess,
                      core::AlignmentParameters parameters) {
  if (task.method == DENSE_ICP)
    return core::alignDensely(moving, reference, guess, parameters, core::DensePoints::EVERYWHERE);
  if (segmenterOf(task.method) != task.method) parameters.fallback = core::Fallback::DENSE;
  return core::alignScans(moving, reference, guess, parameters);
}

bool lacksSegments(const PairTask& task, const core::ScanSegments& moving,
                   const core::ScanSegments& reference) {
  return task.method != DENSE_ICP && (moving.segments.empty() || reference.segments.empty());
}

PairStatus statusOf(const core::Alignment& alignment, bool lacks_segments) {
  if (alignment.accepted) return PairStatus::ALIGNED;
  return lacks_segments ? PairStatus::UNPROCESSED : PairStatus::REFUSED;
}

void measureCrispness(const Eigen::Isometry3d& guess, const core::SubmapPair& pair, SurveyScans& scans,
                      PairResult& result) {
  const core::Points& moving = scans.points(pair.moving);
  const core::Points& reference = scans.points(pair.reference);
  result.nx_before = core::occupiedVoxels(moving, reference, guess);
  result.nx_after = result.nx_before;
  result.crispness_before = core::overlapCrispness(moving, reference, guess);
  result.crispness_after = result.crispness_before;
  if (result.status != PairStatus::ALIGNED) return;
  result.nx_after = core::occupiedVoxels(moving, reference, result.reference_from_moving);
  result.crispness_after = core::overlapCrispness(moving, reference, result.reference_from_moving);
}

/// How far the result is from the truth, at the middle of the moving sub-map.
void measureErrors(const Eigen::Isometry3d& truth, const Eigen::Vector3d& centroid, PairResult& result) {
  constexpr double DEGREE = EIGEN_PI / 180;
  result.translation_error = (truth * centroid - result.reference_from_moving * centroid).norm();
  const Eigen::AngleAxisd turn(truth.linear().transpose() * result.reference_from_moving.linear());
  result.rotation_error = turn.angle() / DEGREE;
}

}  // namespace

std::vector<PairTask> planPairs(const SurveyFolder& survey, const std::vector<std::string>& methods,
                                const std::string& mapping) {
  std::vector<Eigen::Vector3d> centroids;
  std::vector<core::ScanCoverage> coverages;
  for (const Submap& submap : survey.submaps) {
    centroids.push_back(submap.navigation * submap.centroid);
    coverages.push_back(submap.coverage);
  }
  const std::vector<core::SubmapPair> chain = core::chainPairs(centroids);
  std::vector<PairTask> tasks;
  for (const core::SubmapPair& pair : chain)
    for (const std::string& method : methods) tasks.push_back({method, PairKind::CHAIN, pair});
  for (const core::SubmapPair& pair :
       core::otherOverlappingPairs(coverages, navigationOf(survey), chain, LEAST_OVERLAP))
    tasks.push_back({mapping, PairKind::OTHER, pair});
  return tasks;
}

PairResult alignPair(const PairTask& task, const SurveyFolder& survey, SurveyScans& scans,
                     const AlignmentSettings& settings) {
  using Clock = std::chrono::steady_clock;
  const Submap& reference = survey.submaps[task.pair.reference];
  const Submap& moving = survey.submaps[task.pair.moving];
  const Eigen::Isometry3d guess = reference.navigation.inverse() * moving.navigation;
  const bool has_truth = !survey.truth.empty();
  const Eigen::Isometry3d truth = has_truth ? relativePose(survey.truth, task.pair) : guess;
  const core::ScanSegments& moving_segments = scans.segments(task.method, task.pair.moving);
  const core::ScanSegments& reference_segments = scans.segments(task.method, task.pair.reference);

  PairResult result;
  result.method = task.method;
  result.kind = task.kind;
  result.reference = task.pair.reference;
  result.moving = task.pair.moving;
  const Clock::time_point begun = Clock::now();
  const core::Alignment alignment =
      align(task, moving_segments, reference_segments, guess, settings.alignment);
  result.seconds = std::chrono::duration<double>(Clock::now() - begun).count();
  result.status = statusOf(alignment, lacksSegments(task, moving_segments, reference_segments));
  result.refusal = alignment.refusal;
  result.matches = alignment.matches.size();
  result.score = alignment.score;
  result.overlap = core::overlapShare(reference.coverage, moving.coverage, truth);
  result.reference_from_moving = alignment.accepted ? alignment.reference_from_moving : guess;
  if (alignment.accepted) result.covariance = alignment.covariance;
  measureCrispness(guess, task.pair, scans, result);
  if (has_truth) measureErrors(truth, moving.centroid, result);
  return result;
}

}  // namespace pcl_fft_ground::cli
