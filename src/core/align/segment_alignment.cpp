#include "pcl_fft_ground/core/align/segment_alignment.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "align/icp.h"
#include "align/segment_matching.h"
#include "align/verdict.h"
#include "pcl_fft_ground/core/align/relief_alignment.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double FIRST_GATE = 6;     // of ICP from the matched segments' places [voxels]
constexpr double REPEATED_GATE = 3;  // after segments were associated anew [voxels]
constexpr int ASSOCIATIONS = 2;
constexpr double SAME_PLACE = 2;  // solutions that differ by less are the same [voxels]
constexpr double NEARLY = 0.6;    // share of the best one's merit that makes another a rival

/// A hypothesis that ICP has made precise.
struct Solution {
  IcpResult icp;
  std::vector<SegmentMatch> matches;
  Agreement agreement;
  std::string refusal;
};

std::vector<SegmentMatch> segmentsOf(const std::vector<CandidateMatch>& hypothesis) {
  std::vector<SegmentMatch> matches;
  matches.reserve(hypothesis.size());
  for (const CandidateMatch& match : hypothesis) matches.push_back(match.segments);
  return matches;
}

std::string tooFew(std::size_t matches, const AlignmentParameters& parameters) {
  return std::to_string(matches) + " segments could be matched, " + std::to_string(parameters.min_matches) +
         " are needed";
}

std::string reasonAgainst(const ScanPair& pair, const Solution& solution) {
  if (solution.matches.size() < pair.parameters().min_matches)
    return tooFew(solution.matches.size(), pair.parameters());
  const double score = solution.agreement.score;
  if (score < pair.parameters().min_score)
    return "only " + std::to_string(std::lround(100 * score)) + " % of the objects seen by both agree, " +
           std::to_string(std::lround(100 * pair.parameters().min_score)) + " % are needed";
  return reasonAgainst(pair, solution.icp);
}

/// Associates segments that lie on each other and aligns them with ICP, in turns.
Solution solveFrom(const ScanPair& pair, const Eigen::Isometry3d& start, ConstrainedIcp& icp,
                   const AlignmentScore& score) {
  Solution solution;
  solution.icp.correction = start;
  for (int round = 0; round < ASSOCIATIONS; ++round) {
    std::vector<SegmentMatch> matches = associateSegments(pair, solution.icp.correction);
    if (matches == solution.matches) break;
    solution.matches = std::move(matches);
    if (solution.matches.size() < pair.parameters().min_matches) break;
    const Eigen::Isometry3d again = icp.approach(solution.matches, solution.icp.correction, REPEATED_GATE);
    solution.icp = icp.refine(solution.matches, again);
  }
  solution.agreement = score.of(solution.icp.correction);
  solution.refusal = reasonAgainst(pair, solution);
  return solution;
}

/// Fits the matches, then ICP within them; segments that come to lie on each other are added, others left.
Solution solve(const ScanPair& pair, const std::vector<CandidateMatch>& hypothesis, ConstrainedIcp& icp,
               const AlignmentScore& score) {
  const std::vector<SegmentMatch> matches = segmentsOf(hypothesis);
  return solveFrom(pair, icp.approach(matches, fitMatches(hypothesis), FIRST_GATE), icp, score);
}

double meritOf(const Solution& solution) {
  return solution.agreement.score * std::sqrt(static_cast<double>(solution.matches.size()));
}

/// The best of the solutions that pass the gates or, if there is none, of all.
bool isBetter(const Solution& a, const Solution& b) {
  if (a.refusal.empty() != b.refusal.empty()) return a.refusal.empty();
  return meritOf(a) > meritOf(b);
}

/// True if another solution is nearly as good and elsewhere: things repeat themselves.
bool contradicts(const Solution& other, const Solution& best, double voxel_size) {
  if (!best.refusal.empty() || !other.refusal.empty()) return false;
  const Eigen::Vector3d place = best.icp.centre;
  const Eigen::Vector3d elsewhere = other.icp.correction * (best.icp.correction.inverse() * place);
  return (elsewhere - place).norm() > SAME_PLACE * voxel_size && meritOf(other) > NEARLY * meritOf(best);
}

Alignment alignmentOf(const ScanPair& pair, const Solution& solution) {
  if (!solution.refusal.empty()) {
    Alignment result = refused(pair, solution.refusal);
    result.matches = solution.matches;
    result.score = solution.agreement.score;
    return result;
  }
  Alignment result = alignmentOf(pair, solution.icp, AlignmentMethod::SEGMENTS);
  result.accepted = true;
  result.matches = solution.matches;
  result.score = solution.agreement.score;
  return result;
}

