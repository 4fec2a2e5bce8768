#include "align/alignment_score.h"

#include <algorithm>
#include <vector>

namespace pcl_fft_ground::core {
namespace {

constexpr double NEAR = 1.5;                 // points this near agree [voxels]
constexpr Eigen::Index SCORE_SAMPLE = 3000;  // points of each scan

/// Adds the points that the other scan has seen, and those that agree with it.
template <typename Sees>
void count(const Points& sample, const Eigen::Isometry3d& transform, const NearestNeighbours& search,
           const Sees& sees, float near, std::size_t& seen, std::size_t& agreeing) {
  for (Eigen::Index n = 0; n < sample.cols(); ++n) {
    const Eigen::Vector3d point = transform * sample.col(n).cast<double>();
    if (!sees(point)) continue;
    ++seen;
    if (search.nearest(point.cast<float>(), near).index >= 0) ++agreeing;
  }
}

}  // namespace

AlignmentScore::AlignmentScore(const ScanPair& pair)
    : pair_(pair),
      moving_(transformed(pair.initialGuess(), pair.movingScan().objects)),
      moving_sample_(evenSample(moving_, SCORE_SAMPLE)),
      reference_sample_(evenSample(pair.referenceScan().objects, SCORE_SAMPLE)),
      moving_search_(pair.parameters().neighbours(moving_, pair.voxelSize())),
      reference_search_(pair.parameters().neighbours(pair.referenceScan().objects, pair.voxelSize())) {}

Agreement AlignmentScore::of(const Eigen::Isometry3d& correction) const {
  const auto near = static_cast<float>(NEAR * pair_.voxelSize());
  std::size_t seen = 0;
  std::size_t agreeing = 0;
  count(
      moving_sample_, correction, *reference_search_,
      [this](const Eigen::Vector3d& place) { return pair_.referenceSees(place); }, near, seen, agreeing);
  count(
      reference_sample_, correction.inverse(), *moving_search_,
      [this](const Eigen::Vector3d& place) { return pair_.movingSees(place); }, near, seen, agreeing);
  if (seen == 0) return {};
  return {static_cast<double>(agreeing) / static_cast<double>(seen), seen};
}

double overlapOf(const ScanPair& pair, const Eigen::Isometry3d& correction) {
  const ScanCoverage& coverage = pair.movingScan().coverage;
  const Eigen::Isometry3d transform = correction * pair.initialGuess();
  Eigen::Index both = 0;
  for (Eigen::Index j = 0; j < coverage.depth.cols(); ++j)
    for (Eigen::Index i = 0; i < coverage.depth.rows(); ++i) {
      if (coverage.depth(i, j) <= 0) continue;
      const Eigen::Vector2d place =
          coverage.geometry.origin +
          coverage.geometry.cell_size *
              Eigen::Vector2d(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5);
      const Eigen::Vector3d there = transform * Eigen::Vector3d(place.x(), place.y(), 0);
      if (pair.referenceScan().coverage.depthAt(there.x(), there.y()) > 0) ++both;
    }
  const double area = std::min(coverage.area(), pair.referenceScan().coverage.area());
  const double cell_area = coverage.geometry.cell_size * coverage.geometry.cell_size;
  return area > 0 ? std::min(1.0, static_cast<double>(both) * cell_area / area) : 0;
}

}  // namespace pcl_fft_ground::core
