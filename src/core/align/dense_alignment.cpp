#include "pcl_fft_ground/core/align/dense_alignment.h"

#include <cmath>
#include <memory>
#include <vector>

#include "align/icp.h"
#include "align/verdict.h"

namespace pcl_fft_ground::core {
namespace {

constexpr Eigen::Index SAMPLE = 4000;  // points of the moving scan that take part
constexpr double GATE = 25;            // largest distance of correspondences [voxels]
constexpr double SETTLED = 0.0005;     // [voxels]

/// Point-to-plane ICP of all points, wherever it converges.
IcpResult icpOfAllPoints(const ScanPair& pair) {
  const double voxel = pair.voxelSize();
  const Points& surface = pair.referenceScan().surface;
  const Points sample = evenSample(transformed(pair.movingScan().surface, pair.initialGuess()), SAMPLE);
  const std::unique_ptr<NearestNeighbours> search = pair.parameters().neighbours(surface, voxel);
  SurfaceNormals normals(surface, voxel, pair.parameters().neighbours,
                         static_cast<std::size_t>(surface.cols()));
  const auto find = [&](const Eigen::Isometry3d& correction, double gate) {
    std::vector<Correspondence> found;
    for (Eigen::Index n = 0; n < sample.cols(); ++n) {
      const Eigen::Vector3d point = correction * sample.col(n).cast<double>();
      const Neighbour nearest = search->nearest(point.cast<float>(), static_cast<float>(gate));
      if (nearest.index < 0) continue;
      const double distance = std::sqrt(static_cast<double>(nearest.squared_distance));
      found.push_back({point, surface.col(nearest.index).cast<double>(),
                       static_cast<std::size_t>(nearest.index), weightOf(distance, gate), 0});
    }
    return found;
  };
  const auto step = [&](const std::vector<Correspondence>& correspondences, const Eigen::Vector3d& centre) {
    return stepToPlanes(correspondences, centre, normals);
  };
  const Eigen::Isometry3d correction =
      iterateIcp(Eigen::Isometry3d::Identity(), {GATE * voxel, GATE * voxel, SETTLED * voxel}, find, step);
  return summariseIcp(correction, find(correction, GATE * voxel), normals);
}

}  // namespace

Alignment alignDensely(const ScanSegments& moving, const ScanSegments& reference,
                       const Eigen::Isometry3d& initial_guess, const AlignmentParameters& parameters,
                       DensePoints which) {
  const ScanPair pair(moving, reference, initial_guess, parameters);
  if (which == DensePoints::OVERLAP) return alignSurfaces(pair, {});
  const IcpResult result = icpOfAllPoints(pair);
  Alignment alignment = alignmentOf(pair, result, AlignmentMethod::DENSE);
  alignment.accepted = true;
  alignment.score = AlignmentScore(pair).of(result.correction).score;
  return alignment;
}

}  // namespace pcl_fft_ground::core
