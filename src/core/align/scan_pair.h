#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "pcl_fft_ground/core/align/segment_alignment.h"
#include "pcl_fft_ground/core/scan/frame.h"

namespace pcl_fft_ground::core {

/// A segment at the place that the initial guess gives it, ready to be searched.
struct PlacedSegment {
  Points points;  ///< in the frame of the reference [m]
  Points sample;  ///< a few of them, evenly taken
  Eigen::Vector3d centroid;
  Eigen::Vector3d extents;
  bool at_border;
  std::unique_ptr<NearestNeighbours> search;  ///< over the points
};

/// Two scans in the frame of the reference, the moving one placed by the initial guess.
class ScanPair {
 public:
  /** Keeps references to the scans and the parameters; of scans with different voxels the finer is coarsened.
   * \throws std::invalid_argument if a parameter is out of range or the guess is not finite
   */
  ScanPair(const ScanSegments& moving, const ScanSegments& reference, const Eigen::Isometry3d& initial_guess,
           const AlignmentParameters& parameters);
  ScanPair(const ScanPair&) = delete;
  ScanPair& operator=(const ScanPair&) = delete;

  const ScanSegments& movingScan() const { return moving_scan_; }
  const ScanSegments& referenceScan() const { return reference_scan_; }
  const AlignmentParameters& parameters() const { return parameters_; }
  double voxelSize() const { return reference_scan_.voxel_size; }
  const Eigen::Isometry3d& initialGuess() const { return initial_guess_; }

  const std::vector<PlacedSegment>& moving() const { return moving_; }
  const std::vector<PlacedSegment>& reference() const { return reference_; }

  /// True if the reference has looked at a place. \param place in the frame of the reference
  bool referenceSees(const Eigen::Vector3d& place) const {
    return reference_scan_.coverage.covers(place, margin_);
  }
  /// True if the moving scan has looked at a place. \param place where the initial guess puts it
  bool movingSees(const Eigen::Vector3d& place) const {
    return moving_scan_.coverage.covers(guess_inverse_ * place, margin_);
  }

 private:
  std::optional<ScanSegments> coarse_moving_;
  std::optional<ScanSegments> coarse_reference_;
  const ScanSegments& moving_scan_;
  const ScanSegments& reference_scan_;
  const AlignmentParameters& parameters_;
  Eigen::Isometry3d initial_guess_;
  Eigen::Isometry3d guess_inverse_;
  double margin_;  // a place this far within the coverage has been looked at [m]
  std::vector<PlacedSegment> moving_;
  std::vector<PlacedSegment> reference_;
};

/// At most `count` of the points, evenly taken.
Points evenSample(const PointsView& points, Eigen::Index count);

}  // namespace pcl_fft_ground::core
