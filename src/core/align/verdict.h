#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "align/icp.h"
#include "align/scan_pair.h"

namespace pcl_fft_ground::core {

/// Object points seen by both scans that have to agree where the ground was aligned, too...
constexpr std::size_t TELLING_OBJECTS = 50;
/// ...and the share of min_score that does where all surfaces are compared.
constexpr double SHARE_OF_SCORE = 0.75;

/// How well two scans agree on where objects are, in the places that both have seen.
struct Agreement {
  double score = 0;        ///< share of these object points that have one of the other scan near, [0, 1]
  std::size_t points = 0;  ///< object points that this rests on, a sample of them
};

/// Judges corrections of the initial guess by the object points of both scans.
class AlignmentScore {
 public:
  explicit AlignmentScore(const ScanPair& pair);

  /// \param one_in of so many points of the samples: 1 all of them
  Agreement of(const Eigen::Isometry3d& correction, Eigen::Index one_in = 1) const;

 private:
  const ScanPair& pair_;
  Points moving_;  // all object points, where the initial guess puts them
  Points moving_sample_;
  Points reference_sample_;
  std::unique_ptr<NearestNeighbours> moving_search_;
  std::unique_ptr<NearestNeighbours> reference_search_;
};

/// Poses that differ from one by horizontal shifts of 6 to 16 voxels, every way: what fits there fits by
/// chance.
std::vector<Eigen::Isometry3d> placesAround(const Eigen::Isometry3d& pose, double voxel_size);

/// Share of the smaller scan's area that both have seen, under a correction of the initial guess.
double overlapOf(const ScanPair& pair, const Eigen::Isometry3d& correction);

/// Covariance of an alignment for motions about the centre of the ICP's points; nothing if they do not hold
/// it.
std::optional<Matrix6d> covarianceAboutCentre(const IcpResult& icp);

/// "the shift is 3 m, allowed are 2 m"
std::string exceeding(const std::string& what, double value, double allowed, const std::string& unit);

/// Why a correction of the initial guess is larger than it may be; empty if it is not.
std::string reasonAgainstMotion(const ScanPair& pair, const IcpResult& icp);

/// Why a correction of the initial guess is not to be believed, by its size, its predicted error and what is
/// left of the distances; empty if it is.
std::string reasonAgainst(const ScanPair& pair, const IcpResult& icp);

/// The initial guess as it is, and why.
Alignment refused(const ScanPair& pair, const std::string& reason);

/// The result with what every method reports: transform, covariance, overlap.
Alignment alignmentOf(const ScanPair& pair, const IcpResult& icp, AlignmentMethod method);

/** Alignment of all surfaces of a pair, ground and objects, judged by what both scans could see.
 *
 * ICP from the guess and from around it; of the poses that it comes to the likeliest is accepted if
 * navigation allows it, the surfaces agree in every direction, hardly any stand where the other scan has
 * looked through, and no other pose comes near. \param more_starts corrections of the guess to start from,
 * too
 */
Alignment alignSurfaces(const ScanPair& pair, const std::vector<Eigen::Isometry3d>& more_starts);

}  // namespace pcl_fft_ground::core
