#include "align/segment_matching.h"

#include <limits>

namespace pcl_fft_ground::core {
namespace {

constexpr double NEAR = 1.5;         // points this near agree [voxels]
constexpr double LEAST_SHARE = 0.5;  // of the points that the other scan has seen

Eigen::AlignedBox3f boxAround(const PlacedSegment& segment, float margin) {
  return {Eigen::Vector3f(segment.points.rowwise().minCoeff().array() - margin),
          Eigen::Vector3f(segment.points.rowwise().maxCoeff().array() + margin)};
}

/// The points of a segment that the other scan has seen, where they come to lie.
template <typename Sees>
Points seenPoints(const PlacedSegment& segment, const Eigen::Isometry3d& transform, const Sees& sees) {
  Points seen = transformed(segment.sample, transform);
  Eigen::Index count = 0;
  for (Eigen::Index n = 0; n < seen.cols(); ++n)
    if (sees(seen.col(n).template cast<double>())) seen.col(count++) = seen.col(n);
  seen.conservativeResize(Eigen::NoChange, count);
  return seen;
}

/// True if enough of the points lie near the segment.
bool lieOn(const Points& points, const PlacedSegment& segment, const Eigen::AlignedBox3f& box, float near) {
  Eigen::Index count = 0;
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    if (box.contains(points.col(n)) && segment.search->nearest(points.col(n), near).index >= 0) ++count;
  return count > 0 && static_cast<double>(count) >= LEAST_SHARE * static_cast<double>(points.cols());
}

/// For each segment which of the others it lies on.
template <typename Sees>
std::vector<std::vector<bool>> lying(const std::vector<PlacedSegment>& segments,
                                     const Eigen::Isometry3d& transform,
                                     const std::vector<PlacedSegment>& others, const Sees& sees, float near) {
  std::vector<Eigen::AlignedBox3f> boxes;
  boxes.reserve(others.size());
  for (const PlacedSegment& other : others) boxes.push_back(boxAround(other, near));
  std::vector<std::vector<bool>> result;
  for (const PlacedSegment& segment : segments) {
    const Points seen = seenPoints(segment, transform, sees);
    std::vector<bool>& on = result.emplace_back(others.size());
    for (std::size_t k = 0; k < others.size(); ++k) on[k] = lieOn(seen, others[k], boxes[k], near);
  }
  return result;
}

}  // namespace

std::vector<SegmentMatch> associateSegments(const ScanPair& pair, const Eigen::Isometry3d& correction) {
  const auto near = static_cast<float>(NEAR * pair.voxelSize());
  const auto forward = lying(
      pair.moving(), correction, pair.reference(),
      [&](const Eigen::Vector3d& place) { return pair.referenceSees(place); }, near);
  const auto backward = lying(
      pair.reference(), correction.inverse(), pair.moving(),
      [&](const Eigen::Vector3d& place) { return pair.movingSees(place); }, near);
  std::vector<SegmentMatch> matches;
  for (std::size_t i = 0; i < forward.size(); ++i)
    for (std::size_t j = 0; j < backward.size(); ++j)
      if (forward[i][j] || backward[j][i]) matches.push_back({i, j});
  return matches;
}

}  // namespace pcl_fft_ground::core
