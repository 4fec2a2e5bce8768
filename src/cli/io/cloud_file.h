#pragma once

#include <pcl/PCLPointCloud2.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "io/cloud_fields.h"
#include "io/formats.h"

namespace pcl_fft_ground::cli {

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
  std::string pose_fault;  ///< why the file's VIEWPOINT is no pose; empty if it is one, or missing
  /// What each point is, by the input's labels: 0 ground, 1 object, 2 neither (also where a label is no
  /// number). Empty if the input has no labels, or some whose meaning is not known.
  std::vector<int> labels;
  std::string label_fault;                ///< why there are no labels although the input has some; else empty
  std::vector<std::string> remarks;       ///< what a user should know of how the file was read, a line each
  std::string crs;                        ///< of the file's x and y, as WKT or "EPSG:n"; empty if not known
  CloudFormat format = CloudFormat::PCD;  ///< of the file
  bool is_compressed = false;             ///< whether the file is LAZ
};

/// How to read a cloud.
struct ReadOptions {
  std::optional<CloudFormat> format;  ///< nothing: by content, then by the name's ending
  /// Labels that mean ground, and such that mean neither; all others are objects. Where one of the two is
  /// given, the other one is by default that of the file's own scheme (see LabelScheme; nothing is ignored by
  /// ours). Where none is given and the labels are not those of the scheme, they are not known.
  std::optional<std::vector<int>> ground_classes, ignored_classes;
};

/// Reads a cloud of at least one point from a file of one of the formats (see formats.h).
///
/// Coordinates x, y, z (or X, Y, Z) are read in double. Where the median of an axis lies beyond 10,000 m,
/// where a float has lost the millimetre, it is rounded to whole metres and subtracted before they become
/// floats; a median, so that a few far outliers do not move it. The points that a LAS file withholds are NaN
/// in Cloud::points, but not in Cloud::fields. \throws WorkError of one line naming the file: for one that is
/// missing, no regular file, unreadable,
///         empty, truncated or damaged, of a format that is not read, without coordinates x, y, z of one
///         number each, or without points. Clouds of nothing but NaN are returned as they are.
Cloud readCloud(const std::string& path, const ReadOptions& options = {});

/// Writes a binary PCD file, whole or not at all: all fields without padding, coordinates as they are. A
/// cloud without points makes a file without points.
/// \throws WorkError naming the file
void writePcd(const std::string& path, const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint = {});

/// The header of a binary PCD file of the cloud's fields, width and height; its points follow, packed.
///
/// Unlike pcl::PCDWriter's header, this one keeps all digits of the viewpoint and allows for a cloud without
/// points.
std::string pcdHeader(const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint);

/// Writes the LAS file `input` with other classes as `path`, whole or not at all; see reclassifiedLas().
/// \throws WorkError naming the file
void writeReclassified(const std::string& path, const std::string& input, const std::vector<int>& classes);

/// Whether a file's name ends as that of a cloud which a folder may hold among other files: .pcd, .ply,
/// .las or .laz, in any case.
bool hasCloudName(const std::string& path);

}  // namespace pcl_fft_ground::cli
