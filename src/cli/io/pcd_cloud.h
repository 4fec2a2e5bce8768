#pragma once

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <string_view>

#include "io/raw_cloud.h"

namespace pcl_fft_ground::cli {

/// Decodes a PCD file (ascii, binary or binary_compressed). Padding fields ("_") are dropped.
///
/// pcl::PCDReader is not used for this: PCL 1.13's allocates whatever a header claims and crashes where the
/// sizes of compressed points lie.
/// \throws WorkError saying what is wrong, but not naming the file; nothing is allocated for points that
///         the file is too short to hold
RawCloud decodePcd(std::string_view content);

/// Writes a binary PCD file, whole or not at all: all fields without padding, coordinates as they are. A
/// cloud without points makes a file without points.
/// \throws WorkError naming the file
void writePcd(const std::string& path, const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint = {});

}  // namespace pcl_fft_ground::cli
