#include "align/scan_pair.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "scan/parameter_check.h"

namespace pcl_fft_ground::core {
namespace {

constexpr Eigen::Index SAMPLE = 120;  // points of a segment that take part in its local alignment
constexpr double SEEN_WITHIN = 1.5;   // depth of a place in the coverage from which it has been seen [voxels]

PlacedSegment placed(const Segment& segment, const Eigen::Isometry3d& transform) {
  PlacedSegment result;
  result.points = transformed(segment.points, transform);
  result.sample = evenSample(result.points, SAMPLE);
  result.centroid = transform * segment.centroid;
  result.extents = segment.extents;
  result.at_border = segment.at_border;
  return result;
}

/// The search refers to the points, which therefore have to be where they stay.
std::vector<PlacedSegment> placedSegments(const ScanSegments& scan, const Eigen::Isometry3d& transform,
                                          const NearestNeighboursFactory& neighbours) {
  std::vector<PlacedSegment> result;
  result.reserve(scan.segments.size());
  for (const Segment& segment : scan.segments) {
    result.push_back(placed(segment, transform));
    result.back().search = neighbours(result.back().points, scan.voxel_size);
  }
  return result;
}

/// The scan with the voxels of the other, if these are larger.
std::optional<ScanSegments> coarsenedTo(const ScanSegments& other, const ScanSegments& scan) {
  if (scan.voxel_size >= other.voxel_size) return std::nullopt;
  return coarsened(scan, other.voxel_size);
}

const Eigen::Isometry3d& checked(const Eigen::Isometry3d& guess, const AlignmentParameters& parameters) {
  validate(parameters);
  if (!guess.matrix().allFinite()) throw std::invalid_argument("the initial guess is not finite");
  return guess;
}

}  // namespace

void validate(const AlignmentParameters& parameters) {
  const SearchGates& gates = parameters.gates;
  const auto positive = [](const char* name, double value) {
    require(std::isfinite(value) && value > 0, name, value, "a finite number above 0");
  };
  positive("max_shift", gates.max_shift);
  positive("max_rise", gates.max_rise);
  positive("max_tilt", gates.max_tilt);
  positive("max_sigma", parameters.max_sigma.value_or(1));
  require(gates.max_turn > 0 && gates.max_turn <= 180, "max_turn", gates.max_turn, "above 0 to 180 degrees");
  require(gates.hypotheses >= 1, "hypotheses", gates.hypotheses, "1 or more");
  require(parameters.min_matches >= 1, "min_matches", static_cast<double>(parameters.min_matches),
          "1 or more");
  requireWithin("min_score", parameters.min_score, 0, 1, "0 to 1");
}

double largestSigma(const AlignmentParameters& parameters, double voxel_size) {
  constexpr double CLOSE_RANGE = 0.05;  // [m]
  constexpr double IN_VOXELS = 0.12;  // a third of the spacing; right poses were predicted to 0.03-0.1 voxels
  return parameters.max_sigma.value_or(std::max(CLOSE_RANGE, IN_VOXELS * voxel_size));
}

ScanPair::ScanPair(const ScanSegments& moving, const ScanSegments& reference,
                   const Eigen::Isometry3d& initial_guess, const AlignmentParameters& parameters)
    : coarse_moving_(coarsenedTo(reference, moving)),
      coarse_reference_(coarsenedTo(moving, reference)),
      moving_scan_(coarse_moving_ ? *coarse_moving_ : moving),
      reference_scan_(coarse_reference_ ? *coarse_reference_ : reference),
      parameters_(parameters),
      initial_guess_(checked(initial_guess, parameters)),
      guess_inverse_(initial_guess.inverse()),
      margin_(SEEN_WITHIN * reference_scan_.voxel_size),
      moving_(placedSegments(moving_scan_, initial_guess, parameters.neighbours)),
      reference_(placedSegments(reference_scan_, Eigen::Isometry3d::Identity(), parameters.neighbours)) {}

Points evenSample(const PointsView& points, Eigen::Index count) {
  if (points.cols() <= count) return points;
  Points sample(3, count);
  for (Eigen::Index n = 0; n < count; ++n) sample.col(n) = points.col(n * points.cols() / count);
  return sample;
}

}  // namespace pcl_fft_ground::core
