#pragma once

#include <pcl/PointIndices.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/cloud_file.h"
#include "methods/segmenter.h"
#include "pcl_fft_ground/core/grid/elevation_grid.h"
#include "pcl_fft_ground/core/ground/ground_surface.h"
#include "pcl_fft_ground/core/scan/prepare.h"
#include "pcl_fft_ground/simulation/evaluation.h"

namespace pcl_fft_ground::cli {

/// What becomes a segment.
enum class Clusters {
  OBJECTS,  ///< things that touch are told apart
  CONTACT   ///< all that touches, as in the paper
};

/// Settings of the clustering of objects into segments.
struct ClusterParameters {
  Clusters clusters = Clusters::OBJECTS;
  double leaf_size = 0.02;                                      ///< side of a voxel [m], > 0
  double minimum_object_size = 0.09;                            ///< of OBJECTS [m], > 0
  std::size_t min_cluster_size = 10;                            ///< points
  std::size_t max_cluster_size = static_cast<std::size_t>(-1);  ///< points
};

/// What became of a scan.
struct Segmentation {
  pcl::PointIndices ground;                 ///< indices of the ground points
  pcl::PointIndices objects;                ///< indices of the object points
  std::vector<pcl::PointIndices> clusters;  ///< the segments, by falling size
  core::Labels labels;                      ///< per input point
  std::vector<std::int32_t> segments;       ///< per input point: number of its segment, from 1; 0 none
  std::vector<double> heights;              ///< per input point: above the ground [m]; empty if not asked for
  std::vector<float> ground_probability;    ///< per input point; empty if not asked for, or not known
  core::ElevationGrid elevation;            ///< highest points, in the level frame
  core::GroundSurface surface;              ///< ground, in the level frame
  std::optional<core::Confusion> confusion;  ///< against the input's labels, if it has some
};

/// \throws WorkError naming the file if none of the points is finite
void requireFinitePoint(const std::string& path, const pcl::PointCloud<Point>& points);

/// The points of a cloud that can be worked with.
core::UsablePoints usablePoints(const pcl::PointCloud<Point>& cloud);

/// Gives a cloud to a segmenter, and the place of the sensor in the coordinates of its points.
void setInput(const Cloud& cloud, Segmenter& segmenter);

/// A label per point of a cloud of `count` points: NEITHER where it is in neither list.
core::Labels labelsOf(std::size_t count, const pcl::PointIndices& ground, const pcl::PointIndices& objects);

/** Splits a cloud into ground and objects.
 * \throws WorkError naming the file if it holds no finite point or the method cannot work on it
 */
Segmentation segmentCloud(const std::string& path, const Cloud& cloud, Segmenter& segmenter);

/// Clusters the objects into segments and numbers them.
void clusterObjects(const Cloud& cloud, const ClusterParameters& parameters, Segmentation& segmentation);

}  // namespace pcl_fft_ground::cli
