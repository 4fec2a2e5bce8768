#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "errors.h"
#include "io/cloud_fields.h"
#include "io/formats.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr std::size_t KITTI_BYTES = 16;     // x y z intensity
constexpr std::size_t NUSCENES_BYTES = 20;  // x y z intensity ring

float floatAt(std::string_view bytes, std::size_t place) {
  float value = 0;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

/// Whether every fifth value could be the number of a laser in a scanner.
bool hasRings(std::string_view content) {
  constexpr float most_rings = 256;
  for (std::size_t place = KITTI_BYTES; place < content.size(); place += NUSCENES_BYTES) {
    const float ring = floatAt(content, place);
    if (!(ring >= 0 && ring < most_rings && ring == std::floor(ring))) return false;
  }
  return true;
}

CloudFormat formatBySize(std::string_view content) {
  const bool fits_4 = content.size() % KITTI_BYTES == 0, fits_5 = content.size() % NUSCENES_BYTES == 0;
  if (!fits_4 && !fits_5)
    throw WorkError("it is taken for float32 values, but its " + std::to_string(content.size()) +
                    " bytes are neither points of 16 (x y z intensity, as of KITTI) nor of 20 bytes (x y z "
                    "intensity ring, as of nuScenes): --format names another format");
  return fits_5 && (!fits_4 || hasRings(content)) ? CloudFormat::NUSCENES : CloudFormat::KITTI;
}

/// Refuses bytes that are something else than coordinates.
void requireCoordinates(std::string_view content, std::size_t point_bytes) {
  constexpr float largest = 1e7F, smallest = 1e-12F;  // [m]; the range of a laser, and coordinates in a map
  for (std::size_t place = 0; place < content.size(); place += point_bytes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float value = floatAt(content, place + axis * sizeof(float));
      if (std::isnan(value) || value == 0) continue;
      if (std::abs(value) <= largest && std::abs(value) >= smallest) continue;
      std::ostringstream message;
      message << "its bytes are no float32 coordinates: one of point " << place / point_bytes + 1
              << " would be " << value
              << "; --format kitti or nuscenes reads it all the same, others name another format";
      throw WorkError(message.str());
    }
  }
}

}  // namespace

void requireRoom(std::size_t points, std::size_t needed, std::size_t found) {
  if (needed <= found) return;
  throw WorkError("it is truncated: " + std::to_string(points) + " points need at least " +
                  std::to_string(needed) + " bytes after the header, and " + std::to_string(found) +
                  " are there");
}

pcl::PCLPointField recordField(const std::string& name, std::size_t offset, std::uint8_t datatype) {
  pcl::PCLPointField field;
  field.name = name;
  field.offset = static_cast<pcl::uindex_t>(offset);
  field.datatype = datatype;
  field.count = 1;
  return field;
}

pcl::PCLPointCloud2 readRecords(std::string_view bytes, std::size_t record_bytes,
                                const std::vector<pcl::PCLPointField>& fields, std::size_t width,
                                std::size_t height, ByteOrder order) {
  const std::size_t points = width * height;
  requireRoom(points, points * record_bytes, bytes.size());
  pcl::PCLPointCloud2 table;
  for (const auto& field : fields) appendField(table, field.name, field.datatype, field.count);
  allocatePoints(table, width, height);
  if (points == 0) return table;  // there are no bytes to count from
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const std::size_t size = fieldSize(fields[f]), value_size = valueSize(fields[f].datatype);
    const char* source = bytes.data() + fields[f].offset;
    std::uint8_t* target = table.data.data() + table.fields[f].offset;
    for (std::size_t n = 0; n < points; ++n, source += record_bytes, target += table.point_step) {
      std::memcpy(target, source, size);
      if (order == ByteOrder::LITTLE) continue;
      for (std::size_t at = 0; at < size; at += value_size)
        std::reverse(target + at, target + at + value_size);
    }
  }
  return table;
}

RawCloud decodeFloats(std::string_view content, std::optional<CloudFormat> format) {
  const CloudFormat known = format ? *format : formatBySize(content);
  const bool with_ring = known == CloudFormat::NUSCENES;
  const std::size_t point_bytes = with_ring ? NUSCENES_BYTES : KITTI_BYTES;
  if (content.size() % point_bytes != 0)
    throw WorkError("it is truncated: its " + std::to_string(content.size()) + " bytes are no points of " +
                    std::to_string(point_bytes) + " bytes each");
  if (!format) requireCoordinates(content, point_bytes);
  std::vector<pcl::PCLPointField> fields;
  for (const char* name : {"x", "y", "z", "intensity", "ring"})
    if (with_ring || fields.size() < 4)
      fields.push_back(recordField(name, fields.size() * sizeof(float), pcl::PCLPointField::FLOAT32));
  RawCloud cloud;
  cloud.table = readRecords(content, point_bytes, fields, content.size() / point_bytes);
  return cloud;
}

}  // namespace pcl_fft_ground::cli
