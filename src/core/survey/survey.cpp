#include "pcl_fft_ground/core/survey/survey.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "align/rigid_motion.h"
#include "pcl_fft_ground/core/align/crispness.h"
#include "scan/parameter_check.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double DEGREE = static_cast<double>(EIGEN_PI / 180);
constexpr std::size_t MOST_NEIGHBOURS = 6;  // that a newcomer is aligned with: those it overlaps most

/// The result of a pair as far as it does not depend on what was found.
PairResult resultFor(const PlannedPair& pair, const std::vector<SurveyScan>& scans,
                     const Eigen::Isometry3d& guess) {
  PairResult result;
  result.kind = pair.kind;
  result.reference = pair.scans.reference;
  result.moving = pair.scans.moving;
  result.overlap = overlapShare(scans[result.reference].coverage, scans[result.moving].coverage, guess);
  result.reference_from_moving = guess;
  return result;
}

PairStatus statusOf(const Alignment& alignment, bool lacks_segments) {
  if (alignment.accepted) return PairStatus::ALIGNED;
  return lacks_segments ? PairStatus::UNPROCESSED : PairStatus::REFUSED;
}

}  // namespace

void validate(const NavigationSigmas& sigmas) {
  const auto positive = [](const char* name, double value) {
    require(std::isfinite(value) && value > 0, name, value, "a finite number above 0");
  };
  positive("horizontal", sigmas.horizontal);
  positive("heading", sigmas.heading);
  positive("vertical", sigmas.vertical);
  positive("tilt", sigmas.tilt);
}

SurveyScan surveyScan(const PointsView& points, const Eigen::Isometry3d& world_from_scan,
                      const NavigationSigmas& sigmas) {
  constexpr double CELLS_PER_VOXEL = 2.5;  // as in the description of a scan by its segments
  return {world_from_scan, points.cast<double>().rowwise().mean(),
          coverageOf(points, CELLS_PER_VOXEL * voxelSizeFor(points)), sigmas};
}

std::vector<PlannedPair> planPairs(const std::vector<SurveyScan>& scans) {
  std::vector<Eigen::Vector3d> centroids;
  std::vector<ScanCoverage> coverages;
  std::vector<Eigen::Isometry3d> poses;
  for (const SurveyScan& scan : scans) {
    centroids.push_back(scan.world_from_scan * scan.centroid);
    coverages.push_back(scan.coverage);
    poses.push_back(scan.world_from_scan);
  }
  const std::vector<SubmapPair> chain = chainPairs(centroids);
  std::vector<PlannedPair> pairs;
  pairs.reserve(chain.size());
  for (const SubmapPair& pair : chain) pairs.push_back({pair, PairKind::CHAIN});
  for (const SubmapPair& pair : otherOverlappingPairs(coverages, poses, chain, LEAST_OVERLAP))
    pairs.push_back({pair, PairKind::OTHER});
  return pairs;
}

std::vector<PlannedPair> pairsOfNewcomer(std::size_t newcomer, const std::vector<SurveyScan>& scans,
                                         const std::vector<Eigen::Isometry3d>& poses) {
  std::vector<std::pair<double, std::size_t>> overlaps;  // with a minus, so that the widest comes first
  for (std::size_t i = 0; i < newcomer; ++i) {
    if (!mayOverlap(scans[i].coverage, poses[i], scans[newcomer].coverage, poses[newcomer])) continue;
    const double share =
        overlapShare(scans[i].coverage, scans[newcomer].coverage, poses[i].inverse() * poses[newcomer]);
    if (share >= LEAST_OVERLAP) overlaps.emplace_back(-share, i);
  }
  std::sort(overlaps.begin(), overlaps.end());
  overlaps.resize(std::min(overlaps.size(), MOST_NEIGHBOURS));
  std::vector<PlannedPair> pairs;
  pairs.reserve(overlaps.size());
  for (const auto& [share, i] : overlaps)
    pairs.push_back({{i, newcomer}, pairs.empty() ? PairKind::CHAIN : PairKind::OTHER});
  return pairs;
}

double PairResult::crispnessChange() const {
  return core::crispnessChange(nx_before, nx_after);
}

Eigen::Isometry3d guessOf(const SubmapPair& pair, const std::vector<SurveyScan>& scans) {
  return scans[pair.reference].world_from_scan.inverse() * scans[pair.moving].world_from_scan;
}

PairResult alignPair(const PlannedPair& pair, const std::vector<SurveyScan>& scans,
                     const ScanSegments& moving, const ScanSegments& reference,
                     const Eigen::Isometry3d& guess, const AlignmentParameters& parameters,
                     PairAlignment how) {
  using Clock = std::chrono::steady_clock;
  PairResult result = resultFor(pair, scans, guess);
  const Clock::time_point begun = Clock::now();
  const Alignment alignment = how == PairAlignment::DENSE ? alignDensely(moving, reference, guess, parameters,
                                                                         DensePoints::EVERYWHERE)
                                                          : alignScans(moving, reference, guess, parameters);
  result.seconds = std::chrono::duration<double>(Clock::now() - begun).count();
  const bool lacks_segments =
      how == PairAlignment::SEGMENTS && (moving.segments.empty() || reference.segments.empty());
  result.status = statusOf(alignment, lacks_segments);
  result.refusal = alignment.refusal;
  result.matches = alignment.matches.size();
  result.score = alignment.score;
  if (!alignment.accepted) return result;
  result.reference_from_moving = alignment.reference_from_moving;
  result.covariance = alignment.covariance;
  return result;
}

PairResult notRun(const PlannedPair& pair, const std::vector<SurveyScan>& scans, const std::string& reason) {
  PairResult result = resultFor(pair, scans, guessOf(pair.scans, scans));
  result.status = PairStatus::NOT_RUN;
  result.refusal = reason;
  return result;
}

PairResult withCrispness(PairResult result, const Eigen::Isometry3d& guess, const PointsView& moving,
                         const PointsView& reference) {
  result.nx_before = occupiedVoxels(moving, reference, guess);
  result.nx_after = result.nx_before;
  result.crispness_before = overlapCrispness(moving, reference, guess);
  result.crispness_after = result.crispness_before;
  if (result.status != PairStatus::ALIGNED) return result;
  result.nx_after = occupiedVoxels(moving, reference, result.reference_from_moving);
  result.crispness_after = overlapCrispness(moving, reference, result.reference_from_moving);
  return result;
}

PairResult withErrors(PairResult result, const std::vector<SurveyScan>& scans,
                      const std::vector<Eigen::Isometry3d>& world_from_scan) {
  const SurveyScan &reference = scans[result.reference], &moving = scans[result.moving];
  const Eigen::Isometry3d truth =
      world_from_scan[result.reference].inverse() * world_from_scan[result.moving];
  result.overlap = overlapShare(reference.coverage, moving.coverage, truth);
  result.translation_error =
      (truth * moving.centroid - result.reference_from_moving * moving.centroid).norm();
  result.rotation_error = angleBetween(truth, result.reference_from_moving) / DEGREE;
  return result;
}

}  // namespace pcl_fft_ground::core