/// The best hypothesis, however bad it looks, made precise point-to-point.
Alignment alignPlainly(const ScanPair& pair, const std::vector<CandidateMatch>& hypothesis) {
  const ConstrainedIcp icp(pair);
  Solution solution;
  solution.matches = segmentsOf(hypothesis);
  solution.icp.correction = icp.approach(solution.matches, fitMatches(hypothesis), FIRST_GATE);
  solution.agreement = AlignmentScore(pair).of(solution.icp.correction);
  return alignmentOf(pair, solution);
}

/// What the segments say, whether they say two things, and the corrections that they hint at.
struct Attempt {
  Alignment alignment;
  bool ambiguous = false;
  std::vector<Eigen::Isometry3d> starts = {};
};

Attempt alignBySegments(const ScanPair& pair) {
  if (pair.moving().empty()) return {refused(pair, "the moving scan has no segments")};
  if (pair.reference().empty()) return {refused(pair, "the reference has no segments")};
  const auto hypotheses = findHypotheses(findCandidates(pair), pair.parameters(), pair.voxelSize());
  if (hypotheses.empty()) return {refused(pair, tooFew(0, pair.parameters()))};
  if (pair.parameters().matching == Matching::PLAIN) return {alignPlainly(pair, hypotheses.front())};
  ConstrainedIcp icp(pair);
  const AlignmentScore score(pair);
  std::vector<Solution> solutions;
  solutions.reserve(hypotheses.size());
  for (const std::vector<CandidateMatch>& hypothesis : hypotheses)
    solutions.push_back(solve(pair, hypothesis, icp, score));
  const Solution& best = *std::min_element(solutions.begin(), solutions.end(), isBetter);
  const bool ambiguous = std::any_of(solutions.begin(), solutions.end(), [&](const Solution& other) {
    return contradicts(other, best, pair.voxelSize());
  });
  if (ambiguous) return {refused(pair, "the segments fit nearly as well elsewhere"), true};
  std::vector<Eigen::Isometry3d> starts;
  starts.reserve(solutions.size());
  for (const Solution& solution : solutions) starts.push_back(solution.icp.correction);
  return {alignmentOf(pair, best), false, starts};
}

/// Share of the occupied voxels that objects have.
double shareOfObjects(const ScanSegments& scan) {
  return static_cast<double>(scan.objects.cols()) /
         static_cast<double>(std::max<Eigen::Index>(scan.surface.cols(), 1));
}

/// What the relief of the ground says, unless objects stand on it: seen from other places they have other
/// sides, and the tops of a wood are no relief (two flight lines over one ended 0.7 m off, by eight times the
/// deviation predicted).
Alignment alignByRelief(const ScanPair& pair) {
  constexpr double BARE = 0.1;
  if (std::max(shareOfObjects(pair.movingScan()), shareOfObjects(pair.referenceScan())) > BARE)
    return refused(pair, "there are objects, and it is asked of bare ground only");
  ReliefParameters parameters;
  parameters.gates = pair.parameters().gates;
  const ReliefResult relief =
      alignRelief(pair.movingScan().relief, pair.referenceScan().relief, pair.initialGuess(), parameters);
  if (!relief.accepted) return refused(pair, relief.refusal);
  const Agreement agreement =
      AlignmentScore(pair).of(relief.reference_from_moving * pair.initialGuess().inverse());
  if (agreement.points >= TELLING_OBJECTS && agreement.score < SHARE_OF_SCORE * pair.parameters().min_score)
    return refused(pair, "the objects do not agree");
  Alignment result;
  result.reference_from_moving = relief.reference_from_moving;
  result.accepted = true;
  result.method = AlignmentMethod::RELIEF;
  result.score = agreement.score;
  result.overlap = relief.best.overlap;
  result.covariance = relief.covariance;
  return result;
}

}  // namespace

SearchGates gatesOf(SearchMode mode) {
  SearchGates gates;
  if (mode == SearchMode::WIDE) {
    gates.max_shift = 2.5;
    gates.max_turn = 25;
    gates.hypotheses = 4;
  }
  return gates;
}

Alignment alignScans(const ScanSegments& moving, const ScanSegments& reference,
                     const Eigen::Isometry3d& initial_guess, const AlignmentParameters& parameters) {
  const ScanPair pair(moving, reference, initial_guess, parameters);
  const Attempt attempt = alignBySegments(pair);
  Alignment result = attempt.alignment;
  if (result.accepted || attempt.ambiguous) return result;
  if (parameters.fallback == Fallback::DENSE) {
    const Alignment dense = alignSurfaces(pair, attempt.starts);
    if (dense.accepted) return dense;
    result.refusal += "; without segments: " + dense.refusal;
  }
  if (parameters.relief == ReliefUse::AUTO) {
    const Alignment relief = alignByRelief(pair);
    if (relief.accepted) return relief;
    result.refusal += "; by the relief: " + relief.refusal;
  }
  return result;
}

}  // namespace pcl_fft_ground::core
