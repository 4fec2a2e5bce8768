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
// Places elsewhere. Chosen on lattices of equal half spheres (seed 21) and on wrecks and pipes (seeds 61,
// 62), which have, of what could agree beyond chance: right poses .89 at least, wrong ones on lattices .30 at
// most.
constexpr double LEAST_BEYOND_CHANCE = 0.5;
constexpr Eigen::Index AT_A_GLANCE = 20;  // one in so many object points tells what agrees by chance...
constexpr double WORTH = 0.6;             // ...and, by its share of the best one's, what is worth a solution
constexpr std::size_t MOST_PLACES = 24;   // that are glanced at, those with most segments on each other first
constexpr std::size_t MOST_RIVALS = 3;    // that are solved, the best first
constexpr double AS_WELL = 0.85;  // share of the best one's that makes another a rival, whatever it fails...
constexpr double AS_MUCH = 0.5;   // ...if so much is seen there, of what is in the best pose
constexpr double DEGREE = 3.14159265358979323846 / 180;

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

std::string percent(double share) {
  return std::to_string(std::lround(100 * share)) + " %";
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
    return "only " + percent(score) + " of the objects seen by both agree, " +
           percent(pair.parameters().min_score) + " are needed";
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

/** How much of what two scans could agree on beyond chance they do: 1 all of it, 0 no more than anywhere.
 *
 * Where objects stand densely most of their points have others near wherever they are laid.
 */
class BeyondChance {
 public:
  BeyondChance(const AlignmentScore& score, const Eigen::Isometry3d& pose, double voxel_size) {
    const std::vector<Eigen::Isometry3d> places = placesAround(pose, voxel_size);
    for (const Eigen::Isometry3d& place : places)
      chance_ += score.of(place, AT_A_GLANCE).score / static_cast<double>(places.size());
  }

  /// \param agreement share of the objects seen by both that agree
  double operator()(double agreement) const { return (agreement - chance_) / std::max(1e-9, 1 - chance_); }
  double byChance() const { return chance_; }

 private:
  double chance_ = 0;
};

/// True if navigation may be that wrong about a place, or half as much again: its errors have tails.
bool mayBe(const SearchGates& gates, const Eigen::Isometry3d& correction, const Eigen::Vector3d& place) {
  const Eigen::Vector3d moved = correction * place - place;
  return moved.head<2>().norm() < RIVALS_BEYOND * gates.max_shift &&
         std::abs(moved.z()) < RIVALS_BEYOND * gates.max_rise &&
         std::abs(yawOf(correction)) < RIVALS_BEYOND * gates.max_turn * DEGREE;
}

/// True if another solution is nearly as good and elsewhere: things repeat themselves. Where as much of both
/// scans agrees as well it does not matter which gate that place misses.
bool contradicts(const ScanPair& pair, const Solution& other, const Solution& best,
                 const BeyondChance& beyond) {
  const Eigen::Vector3d place = best.icp.correction.inverse() * best.icp.centre;
  if ((other.icp.correction * place - best.icp.centre).norm() <= SAME_PLACE * pair.voxelSize()) return false;
  if (other.refusal.empty() && meritOf(other) > NEARLY * meritOf(best)) return true;
  return mayBe(pair.parameters().gates, other.icp.correction, place) &&
         beyond(other.agreement.score) > AS_WELL * beyond(best.agreement.score) &&
         static_cast<double>(other.agreement.points) > AS_MUCH * static_cast<double>(best.agreement.points);
}

/// Where the scan lies nearly as well as in the best pose, at a glance, the best first.
std::vector<Eigen::Isometry3d> rivalPlaces(const ScanPair& pair, const Solution& best,
                                           const AlignmentScore& score, const BeyondChance& beyond) {
  std::vector<std::pair<double, Eigen::Isometry3d>> places;
  for (const Eigen::Isometry3d& place :
       placesElsewhere(pair, best.icp.correction, best.icp.centre, MOST_PLACES)) {
    const double glance = beyond(score.of(place, AT_A_GLANCE).score);
    if (glance > WORTH * beyond(best.agreement.score)) places.emplace_back(glance, place);
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  places.resize(std::min(places.size(), MOST_RIVALS));
  std::vector<Eigen::Isometry3d> rivals;
  rivals.reserve(places.size());
  for (const auto& [glance, place] : places) rivals.push_back(place);
  return rivals;
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

/// Whether one of the solutions, or of those that come from other places, is nearly as good.
bool hasRival(const ScanPair& pair, const Solution& best, const std::vector<Solution>& solutions,
              const BeyondChance& beyond, ConstrainedIcp& icp, const AlignmentScore& score) {
  const auto is_rival = [&](const Solution& other) { return contradicts(pair, other, best, beyond); };
  if (std::any_of(solutions.begin(), solutions.end(), is_rival)) return true;
  const std::vector<Eigen::Isometry3d> places = rivalPlaces(pair, best, score, beyond);
  return std::any_of(places.begin(), places.end(), [&](const Eigen::Isometry3d& place) {
    return is_rival(solveFrom(pair, place, icp, score));
  });
}

Attempt alignBySegments(const ScanPair& pair) {
  if (pair.moving().empty()) return {refused(pair, "the moving scan has no segments")};
  if (pair.reference().empty()) return {refused(pair, "the reference has no segments")};
  const std::vector<CandidateMatch> candidates = findCandidates(pair);
  const auto hypotheses = findHypotheses(candidates, pair.parameters(), pair.voxelSize());
  if (hypotheses.empty()) return {refused(pair, tooFew(0, pair.parameters()))};
  if (pair.parameters().matching == Matching::PLAIN) return {alignPlainly(pair, hypotheses.front())};
  ConstrainedIcp icp(pair);
  const AlignmentScore score(pair);
  std::vector<Solution> solutions;
  solutions.reserve(hypotheses.size());
  for (const std::vector<CandidateMatch>& hypothesis : hypotheses)
    solutions.push_back(solve(pair, hypothesis, icp, score));
  Solution best = *std::min_element(solutions.begin(), solutions.end(), isBetter);
  if (best.refusal.empty()) {
    const BeyondChance beyond(score, best.icp.correction, pair.voxelSize());
    if (beyond(best.agreement.score) < LEAST_BEYOND_CHANCE)
      best.refusal = percent(best.agreement.score) + " of the objects seen by both agree, but " +
                     percent(beyond.byChance()) + " do anywhere";
    else if (hasRival(pair, best, solutions, beyond, icp, score))
      return {refused(pair, "the segments fit nearly as well elsewhere"), true};
  }
  std::vector<Eigen::Isometry3d> starts;
  starts.reserve(solutions.size());
  for (const Solution& solution : solutions) starts.push_back(solution.icp.correction);
  return {alignmentOf(pair, best), false, starts};
}

/// What the relief of the ground says, unless objects stand on it.
Alignment alignByRelief(const ScanPair& pair) {
  if (std::max(shareOfObjects(pair.movingScan()), shareOfObjects(pair.referenceScan())) >
      MOST_OBJECTS_ON_RELIEF)
    return refused(pair, "there are objects, and it is asked of bare ground only");
  ReliefParameters parameters;
  parameters.gates = pair.parameters().gates;
  parameters.max_sigma = pair.parameters().max_sigma;
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

const char* nameOf(AlignmentMethod method) {
  switch (method) {
    case AlignmentMethod::SEGMENTS:
      return "segments";
    case AlignmentMethod::DENSE:
      return "dense";
    case AlignmentMethod::RELIEF:
      return "relief";
    case AlignmentMethod::NONE:
      break;
  }
  return "none";
}

double shareOfObjects(const ScanSegments& scan) {
  return static_cast<double>(scan.objects.cols()) /
         static_cast<double>(std::max<Eigen::Index>(scan.surface.cols(), 1));
}

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
