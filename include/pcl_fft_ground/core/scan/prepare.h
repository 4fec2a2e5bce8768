#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/scan/frame.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// Points as they came, one per column: any floats, NaN and infinity among them.
using RawPoints = Eigen::Matrix3Xf;

/// The points of a scan that can be worked with, and where in the scan they stand.
struct UsablePoints {
  Points points;  ///< finite and not far from all others (findFarPoints()), in the order of the scan
  std::vector<Eigen::Index> columns;  ///< of these points in the scan; empty if they are all of the scan
  std::vector<Eigen::Index> far;      ///< columns of the finite points that are far away, ascending
  PointStatistics statistics;         ///< of `points`

  /// Column in the scan of the n-th point.
  Eigen::Index column(Eigen::Index n) const {
    return columns.empty() ? n : columns[static_cast<std::size_t>(n)];
  }
};

/** Takes the usable points out of a scan.
 *
 * A point with a coordinate beyond 1e18 is far, whatever the others are: a float does not hold its square.
 *
 * \param scan points in any frame; those that are moved in are worked on in place
 * \note O(n)
 */
PCL_FFT_GROUND_CORE_EXPORT UsablePoints usablePoints(RawPoints scan);

/// A scan made ready for a method.
struct PreparedScan {
  UsablePoints usable;  ///< the points in the level frame, their statistics in the frame of the scan
  UpDirection up;       ///< in the frame of the scan
  Eigen::Isometry3d frame_from_input = Eigen::Isometry3d::Identity();  ///< brings points of the scan there
};

/** Takes the usable points out of a scan and levels them: what every method starts with.
 * \param scan points in any frame; those that are moved in are worked on in place
 */
PCL_FFT_GROUND_CORE_EXPORT PreparedScan prepare(RawPoints scan, const FrameParameters& parameters);

}  // namespace pcl_fft_ground::core
