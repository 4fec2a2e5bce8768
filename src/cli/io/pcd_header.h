#pragma once

#include <pcl/PCLPointField.h>

#include <cstddef>
#include <string_view>
#include <vector>

#include "io/viewpoint.h"

namespace pcl_fft_ground::cli {

/// How the points of a PCD file are stored.
enum class PcdStorage { ASCII, BINARY, COMPRESSED };

/// The header of a PCD file; every number in it is in range.
struct PcdHeader {
  std::vector<pcl::PCLPointField>
      fields;                   ///< in file order, padding ("_") included, with offsets in the file's point
  std::size_t point_bytes = 0;  ///< size of a point in the file, at most max_point_bytes
  std::size_t width = 0;        ///< width * height is at most max_point_count
  std::size_t height = 1;
  Viewpoint viewpoint;  ///< not turned if the file gives no rotation
  PcdStorage storage = PcdStorage::ASCII;
  std::size_t body = 0;  ///< where the points begin in the file
};

/// Whether a file's content begins as a PCD file does.
bool looksLikePcd(std::string_view content);

/// Reads the header of a PCD file, versions 0.5 to 0.7. The lines may come in any order, DATA last. Where
/// they are missing, SIZE is 4, TYPE F, COUNT 1, HEIGHT 1, and WIDTH and POINTS follow from one another.
/// \throws WorkError naming the line and its value, but not the file
PcdHeader parsePcdHeader(std::string_view content);

}  // namespace pcl_fft_ground::cli
