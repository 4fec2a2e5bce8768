#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "align/surface_fit.h"
#include "align/verdict.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double DEGREE = 3.14159265358979323846 / 180;

// The constants of the search and the verdict. The shares were chosen on the nine real pairs that the guide
// lists: right poses had at least the first value, the best wrong ones (other places, mirrored) the second.
constexpr double OFF = 0.6;               // of the starts around the guess, of what navigation allows
constexpr double LEAST_REACH = 12;        // of ICP from afar [voxels]
constexpr double MOST_REACH = 40;         // [voxels]
constexpr double SLACK = 1.15;            // the last refinement may leave the bounds by so much
constexpr double SAME = 1;                // poses that are nearer than this are one [voxels]
constexpr double ELSEWHERE = 3;           // poses that are farther than this are rivals [voxels]
constexpr double LEAST_SEEN = 0.15;       // share of the surfaces that tells: .52
constexpr double MOST_MISPLACED = 0.075;  // share where the other scan looked through: .06; .10
// From above little is hidden: right poses of simulated surveys had .96, the best wrong one .82.
constexpr double SHARE_FROM_ABOVE = 0.9;
constexpr double LEAST_DIRECTION = 0.35;  // share that agrees in the worst direction: .45
constexpr double AS_WELL = 0.95;          // share of the evidence that the planes' pose keeps
constexpr double NEARLY = 0.7;            // of the best pose's evidence makes another a rival
// At places around right poses there was .65 of their evidence at most, around wrong ones of lattices .92.
constexpr double LIKE_ANYWHERE = 0.8;
// At a first look, by few of the pieces and not yet at rest:
constexpr double WORTH = 0.5;     // share of the best one's evidence that makes a place worth a second look
constexpr double HOPELESS = 0.7;  // of the shares above, below which (beyond which) no second look mends it

/// A pose that the surfaces hold.
struct Candidate {
  IcpResult icp;
  SurfaceEvidence evidence;
};

/// Shares that the surfaces of one place have.
struct LeastShares {
  double agreeing;   ///< of what the surfaces tell
  double slack = 1;  ///< by which all of them may be missed
};

Eigen::Vector3d middleOf(const ScanPair& pair) {
  return pair.initialGuess() * pair.movingScan().surface.cast<double>().rowwise().mean();
}

/// The guess and places around it: what repeats itself is found from these.
std::vector<Eigen::Isometry3d> startsAround(const ScanPair& pair) {
  const SearchGates& gates = pair.parameters().gates;
  const double shift = OFF * gates.max_shift, turn = OFF * gates.max_turn * DEGREE;
  std::vector<Eigen::Isometry3d> starts{Eigen::Isometry3d::Identity()};
  for (const auto& [x, y] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
    starts.emplace_back(Eigen::Translation3d(shift * x, shift * y, 0));
  const Eigen::Vector3d middle = middleOf(pair);
  for (const double angle : {turn, -turn})
    starts.emplace_back(Eigen::Translation3d(middle) * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) *
                        Eigen::Translation3d(-middle));
  return starts;
}

void sortByEvidence(std::vector<Candidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.evidence.evidence > b.evidence.evidence;
  });
}

/// Where ICP comes to from the starts at a first look, each place once, the most evidence first.
std::vector<Candidate> firstLook(const std::vector<Eigen::Isometry3d>& starts, const ScanPair& pair,
                                 const SurfaceFit& fit) {
  const double voxel = pair.voxelSize();
  const double reach = std::clamp(pair.parameters().gates.max_shift, LEAST_REACH * voxel, MOST_REACH * voxel);
  const auto meet = [&](const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    return fit.displacement(a, b) < SAME * voxel;
  };
  std::vector<Eigen::Isometry3d> approached;
  std::vector<Candidate> candidates;
  for (const Eigen::Isometry3d& start : starts) {
    const Eigen::Isometry3d near = fit.approach(start, reach);
    const bool known = std::any_of(approached.begin(), approached.end(),
                                   [&](const auto& other) { return meet(near, other); });
    if (known) continue;
    approached.push_back(near);
    const IcpResult icp = fit.refine(near, Pieces::FEW);
    candidates.push_back({icp, fit.at(icp.correction, Pieces::FEW)});
  }
  sortByEvidence(candidates);
  return candidates;
}

/// The same places made precise, as far as they are worth it.
std::vector<Candidate> secondLook(const std::vector<Candidate>& first, const ScanPair& pair,
                                  const SurfaceFit& fit) {
  std::vector<Candidate> candidates;
  for (const Candidate& rough : first) {
    if (rough.evidence.evidence < WORTH * first.front().evidence.evidence) break;
    const IcpResult icp = fit.refine(rough.icp.correction);
    const bool met = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& other) {
      return fit.displacement(icp.correction, other.icp.correction) < SAME * pair.voxelSize();
    });
    if (!met) candidates.push_back({icp, fit.at(icp.correction)});
  }
  sortByEvidence(candidates);
  return candidates;
}

/// Empty if navigation may be that wrong: about where the moving scan has its origin, which is its sensor or
/// lies amid it, or about its middle, whichever moves less.
std::string reasonAgainstPlace(const ScanPair& pair, const Eigen::Isometry3d& correction) {
  const SearchGates& gates = pair.parameters().gates;
  const auto moved = [&](const Eigen::Vector3d& place) { return (correction * place - place).norm(); };
  const double shift = std::min(moved(pair.initialGuess().translation()), moved(middleOf(pair)));
  const double turn = Eigen::AngleAxisd(correction.linear()).angle() / DEGREE;
  if (shift > SLACK * gates.max_shift) return exceeding("the shift", shift, SLACK * gates.max_shift, " m");
  if (turn > SLACK * gates.max_turn) return exceeding("the turn", turn, SLACK * gates.max_turn, " degrees");
  return {};
}

