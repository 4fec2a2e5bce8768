#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_fft_ground::cli {

/// How the values of a PLY file are stored.
enum class PlyStorage { ASCII, BINARY_LITTLE, BINARY_BIG };

/// One property of an element: a value, or a list of values with its length in front.
struct PlyProperty {
  std::string name;
  std::uint8_t datatype = 0;  ///< of the value or of the list's items, a pcl::PCLPointField type
  std::optional<std::uint8_t>
      length_type;  ///< of a list's length, an integer type; nothing for a single value
};

/// One kind of thing that the file holds, such as its vertices or its faces.
struct PlyElement {
  std::string name;
  std::size_t count = 0;  ///< at most max_point_count
  std::vector<PlyProperty> properties;
};

/// The header of a PLY file.
struct PlyHeader {
  PlyStorage storage = PlyStorage::ASCII;
  std::vector<PlyElement> elements;  ///< in file order
  std::size_t body = 0;              ///< where the values begin in the file
};

/// Whether a file's content begins as a PLY file does.
bool looksLikePly(std::string_view content);

/// Reads the header of a PLY file (format version 1.0).
/// \throws WorkError naming the line and its value, but not the file
PlyHeader parsePlyHeader(std::string_view content);

}  // namespace pcl_fft_ground::cli
