#include "align/segment_matching.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "pcl_fft_ground/core/align/rigid_fit.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double DEGREE = 3.14159265358979323846 / 180;

constexpr double CENTROID_SLACK = 0.15;  // centroids of one object, seen from two places, differ [m]
constexpr double LEAST_HEIGHT_RATIO = 0.3;
constexpr double LEAST_SIZE_RATIO = 0.45;
constexpr double LEAST_BORDER_SIZE_RATIO = 0.25;  // a segment may be cut by the border of its scan
constexpr double LEAST_PLAIN_RATIO = 0.7;         // of the extents, for plain matching
constexpr double LARGEST_DISTANCE = 1.1;          // of the shapes of two segments that match [voxels]
constexpr double DISTANCE_PER_EXTENT = 0.12;
constexpr double LEAST_DISTANCE = 0.2;  // [voxels]
constexpr double TOLERANCE = 3;         // by which distances between matches may differ [voxels]
constexpr double RISE_PER_LENGTH = 0.05;
constexpr std::size_t MAX_CANDIDATES = 600;
constexpr double ELSEWHERE = 3;  // shifts that differ by less are one [voxels]

double ratio(double a, double b) {
  return std::max(a, b) > 0 ? std::min(a, b) / std::max(a, b) : 1;
}

double sizeOf(const PlacedSegment& segment) {
  return std::sqrt(static_cast<double>(segment.points.cols()));
}

bool areNear(const PlacedSegment& a, const PlacedSegment& b, const SearchGates& gates) {
  const Eigen::Vector3d offset = b.centroid - a.centroid;
  return offset.head<2>().norm() < gates.max_shift + CENTROID_SLACK && std::abs(offset.z()) < gates.max_rise;
}

bool areAlike(const PlacedSegment& a, const PlacedSegment& b) {
  const double least = a.at_border || b.at_border ? LEAST_BORDER_SIZE_RATIO : LEAST_SIZE_RATIO;
  return ratio(a.extents.z(), b.extents.z()) >= LEAST_HEIGHT_RATIO && ratio(sizeOf(a), sizeOf(b)) >= least;
}

/// The better of the local alignments from the centroids and, where these mislead, from the initial guess.
std::optional<LocalAlignment> bestLocalAlignment(const ScanPair& pair, const PlacedSegment& a,
                                                 const PlacedSegment& b, double max_distance) {
  const Eigen::Isometry3d by_centroids(Eigen::Translation3d(b.centroid - a.centroid));
  const std::optional<LocalAlignment> first = alignLocally(pair, a, b, by_centroids, max_distance);
  if (!a.at_border && !b.at_border) return first;
  const std::optional<LocalAlignment> second =
      alignLocally(pair, a, b, Eigen::Isometry3d::Identity(), max_distance);
  if (!first || !second) return first ? first : second;
  return second->shape_distance < first->shape_distance ? second : first;
}

std::optional<CandidateMatch> localMatch(const ScanPair& pair, const SegmentMatch& segments) {
  const PlacedSegment& a = pair.moving()[segments.moving];
  const PlacedSegment& b = pair.reference()[segments.reference];
  if (!areAlike(a, b)) return std::nullopt;
  const double voxel = pair.voxelSize();
  const double extent = std::min(a.extents.maxCoeff(), b.extents.maxCoeff());
  const double limit =
      std::min(LARGEST_DISTANCE * voxel, DISTANCE_PER_EXTENT * extent + LEAST_DISTANCE * voxel);
  const std::optional<LocalAlignment> local = bestLocalAlignment(pair, a, b, limit);
  if (!local) return std::nullopt;
  const double unlikeness = local->shape_distance / (0.6 * limit);
  const double weight = std::min(sizeOf(a), sizeOf(b)) * std::exp(-0.5 * unlikeness * unlikeness) *
                        std::min(1.0, local->covered + 0.3);
  return CandidateMatch{segments, a.centroid, local->correction * a.centroid, local->correction, weight};
}

/// Centroids, and extents for the shape.
std::optional<CandidateMatch> plainMatch(const ScanPair& pair, const SegmentMatch& segments) {
  const PlacedSegment& a = pair.moving()[segments.moving];
  const PlacedSegment& b = pair.reference()[segments.reference];
  const double least = std::min({ratio(a.extents.head<2>().norm(), b.extents.head<2>().norm()),
                                 ratio(a.extents.z(), b.extents.z()), ratio(sizeOf(a), sizeOf(b))});
  if (least < LEAST_PLAIN_RATIO) return std::nullopt;
  const Eigen::Isometry3d shift(Eigen::Translation3d(b.centroid - a.centroid));
  return CandidateMatch{segments, a.centroid, b.centroid, shift, std::min(sizeOf(a), sizeOf(b)) * least};
}

/// What keeps two matches from being true at once.
class Consistency {
 public:
  Consistency(const SearchGates& gates, double voxel_size)
      : tolerance_(TOLERANCE * voxel_size), max_turn_(gates.max_turn * DEGREE) {}

  bool agree(const CandidateMatch& a, const CandidateMatch& b) const {
    if (a.segments.moving == b.segments.moving || a.segments.reference == b.segments.reference) return false;
    const Eigen::Vector3d from = b.from - a.from;
    const Eigen::Vector3d to = b.to - a.to;
    const double length = from.head<2>().norm();
    if (std::abs(to.head<2>().norm() - length) > tolerance_) return false;
    if (std::abs(to.z() - from.z()) > tolerance_ + RISE_PER_LENGTH * length) return false;
    const double turn = std::atan2(from.x() * to.y() - from.y() * to.x(), from.head<2>().dot(to.head<2>()));
    return std::abs(turn) < max_turn_ + std::asin(std::min(1.0, tolerance_ / std::max(length, tolerance_)));
  }

