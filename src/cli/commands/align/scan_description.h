#pragma once

#include <string>

#include "io/cloud_file.h"
#include "methods/segmenter.h"
#include "pcl_fft_ground/core/align/scan_coverage.h"
#include "pcl_fft_ground/core/scan/points.h"
#include "pcl_fft_ground/core/segments/segment.h"

namespace pcl_fft_ground::cli {

/// The points of a cloud that are finite and not far from all others (core::findFarPoints()), in order.
/// \throws WorkError naming the file if none is finite
core::Points usablePoints(const std::string& path, const Cloud& cloud);

/// Where the points of a scan lie, in cells chosen from their spacing.
/// \throws WorkError naming the file if they are spread too widely
core::ScanCoverage coverageOf(const std::string& path, const core::Points& points);

/** Splits a scan into ground and objects and describes it by its segments.
 *
 * \throws WorkError naming the file if it has no finite point or the method cannot work on it
 */
core::ScanSegments describeCloud(const std::string& path, const Cloud& cloud, Segmenter& segmenter,
                                 const core::SegmentParameters& parameters);

/// Describes a scan for dense alignment: all of it is ground.
/// \throws WorkError naming the file if the parameters do not suit it
core::ScanSegments describeAsGround(const std::string& path, const core::Points& points,
                                    const core::SegmentParameters& parameters);

}  // namespace pcl_fft_ground::cli
