#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "align/scan_pair.h"

namespace pcl_fft_ground::core {

/// How well two scans agree on where objects are, in the places that both have seen.
struct Agreement {
  double score = 0;        ///< share of these object points that have one of the other scan near, [0, 1]
  std::size_t points = 0;  ///< object points that this rests on, a sample of them
};

/// Judges corrections of the initial guess by the object points of both scans.
class AlignmentScore {
 public:
  explicit AlignmentScore(const ScanPair& pair);

  Agreement of(const Eigen::Isometry3d& correction) const;

 private:
  const ScanPair& pair_;
  Points moving_;  // all object points, where the initial guess puts them
  Points moving_sample_;
  Points reference_sample_;
  std::unique_ptr<NearestNeighbours> moving_search_;
  std::unique_ptr<NearestNeighbours> reference_search_;
};

/// Share of the smaller scan's area that both have seen, under a correction of the initial guess.
double overlapOf(const ScanPair& pair, const Eigen::Isometry3d& correction);

}  // namespace pcl_fft_ground::core
