#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "align/scan_pair.h"

namespace pcl_fft_ground::core {

/// How one segment comes to lie on another.
struct LocalAlignment {
  Eigen::Isometry3d correction = Eigen::Isometry3d::Identity();  ///< of the initial guess: yaw and shift
  double shape_distance = 0;                                     ///< mean distance between the two [m]
  double covered = 0;  ///< share of the points that the other scan has seen, the lower of both, [0, 1]
};

/** ICP of two segments by themselves: yaw and shift, both ways, only where the other scan has looked.
 * \param start correction to begin with
 * \param max_distance largest mean distance of segments that are alike [m]
 * \return nothing if they are not alike or too little of either has been seen by the other scan
 */
std::optional<LocalAlignment> alignLocally(const ScanPair& pair, const PlacedSegment& moving,
                                           const PlacedSegment& reference, const Eigen::Isometry3d& start,
                                           double max_distance);

}  // namespace pcl_fft_ground::core
