#pragma once

#include <memory>

#include "pcl_fft_ground/core/align/nearest_neighbours.h"
#include "pcl_fft_ground/registration_export.h"

namespace pcl_fft_ground {

/** Search by `pcl::KdTreeFLANN`: for points that are no surface seen from above.
 * To be given to SegmentICP::setNeighbourSearch().
 *
 * \param spacing is not used
 */
PCL_FFT_GROUND_REGISTRATION_EXPORT std::unique_ptr<core::NearestNeighbours> kdTreeNeighbours(
    const core::PointsView& points, double spacing);

}  // namespace pcl_fft_ground
