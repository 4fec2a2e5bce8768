#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/grid/scan_coverage.h"
#include "pcl_fft_ground/core/ground/labels.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// An object or a heap of objects: the key area that alignment matches. Metres, in the frame of its scan.
struct Segment {
  Points points;                                       ///< mean point of each voxel that the segment occupies
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< of the mean points
  Eigen::Vector3d extents = Eigen::Vector3d::Zero();   ///< size along x, y and z
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< principal axes in columns, the longest first
  Eigen::Vector3d spreads = Eigen::Vector3d::Zero();   ///< standard deviation along each axis
  bool at_border = false;                              ///< part of it may lie outside of what the scan covers
};

/// Which clusters of object points become segments.
struct SegmentParameters {
  std::optional<double> voxel_size;  ///< side of a voxel [m], > 0; voxelSizeFor() the points if not set
  double min_extent = 0.10;          ///< least size along the longest axis [m], >= 0; the paper's is 0.02
  std::size_t min_voxels = 12;       ///< least number of occupied voxels
  std::size_t max_segments = 60;     ///< of more, the largest are kept
};

/// \throws std::invalid_argument naming the parameter, its value and what is allowed, if one is out of range
PCL_FFT_GROUND_CORE_EXPORT void validate(const SegmentParameters& parameters);

/** What alignment needs to know of a scan: its segments, and what to make of the places without any.
 *
 * A scan without points is described by a default value: no segments, nothing covered.
 */
struct ScanSegments {
  double voxel_size = 0.02;             ///< side of a voxel [m]
  std::vector<Segment> segments;        ///< larger ones first
  std::vector<std::ptrdiff_t> sources;  ///< per segment, which of the clusters it was made of
  Points objects;                       ///< mean point of each voxel that object points occupy
  Points surface;         ///< mean point of each voxel that any points occupy: support of normals
  Points relief;          ///< the points, or a sample of them: support of alignRelief()
  ScanCoverage coverage;  ///< where the scan has looked
  /// Where the scan was taken from, if it was told; otherwise its points may show a sensor at the origin.
  std::optional<Eigen::Vector3d> sensor;
  SegmentParameters parameters;  ///< what led here
};

/** Side of the voxels that suit a scan: 2 cm, or 2.5 times the spacing of the points where that is more,
 * rounded up to a multiple of 1 cm. Two scans are to be described with the same voxels: the larger of the two
 * sizes.
 */
PCL_FFT_GROUND_CORE_EXPORT double voxelSizeFor(const PointsView& points);

/** Segments of a scan from labels, by voxel contact (Sec. IV-C). Points far from all others (findFarPoints())
 * are left out.
 *
 * \param points finite points of the scan, its z axis roughly up
 * \param labels one per point
 * \throws std::invalid_argument if the numbers of points and labels differ or a parameter is out of range
 */
PCL_FFT_GROUND_CORE_EXPORT ScanSegments describeScan(const PointsView& points, const Labels& labels,
                                                     const SegmentParameters& parameters = {});

/** The same for clusters that were found by other means.
 * \param clusters column numbers of the points of each cluster; those too small are left out
 */
PCL_FFT_GROUND_CORE_EXPORT ScanSegments describeScan(const PointsView& points,
                                                     const std::vector<std::vector<Eigen::Index>>& clusters,
                                                     const SegmentParameters& parameters = {});

/** The same scan with larger voxels, its segments clustered anew: what a dense scan looks like to a thin one.
 * \param voxel_size side of a voxel [m]; the scan itself comes back if it is no larger than the scan's own
 */
PCL_FFT_GROUND_CORE_EXPORT ScanSegments coarsened(const ScanSegments& scan, double voxel_size);

}  // namespace pcl_fft_ground::core