/// Empty if the surfaces agree as those of one place do.
std::string reasonAgainst(const SurfaceEvidence& evidence, const LeastShares& least) {
  const auto percent = [](double share) { return std::to_string(std::lround(100 * share)) + " %"; };
  if (evidence.seen < least.slack * LEAST_SEEN) return "hardly any overlap";
  if (evidence.share() < least.slack * least.agreeing)
    return "only " + percent(evidence.share()) + " of what the surfaces tell agrees, " +
           percent(least.agreeing) + " are needed";
  if (evidence.leastShare() < least.slack * LEAST_DIRECTION)
    return "only " + percent(evidence.leastShare()) + " agrees in the direction held worst, " +
           percent(LEAST_DIRECTION) + " are needed";
  if (least.slack * evidence.misplaced > MOST_MISPLACED)
    return "of either scan " + percent(evidence.misplaced) +
           " or more stand where the other has looked through, allowed are " + percent(MOST_MISPLACED);
  return {};
}

/// Empty if the objects agree in the columns that both scans cover.
std::string reasonAgainstObjects(const ScanPair& pair, const Eigen::Isometry3d& correction) {
  const Agreement agreement = AlignmentScore(pair).of(correction);
  const bool agree =
      agreement.points < TELLING_OBJECTS || agreement.score >= SHARE_OF_SCORE * pair.parameters().min_score;
  return agree ? std::string() : "the objects do not agree";
}

/// True if a place near by, at which ICP would not stay, has nearly the evidence of the pose: any place
/// would.
bool isLikeAnyPlace(const ScanPair& pair, const SurfaceFit& fit, const Eigen::Isometry3d& pose) {
  const double most = LIKE_ANYWHERE * fit.at(pose, Pieces::FEW).evidence;
  const std::vector<Eigen::Isometry3d> places = placesAround(pose, pair.voxelSize());
  return std::any_of(places.begin(), places.end(), [&](const Eigen::Isometry3d& place) {
    return fit.at(place, Pieces::FEW).evidence > most;
  });
}

/// Empty if the pose is held in every direction.
std::string reasonAgainstPrecision(const ScanPair& pair, const IcpResult& icp) {
  const std::optional<Matrix6d> covariance = covarianceAboutCentre(icp);
  if (!covariance) return "the surfaces leave a direction free";
  const double deviation = deviationAtDistance(*covariance, 0);
  const double largest = largestSigma(pair.parameters(), pair.voxelSize());
  return deviation > largest ? exceeding("the predicted deviation", deviation, largest, " m") : std::string();
}

/// The pose that the planes which both scans have seen come to, where they hold it and the surfaces agree
/// with it as well; otherwise the pose as it is.
IcpResult polished(const ScanPair& pair, const SurfaceFit& fit, const Candidate& best) {
  const IcpResult planes = alignPlanes(pair, best.icp.correction);
  const bool is_held = covarianceAboutCentre(planes) && reasonAgainstPrecision(pair, planes).empty();
  if (!is_held || fit.displacement(best.icp.correction, planes.correction) > SAME * pair.voxelSize())
    return best.icp;
  return fit.at(planes.correction).evidence > AS_WELL * best.evidence.evidence ? planes : best.icp;
}

}  // namespace

Alignment alignSurfaces(const ScanPair& pair, const std::vector<Eigen::Isometry3d>& more_starts) {
  if (pair.movingScan().surface.cols() == 0 || pair.referenceScan().surface.cols() == 0)
    return refused(pair, "a scan has no points");
  const SurfaceFit fit(pair);
  std::vector<Eigen::Isometry3d> starts = startsAround(pair);
  starts.insert(starts.end(), more_starts.begin(), more_starts.end());
  LeastShares least{SHARE_OF_SCORE * pair.parameters().min_score};
  if (fit.isFromAbove()) least.agreeing = std::max(SHARE_FROM_ABOVE, least.agreeing);
  const std::vector<Candidate> first = firstLook(starts, pair, fit);
  if (first.empty()) return refused(pair, "hardly any overlap");
  if (!(first.front().evidence.evidence > 0))
    return refused(pair, "the surfaces agree no better than unrelated ones");
  const std::string hopeless = reasonAgainst(first.front().evidence, {least.agreeing, HOPELESS});
  if (!hopeless.empty()) return refused(pair, hopeless);
  const std::vector<Candidate> candidates = secondLook(first, pair, fit);
  // If the best lies beyond what navigation allows nothing within is to be believed either.
  const Candidate& best = candidates.front();
  std::string reason = reasonAgainstPlace(pair, best.icp.correction);
  if (reason.empty()) reason = reasonAgainst(best.evidence, least);
  if (reason.empty() && fit.isFromAbove()) reason = reasonAgainstObjects(pair, best.icp.correction);
  if (reason.empty()) reason = reasonAgainstPrecision(pair, best.icp);
  const bool has_rival = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& other) {
    return other.evidence.evidence > NEARLY * best.evidence.evidence &&
           fit.displacement(best.icp.correction, other.icp.correction) > ELSEWHERE * pair.voxelSize();
  });
  if (reason.empty() && (has_rival || isLikeAnyPlace(pair, fit, best.icp.correction)))
    reason = "the surfaces fit nearly as well elsewhere";
  if (!reason.empty()) return refused(pair, reason);
  Alignment result = alignmentOf(pair, polished(pair, fit, best), AlignmentMethod::DENSE);
  result.accepted = true;
  result.score = best.evidence.share();
  return result;
}

}  // namespace pcl_fft_ground::core
