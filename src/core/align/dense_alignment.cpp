#include "pcl_fft_ground/core/align/dense_alignment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "align/icp.h"
#include "align/verdict.h"

namespace pcl_fft_ground::core {
namespace {

constexpr Eigen::Index SAMPLE = 4000;      // points of the moving scan that take part
constexpr double FIRST_GATE = 12.5;        // [voxels]
constexpr double MIDDLE_GATE = 2.5;        // narrowed only when this one has settled [voxels]
constexpr double FINEST_GATE = 1.5;        // [voxels]
constexpr double WHOLE_SCAN_GATE = 25;     // where all points take part [voxels]
constexpr double SETTLED = 0.0005;         // [voxels]
constexpr std::size_t LEAST_POINTS = 200;  // correspondences that a result has to rest on
constexpr double LARGEST_RESIDUAL = 0.5;   // root of the mean squared distance to the planes [voxels]
constexpr double LEAST_RESIDUAL = 0.1;     // less says nothing about the contrast [voxels]
constexpr double LARGEST_DISTANCE = 1.5;   // from a plane that counts; more counts the same [voxels]
constexpr double TEST_SHIFT = 2.5;  // by which a wrong transform is off, to see what that costs [voxels]
constexpr double TELLING_DISTANCE = 0.5;  // the same for the contrast: what one scan alone sees counts little
constexpr double LEAST_CONTRAST = 2;      // factor by which it has to raise the mean squared distance
constexpr double ROUGHLY = 0.5;           // share of the least score that makes a closer look worth while

/// ICP of the surfaces of two scans, ground included.
class DenseIcp {
 public:
  DenseIcp(const ScanPair& pair, DensePoints which)
      : pair_(pair),
        which_(which),
        sample_(evenSample(transformed(pair.movingScan().surface, pair.initialGuess()), SAMPLE)),
        search_(pair.parameters().neighbours(surface(), pair.voxelSize())),
        normals_(surface(), pair.voxelSize(), pair.parameters().neighbours,
                 static_cast<std::size_t>(surface().cols())) {}

  /// \param gates largest distances of correspondences [voxels], falling: what is found with one starts the
  /// next
  IcpResult run(const std::vector<double>& gates) {
    const double voxel = pair_.voxelSize();
    const auto find = [this](const Eigen::Isometry3d& correction, double gate) {
      return findCorrespondences(correction, gate);
    };
    const auto step = [this](const std::vector<Correspondence>& correspondences,
                             const Eigen::Vector3d& centre) {
      return stepToPlanes(correspondences, centre, normals_);
    };
    Eigen::Isometry3d correction = Eigen::Isometry3d::Identity();
    for (std::size_t n = 0; n + 1 < gates.size(); ++n)
      correction =
          iterateIcp(correction, {gates[n] * voxel, gates[n + 1] * voxel, SETTLED * voxel}, find, step);
    return summariseIcp(correction, find(correction, gates.back() * voxel), normals_);
  }

  std::vector<Correspondence> findCorrespondences(const Eigen::Isometry3d& correction, double gate) const {
    std::vector<Correspondence> found;
    for (Eigen::Index n = 0; n < sample_.cols(); ++n) {
      const Eigen::Vector3d point = correction * sample_.col(n).cast<double>();
      if (which_ == DensePoints::OVERLAP && !pair_.referenceSees(point)) continue;
      const Neighbour nearest = search_->nearest(point.cast<float>(), static_cast<float>(gate));
      if (nearest.index < 0) continue;
      const double distance = std::sqrt(static_cast<double>(nearest.squared_distance));
      found.push_back({point, surface().col(nearest.index).cast<double>(),
                       static_cast<std::size_t>(nearest.index), weightOf(distance, gate), 0});
    }
    return found;
  }

  /// Mean squared distance to the planes after another shift [m^2]. \param largest distance that counts;
  /// more counts the same [voxels]
  double residualAfter(const Eigen::Vector3d& shift, const Eigen::Isometry3d& correction, double largest) {
    const Eigen::Isometry3d shifted = Eigen::Translation3d(shift) * correction;
    const std::vector<Correspondence> correspondences =
        findCorrespondences(shifted, FIRST_GATE * pair_.voxelSize());
    const double most = std::pow(largest * pair_.voxelSize(), 2);
    double sum = 0, count = 0;
    for (const Correspondence& p : correspondences) {
      const Eigen::Vector3d& normal = normals_.at(p.place, p.reference);
      if (normal.isZero()) continue;
      const double distance = normal.dot(p.moving - p.reference);
      sum += std::min(distance * distance, most);
      ++count;
    }
    return count > 0 ? sum / count : 0;
  }

