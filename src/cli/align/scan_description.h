#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "io/cloud_file.h"
#include "methods/segmenter.h"
#include "pcl_fft_ground/core/points.h"
#include "pcl_fft_ground/core/segment.h"

namespace pcl_fft_ground::cli {

/// The pose that a file gives: it maps `cloud.points`, which are relative to an origin, to the world.
Eigen::Isometry3d worldFromPoints(const Cloud& cloud);

/// The finite points of a cloud, in order. \throws WorkError naming the file if there are none
core::Points finitePoints(const std::string& path, const Cloud& cloud);

/** Splits a scan into ground and objects and describes it by its segments.
 * \throws WorkError naming the file if it has no finite point or the method cannot work on it */
core::ScanSegments describeCloud(const std::string& path, const Cloud& cloud, Segmenter& segmenter,
                                 const core::SegmentParameters& parameters);

}  // namespace pcl_fft_ground::cli
