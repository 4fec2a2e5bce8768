#pragma once

#include <Eigen/Geometry>

#include "align/icp.h"
#include "align/scan_pair.h"

namespace pcl_fft_ground::core {

/** Plane-to-plane ICP of the surfaces that both scans have seen, ground and objects, from within a voxel or
 * two.
 *
 * Takes part what is flat in both scans and faces the same way: what one scan has seen from one side and the
 * other from the other does not pull.
 *
 * \param start correction of the initial guess to begin with
 * \return without information where no surfaces meet
 */
IcpResult alignPlanes(const ScanPair& pair, const Eigen::Isometry3d& start);

}  // namespace pcl_fft_ground::core
