#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "errors.h"
#include "io/las_header.h"

namespace pcl_fft_ground::cli {

/// Writes a number over the bytes at a place.
template <typename Number>
void putAt(std::string& bytes, std::size_t place, Number number) {
  std::memcpy(bytes.data() + place, &number, sizeof number);
}

/// A point of lasFile(), in steps of its scale from its offset.
struct LasPoint {
  std::array<std::int32_t, 3> xyz;
  std::uint8_t classification = 0;
  bool withheld = false;
};

inline const std::vector<LasPoint> some_las_points{
    {{0, 0, 0}, 2}, {{100, -200, 50}, 5}, {{200, 100, -25}, 1}, {{300, 300, 75}, 6, true}, {{400, 0, 10}, 2}};

/// The bytes of a LAS file with points of the scale (0.01, 0.01, 0.001) m around (500000, 5400000, 100) m,
/// two bytes of the user's own behind each, and an unknown record in front of them. Every byte that is not
/// set otherwise is 0xA5 in the points.
inline std::string lasFile(unsigned minor = 2, std::uint8_t format = 3,
                           const std::vector<LasPoint>& points = some_las_points) {
  constexpr std::array<std::uint16_t, 11> lengths{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  const std::uint16_t header_bytes = minor >= 4 ? 375 : minor == 3 ? 235 : 227;
  const auto record_bytes = static_cast<std::uint16_t>(lengths[format] + 2);
  const std::size_t begin = header_bytes + 54U + 3U;
  std::string bytes(begin, '\0');
  bytes.replace(0, 4, "LASF");
  bytes[24] = 1;
  bytes[25] = static_cast<char>(minor);
  putAt(bytes, 94, header_bytes);
  putAt(bytes, 96, static_cast<std::uint32_t>(begin));
  putAt(bytes, 100, std::uint32_t{1});
  bytes[104] = static_cast<char>(format);
  putAt(bytes, 105, record_bytes);
  const auto count = static_cast<std::uint32_t>(points.size());
  if (format < 6) putAt(bytes, 107, count);
  if (minor >= 4) putAt(bytes, 247, std::uint64_t{count});
  const std::array<double, 6> scale_and_offset{0.01, 0.01, 0.001, 500000, 5400000, 100};
  std::memcpy(bytes.data() + 131, scale_and_offset.data(), sizeof scale_and_offset);
  for (const LasPoint& point : points) {
    std::string record(record_bytes, '\xA5');
    std::memcpy(record.data(), point.xyz.data(), sizeof point.xyz);
    putAt(record, 12, std::uint16_t{1234});
    if (format < 6) {
      record[14] = '\x12';  // the second return of two
      record[15] = static_cast<char>(point.classification | 0x20U | (point.withheld ? 0x80U : 0U));
    } else {
      record[14] = '\x32';  // the second of three
      record[15] = point.withheld ? '\x05' : '\x01';
      record[16] = static_cast<char>(point.classification);
    }
    bytes += record;
  }
  return bytes;
}

/// Whether LAZ can be read and written.
inline bool isBuiltWithLaszip() {
  try {
    packedLas(lasFile());
    return true;
  } catch (const WorkError&) {
    return false;
  }
}

}  // namespace pcl_fft_ground::cli
