#pragma once

#include <pcl/PCLPointCloud2.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "io/cloud_fields.h"
#include "io/pcd_cloud.h"
#include "io/viewpoint.h"

namespace pcl_fft_ground::cli {

/// Coordinates beyond this are given relative to an origin: the floats around it are 1 mm apart [m].
constexpr double LARGE_COORDINATE = 1e4;

/// A cloud from a file, its coordinates relative to a whole-metre origin.
///
/// A point of the file is points[i] + origin.
struct Cloud {
  /// Every point in input order with all its fields (padding dropped); x, y, z as FLOAT32 [m], relative to
  /// `origin`. An organised cloud keeps its width and height.
  pcl::PCLPointCloud2 fields;
  /// The same x, y, z and the same width and height; is_dense says whether all of them are finite.
  pcl::PointCloud<pcl::PointXYZ>::Ptr points;
  /// Subtracted from the input [m]; 0 on an axis whose coordinates are not large.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Viewpoint viewpoint;  ///< maps points[i] to the world: the file's VIEWPOINT after the shift by the origin
  /// The input's `label` field, whatever its type; 2 (neither ground nor object) where it is no number.
  /// Empty if the input has none.
  std::vector<int> labels;
};

/// Reads a cloud of at least one point from a PCD file (ascii, binary, binary_compressed), a PLY file (its
/// vertices) or text (see decodeText). The content decides which, then the name's ending.
///
/// Coordinates are read in double. Where the median of an axis lies beyond 10,000 m, where a float has lost
/// the millimetre, it is rounded to whole metres and subtracted before they become floats; a median, so
/// that a few far outliers do not move it.
/// \throws WorkError of one line naming the file: for one that is missing, no regular file, unreadable,
///         empty, truncated or damaged, without coordinates x, y, z of one number each, or without points.
///         Clouds of nothing but NaN are returned as they are.
Cloud readCloud(const std::string& path);

}  // namespace pcl_fft_ground::cli
