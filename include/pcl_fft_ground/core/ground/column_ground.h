#pragma once

#include <Eigen/Geometry>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/ground/ground_surface.h"
#include "pcl_fft_ground/core/ground/labels.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/** Tops of the lowest occupied voxels, one per column (Sec. V-B3); empty columns take the nearest one's.
 *
 * The voxels are counted from the lowest corner of the points.
 *
 * \param points points in the level frame
 * \param cell_size,voxel_height horizontal and vertical size of a voxel [m], > 0
 * \throws std::length_error if there would be more than MAX_CELLS columns
 */
PCL_FFT_GROUND_CORE_EXPORT GroundSurface bottomVoxelSurface(const PointsView& points,
                                                            const Eigen::Isometry3d& frame_from_input,
                                                            double cell_size, double voxel_height);

/** A point that is not below the top of its own column, plus a tolerance, is an object.
 * \param points the points that the surface was made from
 * \param tolerance [m]
 */
PCL_FFT_GROUND_CORE_EXPORT Labels labelByColumn(const PointsView& points, const GroundSurface& surface,
                                                double tolerance);

}  // namespace pcl_fft_ground::core
