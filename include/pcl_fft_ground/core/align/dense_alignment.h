#pragma once

#include <Eigen/Geometry>

#include "pcl_fft_ground/core/align/segment_alignment.h"
#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/segments/segment.h"

namespace pcl_fft_ground::core {

/// Which points dense ICP takes.
enum class DensePoints {
  OVERLAP,     ///< those where both scans have looked
  EVERYWHERE,  ///< all: borders pull the scans on to each other
};

/** Dense point-to-plane ICP of whole scans, ground included.
 *
 * Over the overlap only it is the fallback of alignScans() and passes the same gates. Over all points it is
 * what the paper warns of at its Fig. 5, accepted wherever it converges.
 *
 * \param moving,reference,initial_guess,parameters as in alignScans(); `matches` stay empty
 */
PCL_FFT_GROUND_CORE_EXPORT Alignment alignDensely(const ScanSegments& moving, const ScanSegments& reference,
                                                  const Eigen::Isometry3d& initial_guess,
                                                  const AlignmentParameters& parameters = {},
                                                  DensePoints which = DensePoints::OVERLAP);

}  // namespace pcl_fft_ground::core
