#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// Side of the voxels in which crispness is counted (Sec. V-D1) [m].
constexpr double CRISPNESS_VOXEL = 0.02;

/** Nx: the number of voxels that two scans occupy together (Sec. V-D1); the lower, the crisper.
 *
 * The voxels start at the origin of the reference's frame: their phase alone moves Nx by up to 0.8 %.
 *
 * \param moving,reference points of the scans, each in its own frame
 */
PCL_FFT_GROUND_CORE_EXPORT std::size_t occupiedVoxels(const PointsView& moving, const PointsView& reference,
                                                      const Eigen::Isometry3d& reference_from_moving,
                                                      double voxel_size = CRISPNESS_VOXEL);

/// delta Nx = 100 (after - before) / after [%] (Sec. V-D2); negative if the pair became crisper; 0 for no
/// voxels.
PCL_FFT_GROUND_CORE_EXPORT double crispnessChange(std::size_t before, std::size_t after);

/** Crispness of the overlap only: 2 Nx(A u B) / (Nx(A) + Nx(B)) over the 10 cm squares where both have
 * points.
 *
 * 1 where the scans occupy the same voxels, 2 where they share none. Unlike Nx it does not fall because the
 * overlap grows. Empty without overlap.
 */
PCL_FFT_GROUND_CORE_EXPORT std::optional<double> overlapCrispness(
    const PointsView& moving, const PointsView& reference, const Eigen::Isometry3d& reference_from_moving,
    double voxel_size = CRISPNESS_VOXEL);

}  // namespace pcl_fft_ground::core