 private:
  const Points& surface() const { return pair_.referenceScan().surface; }

  const ScanPair& pair_;
  DensePoints which_;
  Points sample_;
  std::unique_ptr<NearestNeighbours> search_;
  SurfaceNormals normals_;
};

/// Empty if the surfaces fit, and fit nowhere near by: a plain sea floor fits anywhere.
std::string reasonAgainstFit(const ScanPair& pair, DenseIcp& icp, const Eigen::Isometry3d& correction) {
  const Eigen::Vector3d here = Eigen::Vector3d::Zero();
  if (std::sqrt(icp.residualAfter(here, correction, LARGEST_DISTANCE)) > LARGEST_RESIDUAL * pair.voxelSize())
    return "the surfaces do not fit";
  const double least = std::pow(LEAST_RESIDUAL * pair.voxelSize(), 2);
  const double residual = std::max(least, icp.residualAfter(here, correction, TELLING_DISTANCE));
  const double shift = TEST_SHIFT * pair.voxelSize();
  for (const Eigen::Vector3d& direction :
       std::array<Eigen::Vector3d, 4>{{Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitX(),
                                       Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitY()}})
    if (icp.residualAfter(shift * direction, correction, TELLING_DISTANCE) < LEAST_CONTRAST * residual)
      return "the surfaces fit as well elsewhere";
  return {};
}

/// Empty if so many points meet, and so many of the objects, that a closer look is worth while.
std::string reasonAgainstMeeting(const ScanPair& pair, const DenseIcp& icp, const IcpResult& result,
                                 const Agreement& agreement, double least_score) {
  const double gate = FINEST_GATE * pair.voxelSize();
  if (icp.findCorrespondences(result.correction, gate).size() < LEAST_POINTS) return "hardly any overlap";
  const std::string reason = reasonAgainstMotion(pair, result);
  if (!reason.empty()) return reason;
  if (agreement.points >= TELLING_OBJECTS && agreement.score < least_score) return "the objects do not agree";
  return {};
}

Alignment accepted(const ScanPair& pair, const IcpResult& result, const Agreement& agreement) {
  Alignment alignment = alignmentOf(pair, result, AlignmentMethod::DENSE);
  alignment.accepted = true;
  alignment.score = agreement.score;
  return alignment;
}

/// Makes what dense ICP came to precise. \return the result or, if it does not pass the gates, why not
Alignment refineOnPlanes(const ScanPair& pair, DenseIcp& icp, const IcpResult& rough,
                         const AlignmentScore& score) {
  const double least_score = SHARE_OF_SCORE * pair.parameters().min_score;
  const Agreement at_first = score.of(rough.correction);
  const std::string far_off = reasonAgainstMeeting(pair, icp, rough, at_first, ROUGHLY * least_score);
  if (!far_off.empty()) return refused(pair, far_off);
  const IcpResult result = alignPlanes(pair, rough.correction);
  const Agreement agreement = score.of(result.correction);
  std::string reason = reasonAgainstMeeting(pair, icp, result, agreement, least_score);
  if (reason.empty()) reason = reasonAgainst(pair, result);
  if (reason.empty()) reason = reasonAgainstFit(pair, icp, result.correction);
  if (!reason.empty()) return refused(pair, reason);
  return accepted(pair, result, agreement);
}

}  // namespace

Alignment alignDensely(const ScanPair& pair, DensePoints which) {
  DenseIcp icp(pair, which);
  const AlignmentScore score(pair);
  if (which == DensePoints::OVERLAP)
    return refineOnPlanes(pair, icp, icp.run({FIRST_GATE, MIDDLE_GATE, FINEST_GATE}), score);
  const IcpResult result = icp.run({WHOLE_SCAN_GATE, WHOLE_SCAN_GATE});
  return accepted(pair, result, score.of(result.correction));
}

Alignment alignDensely(const ScanSegments& moving, const ScanSegments& reference,
                       const Eigen::Isometry3d& initial_guess, const AlignmentParameters& parameters,
                       DensePoints which) {
  return alignDensely(ScanPair(moving, reference, initial_guess, parameters), which);
}

}  // namespace pcl_fft_ground::core
