#include "align/segment_matching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pcl_fft_ground/core/align/rigid_fit.h"

namespace pcl_fft_ground::core {
namespace {

constexpr int MAX_ITERATIONS = 12;
constexpr double LEAST_COVERED = 0.3;
constexpr double LEAST_SCALE = 0.5;  // of the robust weights [voxels]
constexpr double SETTLED = 0.05;     // a smaller step ends the iteration [voxels]
constexpr Eigen::Index ROUGHLY = 4;  // one in so many points tells whether two segments are worth all of them
constexpr double HOPELESS = 1.5;     // of the largest distance: by one in four points unlike

/// A point of the moving segment, corrected by the current transform, and its correspondence in the
/// reference.
struct Correspondence {
  Eigen::Vector3d moving;
  Eigen::Vector3d reference;
  double distance;
};

struct CorrespondenceSet {
  std::vector<Correspondence> correspondences;
  double shape_distance = 0;
  double covered = 0;
};

double shareOf(std::size_t part, Eigen::Index whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

double meanDistance(const std::vector<Correspondence>& correspondences, std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t n = first; n < last; ++n) sum += correspondences[n].distance;
  return sum / static_cast<double>(last - first);
}

/// Correspondences in the reference of one in `step` of the moving segment's points, then the other way
/// round.
CorrespondenceSet findCorrespondences(const ScanPair& pair, const PlacedSegment& moving,
                                      const PlacedSegment& reference, const Eigen::Isometry3d& correction,
                                      Eigen::Index step) {
  constexpr float ANYWHERE = 1e6F;
  CorrespondenceSet result;
  for (Eigen::Index n = 0; n < moving.sample.cols(); n += step) {
    const Eigen::Vector3d point = correction * moving.sample.col(n).cast<double>();
    if (!pair.referenceSees(point)) continue;
    const Neighbour nearest = reference.search->nearest(point.cast<float>(), ANYWHERE);
    result.correspondences.push_back({point, reference.points.col(nearest.index).cast<double>(),
                                      std::sqrt(static_cast<double>(nearest.squared_distance))});
  }
  const std::size_t forward = result.correspondences.size();
  const Eigen::Isometry3d inverse = correction.inverse();
  for (Eigen::Index n = 0; n < reference.sample.cols(); n += step) {
    const Eigen::Vector3d point = reference.sample.col(n).cast<double>();
    const Eigen::Vector3d uncorrected = inverse * point;
    if (!pair.movingSees(uncorrected)) continue;
    const Neighbour nearest = moving.search->nearest(uncorrected.cast<float>(), ANYWHERE);
    result.correspondences.push_back({correction * moving.points.col(nearest.index).cast<double>(), point,
                                      std::sqrt(static_cast<double>(nearest.squared_distance))});
  }
  const std::size_t backward = result.correspondences.size() - forward;
  result.covered = std::min(shareOf(forward, (moving.sample.cols() + step - 1) / step),
                            shareOf(backward, (reference.sample.cols() + step - 1) / step));
  if (forward > 0 && backward > 0)
    result.shape_distance =
        0.5 * (meanDistance(result.correspondences, 0, forward) +
               meanDistance(result.correspondences, forward, result.correspondences.size()));
  return result;
}

double medianDistance(const std::vector<Correspondence>& correspondences) {
  std::vector<double> distances;
  distances.reserve(correspondences.size());
  for (const Correspondence& p : correspondences) distances.push_back(p.distance);
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

/// The robust step that brings the moving correspondences nearer, fitted about the given place.
Eigen::Isometry3d stepOf(const std::vector<Correspondence>& correspondences, const Eigen::Vector3d& about,
                         double voxel_size) {
  const double scale = std::max(2 * medianDistance(correspondences), LEAST_SCALE * voxel_size);
  YawFit fit;
  for (const Correspondence& p : correspondences) {
    const double ratio = p.distance / scale;
    fit.add(p.moving - about, p.reference - about, 1 / (1 + ratio * ratio));
  }
  return Eigen::Translation3d(about) * fit.solve() * Eigen::Translation3d(-about);
}

/// Moves the segment on to its correspondences until it stays or too little of it is covered.
LocalAlignment iterate(const ScanPair& pair, const PlacedSegment& moving, const PlacedSegment& reference,
                       const Eigen::Isometry3d& start, Eigen::Index one_in) {
  Eigen::Isometry3d correction = start;
  CorrespondenceSet found = findCorrespondences(pair, moving, reference, correction, one_in);
  for (int iteration = 0; iteration < MAX_ITERATIONS && found.covered >= LEAST_COVERED; ++iteration) {
    const Eigen::Isometry3d step = stepOf(found.correspondences, reference.centroid, pair.voxelSize());
    correction = step * correction;
    found = findCorrespondences(pair, moving, reference, correction, one_in);
    const double moved = (step * reference.centroid - reference.centroid).norm() +
                         std::abs(yawOf(step)) * reference.extents.norm();
    if (moved < SETTLED * pair.voxelSize()) break;
  }
  return {correction, found.shape_distance, found.covered};
}

}  // namespace

std::optional<LocalAlignment> alignLocally(const ScanPair& pair, const PlacedSegment& moving,
                                           const PlacedSegment& reference, const Eigen::Isometry3d& start,
                                           double max_distance) {
  const LocalAlignment rough = iterate(pair, moving, reference, start, ROUGHLY);
  if (rough.covered < LEAST_COVERED || rough.shape_distance > HOPELESS * max_distance) return std::nullopt;
  const LocalAlignment fine = iterate(pair, moving, reference, rough.correction, 1);
  if (fine.covered < LEAST_COVERED || fine.shape_distance > max_distance) return std::nullopt;
  return fine;
}

}  // namespace pcl_fft_ground::core
