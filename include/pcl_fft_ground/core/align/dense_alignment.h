#pragma once

#include <Eigen/Geometry>

#include "pcl_fft_ground/core/align/segment_alignment.h"
#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/segments/segment.h"

namespace pcl_fft_ground::core {

/// What dense ICP compares.
enum class DensePoints {
  OVERLAP,     ///< surfaces that both scans could see; judged
  EVERYWHERE,  ///< all points: borders pull the scans on to each other; accepted wherever it converges
};

/** Aligns whole scans, ground included.
 *
 * By the surfaces that both could see it is the fallback of alignScans(). By all points it is what the paper
 * warns of at its Fig. 5.
 *
 * \param moving,reference,initial_guess,parameters as in alignScans(); `matches` stay empty
 */
PCL_FFT_GROUND_CORE_EXPORT Alignment alignDensely(const ScanSegments& moving, const ScanSegments& reference,
                                                  const Eigen::Isometry3d& initial_guess,
                                                  const AlignmentParameters& parameters = {},
                                                  DensePoints which = DensePoints::OVERLAP);

}  // namespace pcl_fft_ground::core
