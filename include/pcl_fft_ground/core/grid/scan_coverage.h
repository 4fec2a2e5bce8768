#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/grid/elevation_grid.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/** Where a scan has looked, seen from above: whether a place that holds no point is empty or was not seen.
 *
 * The cells that hold a point, closed by one cell, small holes filled. A value of no cells covers nothing.
 */
struct ScanCoverage {
  GridGeometry geometry;  ///< the cells, with a margin of uncovered ones all around
  Eigen::ArrayXXf depth;  ///< distance from the cell's centre to the border of what is covered [m], 0 outside

  /// Distance [m] from a place to the border of what is covered; 0 outside. To within a cell.
  PCL_FFT_GROUND_CORE_EXPORT double depthAt(double x, double y) const;

  /// True if a place lies more than `margin` [m] inside of what is covered.
  bool covers(const Eigen::Vector3d& place, double margin) const {
    return depthAt(place.x(), place.y()) > margin;
  }

  /// Area that is covered [m^2].
  PCL_FFT_GROUND_CORE_EXPORT double area() const;
};

/** What a scan covers.
 * \param points points of the scan, its z axis roughly up
 * \param cell_size side of a cell [m], > 0: some 2.5 times the spacing of the points
 * \throws std::length_error if the grid would have more than MAX_CELLS cells
 */
PCL_FFT_GROUND_CORE_EXPORT ScanCoverage coverageOf(const PointsView& points, double cell_size);

/// The cells of coverageOf() for points within bounds.
PCL_FFT_GROUND_CORE_EXPORT GridGeometry coverageCells(const Bounds& bounds, double cell_size);

/// The same from the cells that hold a point. \param cells coverageCells() of all points
PCL_FFT_GROUND_CORE_EXPORT ScanCoverage coverageOf(const GridGeometry& cells, const Mask& occupied);

/// Share of the smaller of two scans' covered areas that the other covers, too, seen from above: 0 to 1; 0 if
/// either covers nothing. \param reference_from_moving where the moving scan lies
PCL_FFT_GROUND_CORE_EXPORT double overlapShare(const ScanCoverage& reference, const ScanCoverage& moving,
                                               const Eigen::Isometry3d& reference_from_moving);

}  // namespace pcl_fft_ground::core
