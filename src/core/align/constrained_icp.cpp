#include "align/icp.h"

#include <cmath>

namespace pcl_fft_ground::core {
namespace {

constexpr Eigen::Index SAMPLE = 250;      // points of a segment that take part
constexpr Eigen::Index ROUGHLY = 4;       // one in so many of them suffices to come near
constexpr double FINEST_GATE = 1.5;       // [voxels]
constexpr double PLANE_GATE = 3;          // at the start of point-to-plane [voxels]
constexpr double ROUGHLY_SETTLED = 0.01;  // a smaller step ends point-to-point at the finest gate [voxels]
constexpr double SETTLED = 0.0005;        // the same for point-to-plane [voxels]
constexpr double LEAST_DEVIATION = 0.1;   // of a point from its plane, whatever the residuals say [voxels]

std::size_t pointsOf(const std::vector<PlacedSegment>& segments) {
  std::size_t count = 0;
  for (const PlacedSegment& segment : segments) count += static_cast<std::size_t>(segment.points.cols());
  return count;
}

}  // namespace

ConstrainedIcp::ConstrainedIcp(const ScanPair& pair)
    : pair_(pair),
      normals_(pair.referenceScan().surface, pair.voxelSize(), pair.parameters().neighbours,
               pointsOf(pair.reference())) {
  for (const PlacedSegment& segment : pair.moving()) samples_.push_back(evenSample(segment.points, SAMPLE));
  std::size_t place = 0;
  for (const PlacedSegment& segment : pair.reference()) {
    first_place_.push_back(place);
    place += static_cast<std::size_t>(segment.points.cols());
  }
}

std::optional<Correspondence> ConstrainedIcp::correspondenceOf(const Eigen::Vector3d& point,
                                                               const std::vector<std::size_t>& segments,
                                                               double gate) const {
  std::optional<Correspondence> best;
  double reach = gate;
  for (const std::size_t j : segments) {
    const PlacedSegment& segment = pair_.reference()[j];
    const Neighbour nearest = segment.search->nearest(point.cast<float>(), static_cast<float>(reach));
    if (nearest.index < 0) continue;
    reach = std::sqrt(static_cast<double>(nearest.squared_distance));
    best =
        Correspondence{point, segment.points.col(nearest.index).cast<double>(),
                       first_place_[j] + static_cast<std::size_t>(nearest.index), weightOf(reach, gate), j};
  }
  return best;
}

FindCorrespondences ConstrainedIcp::correspondencesIn(const std::vector<SegmentMatch>& matches,
                                                      Eigen::Index one_in) const {
  std::vector<std::vector<std::size_t>> segments_of(samples_.size());
  for (const SegmentMatch& match : matches) segments_of[match.moving].push_back(match.reference);
  return [this, segments_of, one_in](const Eigen::Isometry3d& correction, double gate) {
    std::vector<Correspondence> found;
    for (std::size_t i = 0; i < samples_.size(); ++i)
      for (Eigen::Index n = 0; n < samples_[i].cols() && !segments_of[i].empty(); n += one_in) {
        const Eigen::Vector3d point = correction * samples_[i].col(n).cast<double>();
        if (!pair_.referenceSees(point)) continue;
        const std::optional<Correspondence> correspondence = correspondenceOf(point, segments_of[i], gate);
        if (correspondence) found.push_back(*correspondence);
      }
    return found;
  };
}

Eigen::Isometry3d ConstrainedIcp::approach(const std::vector<SegmentMatch>& matches,
                                           const Eigen::Isometry3d& start, double gate) const {
  const double voxel = pair_.voxelSize();
  return iterateIcp(start, {gate * voxel, FINEST_GATE * voxel, ROUGHLY_SETTLED * voxel},
                    correspondencesIn(matches, ROUGHLY), stepToPoints);
}

IcpResult ConstrainedIcp::refine(const std::vector<SegmentMatch>& matches, const Eigen::Isometry3d& start) {
  const double voxel = pair_.voxelSize();
  const FindCorrespondences find = correspondencesIn(matches, 1);
  const Eigen::Isometry3d correction =
      iterateIcp(start, {PLANE_GATE * voxel, FINEST_GATE * voxel, SETTLED * voxel}, find,
                 [this](const std::vector<Correspondence>& correspondences, const Eigen::Vector3d& centre) {
                   return stepToPlanes(correspondences, centre, normals_);
                 });
  IcpResult result = summariseIcp(correction, find(correction, FINEST_GATE * voxel), normals_);
  result.least_deviation = LEAST_DEVIATION * voxel;
  return result;
}

}  // namespace pcl_fft_ground::core