 private:
  double tolerance_;
  double max_turn_;
};

Adjacency consistentPairs(const std::vector<CandidateMatch>& candidates, const Consistency& consistency) {
  Adjacency joined(candidates.size(), std::vector<bool>(candidates.size(), false));
  for (std::size_t a = 0; a < candidates.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      joined[a][b] = joined[b][a] = consistency.agree(candidates[a], candidates[b]);
  return joined;
}

/// The shifts of a posed scan, in order, that put the centroid of a segment on that of another.
std::vector<Eigen::Vector3d> shiftsOfSegments(const ScanPair& pair, const Eigen::Isometry3d& pose,
                                              const Eigen::Vector3d& centre) {
  const SearchGates& gates = pair.parameters().gates;
  const Eigen::Vector3d moved = centre - pose.inverse() * centre;
  std::vector<Eigen::Vector3d> shifts;
  for (const PlacedSegment& a : pair.moving())
    for (const PlacedSegment& b : pair.reference()) {
      const Eigen::Vector3d shift = b.centroid - pose * a.centroid;
      const Eigen::Vector3d total = moved + shift;
      const bool may_be = total.head<2>().norm() < RIVALS_BEYOND * gates.max_shift &&
                          std::abs(total.z()) < RIVALS_BEYOND * gates.max_rise;
      if (may_be) shifts.push_back(shift);
    }
  std::sort(shifts.begin(), shifts.end(), [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
  return shifts;
}

/// How many of the shifts, which are in order, are near each of them.
std::vector<std::size_t> supportOf(const std::vector<Eigen::Vector3d>& shifts, double near) {
  std::vector<std::size_t> support(shifts.size(), 1);
  for (std::size_t a = 0; a < shifts.size(); ++a)
    for (std::size_t b = a + 1; b < shifts.size() && shifts[b].x() - shifts[a].x() < near; ++b)
      if ((shifts[b] - shifts[a]).norm() < near) ++support[a], ++support[b];
  return support;
}

}  // namespace

std::vector<Eigen::Isometry3d> placesElsewhere(const ScanPair& pair, const Eigen::Isometry3d& pose,
                                               const Eigen::Vector3d& centre, std::size_t most) {
  const double near = ELSEWHERE * pair.voxelSize();
  const std::vector<Eigen::Vector3d> shifts = shiftsOfSegments(pair, pose, centre);
  const std::vector<std::size_t> support = supportOf(shifts, near);
  std::vector<std::size_t> order(shifts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return support[a] > support[b]; });
  std::vector<Eigen::Vector3d> taken{Eigen::Vector3d::Zero()};
  std::vector<Eigen::Isometry3d> places;
  for (const std::size_t n : order) {
    if (places.size() >= most) break;
    const bool is_taken = std::any_of(taken.begin(), taken.end(), [&](const Eigen::Vector3d& other) {
      return (shifts[n] - other).norm() < near;
    });
    if (is_taken) continue;
    taken.push_back(shifts[n]);
    places.emplace_back(Eigen::Translation3d(shifts[n]) * pose);
  }
  return places;
}

std::vector<CandidateMatch> findCandidates(const ScanPair& pair) {
  const AlignmentParameters& parameters = pair.parameters();
  const auto match = parameters.matching == Matching::PLAIN ? plainMatch : localMatch;
  std::vector<CandidateMatch> candidates;
  for (std::size_t i = 0; i < pair.moving().size(); ++i)
    for (std::size_t j = 0; j < pair.reference().size(); ++j) {
      if (!areNear(pair.moving()[i], pair.reference()[j], parameters.gates)) continue;
      const std::optional<CandidateMatch> candidate = match(pair, {i, j});
      if (candidate) candidates.push_back(*candidate);
    }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.weight > b.weight; });
  candidates.resize(std::min(candidates.size(), MAX_CANDIDATES));
  return candidates;
}

std::vector<std::vector<CandidateMatch>> findHypotheses(std::vector<CandidateMatch> candidates,
                                                        const AlignmentParameters& parameters,
                                                        double voxel_size) {
  const Consistency consistency(parameters.gates, voxel_size);
  const std::size_t least = parameters.matching == Matching::PLAIN ? parameters.min_matches : 1;
  std::vector<std::vector<CandidateMatch>> hypotheses;
  while (hypotheses.size() < parameters.gates.hypotheses) {
    std::vector<double> weights;
    weights.reserve(candidates.size());
    for (const CandidateMatch& candidate : candidates) weights.push_back(candidate.weight);
    const std::vector<std::size_t> clique = heaviestClique(weights, consistentPairs(candidates, consistency));
    if (clique.size() < least) break;
    std::vector<CandidateMatch>& hypothesis = hypotheses.emplace_back();
    for (const std::size_t n : clique) hypothesis.push_back(candidates[n]);
    for (std::size_t n = clique.size(); n-- > 0;)
      candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(clique[n]));
  }
  return hypotheses;
}

Eigen::Isometry3d fitMatches(const std::vector<CandidateMatch>& matches) {
  if (matches.size() == 1) return matches.front().correction;
  const Eigen::Vector3d about = matches.front().to;
  YawFit fit;
  for (const CandidateMatch& match : matches) fit.add(match.from - about, match.to - about, match.weight);
  return Eigen::Translation3d(about) * fit.solve() * Eigen::Translation3d(-about);
}

}  // namespace pcl_fft_ground::core
