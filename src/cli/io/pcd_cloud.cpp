#include "io/pcd_cloud.h"

#include <pcl/io/lzf.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <numeric>
#include <vector>

#include "errors.h"
#include "io/cloud_fields.h"
#include "io/output_file.h"
#include "io/pcd_header.h"
#include "io/scanner.h"

namespace pcl_fft_ground::cli {
namespace {

bool isPadding(const pcl::PCLPointField& field) {
  return field.name == "_";
}

/// The layout of the cloud to be read, still without points.
RawCloud emptyCloud(const PcdHeader& header) {
  RawCloud cloud;
  for (const auto& field : header.fields) {
    if (!isPadding(field)) appendField(cloud.table, field.name, field.datatype, field.count);
  }
  cloud.viewpoint = header.viewpoint;
  return cloud;
}

[[noreturn]] void failTruncated(std::size_t points, std::size_t needed, std::size_t found) {
  throw WorkError("it is truncated: " + std::to_string(points) + " points need at least " +
                  std::to_string(needed) + " bytes after the header, and " + std::to_string(found) +
                  " are there");
}

/// Stores the words of one line as the values of one point.
/// \return whether the line fits the fields
bool decodeLine(std::string_view line, const std::vector<pcl::PCLPointField>& fields, std::uint8_t* bytes) {
  for (const auto& field : fields) {
    const std::size_t size = valueSize(field.datatype);
    for (std::size_t i = 0; i < field.count; ++i) {
      const std::string_view word = takeWord(line);
      if (word.empty()) return false;
      if (isPadding(field)) continue;
      if (!storeNumber(word, field.datatype, bytes)) return false;
      bytes += size;
    }
  }
  return takeWord(line).empty();
}

void decodeAscii(std::string_view body, const PcdHeader& header, pcl::PCLPointCloud2& table) {
  const std::size_t points = header.width * header.height;
  const std::size_t values =
      std::accumulate(header.fields.begin(), header.fields.end(), std::size_t{0},
                      [](std::size_t sum, const auto& field) { return sum + field.count; });
  const std::size_t needed = points * values * 2;  // a digit and a separator each, but after the last one
  if (needed > body.size() + 1) failTruncated(points, needed - 1, body.size());
  allocatePoints(table, header.width, header.height);
  for (std::size_t i = 0; i < points; ++i) {
    skipBlanks(body);
    if (body.empty()) {
      throw WorkError("it is truncated: it holds " + std::to_string(i) + " of " + std::to_string(points) +
                      " points");
    }
    const std::string_view line = takeLine(body);
    if (!decodeLine(line, header.fields, table.data.data() + i * table.point_step)) {
      throw WorkError("point " + std::to_string(i + 1) + " is malformed: " + quoted(line) + " is not " +
                      std::to_string(values) + " numbers of the header's types");
    }
  }
}

void decodeBinary(std::string_view body, const PcdHeader& header, pcl::PCLPointCloud2& table) {
  const std::size_t points = header.width * header.height;
  const std::size_t needed = points * header.point_bytes;
  if (needed > body.size()) failTruncated(points, needed, body.size());
  allocatePoints(table, header.width, header.height);
  if (table.point_step == header.point_bytes) {
    std::copy_n(body.data(), needed, table.data.begin());
    return;
  }
  std::uint8_t* bytes = table.data.data();
  for (std::size_t i = 0; i < points; ++i) {
    for (const auto& field : header.fields) {
      if (isPadding(field)) continue;
      std::memcpy(bytes, body.data() + i * header.point_bytes + field.offset, fieldSize(field));
      bytes += fieldSize(field);
    }
  }
}

/// The uncompressed bytes of a compressed body, checked to be as many as wanted.
std::vector<char> decompress(std::string_view body, std::size_t wanted) {
  std::array<std::uint32_t, 2> sizes{};  // compressed, uncompressed
  if (body.size() < sizeof sizes)
    throw WorkError("it is truncated: the sizes of the compressed points are missing");
  std::memcpy(sizes.data(), body.data(), sizeof sizes);
  body.remove_prefix(sizeof sizes);
  if (sizes[0] > body.size()) {
    throw WorkError("it is truncated: of " + std::to_string(sizes[0]) + " compressed bytes it holds " +
                    std::to_string(body.size()));
  }
  if (sizes[1] != wanted) {
    throw WorkError("its compressed part claims " + std::to_string(sizes[1]) + " bytes, the header " +
                    std::to_string(wanted));
  }
  constexpr std::size_t best_ratio = 88;  // LZF: at most 264 bytes from 3
  if (wanted > best_ratio * sizes[0])
    throw WorkError("its compressed points are too short for what the header claims");
  std::vector<char> plain(wanted);
  if (wanted != 0 && pcl::lzfDecompress(body.data(), sizes[0], plain.data(), sizes[1]) != sizes[1]) {
    throw WorkError("its compressed points are damaged");
  }
  return plain;
}

/// Compressed points are stored field by field, without padding.
void decodeCompressed(std::string_view body, const PcdHeader& header, pcl::PCLPointCloud2& table) {
  const std::size_t points = header.width * header.height;
  const std::vector<char> plain = decompress(body, points * table.point_step);
  allocatePoints(table, header.width, header.height);
  const char* source = plain.data();
  for (const auto& field : table.fields) {
    const std::size_t size = fieldSize(field);
    for (std::size_t i = 0; i < points; ++i, source += size) {
      std::memcpy(table.data.data() + i * table.point_step + field.offset, source, size);
    }
  }
}

/// The shortest spelling that reads back as the same number.
std::string spell(double number) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

char typeLetter(std::uint8_t datatype) {
  switch (datatype) {
    case pcl::PCLPointField::FLOAT32:
    case pcl::PCLPointField::FLOAT64:
      return 'F';
    case pcl::PCLPointField::INT8:
    case pcl::PCLPointField::INT16:
    case pcl::PCLPointField::INT32:
    case INT64_FIELD:
      return 'I';
    default:
      return 'U';
  }
}

/// Unlike pcl::PCDWriter's header, this one keeps all digits of the viewpoint and allows for a cloud
/// without points.
std::string headerText(const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint) {
  std::string names, sizes, types, counts;
  for (const auto& field : cloud.fields) {
    names += " " + field.name;
    sizes += " " + std::to_string(valueSize(field.datatype));
    types += std::string(" ") + typeLetter(field.datatype);
    counts += " " + std::to_string(field.count);
  }
  const Eigen::Vector3d& t = viewpoint.position;
  const Eigen::Quaterniond& q = viewpoint.rotation;
  std::string pose;
  for (const double number : {t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()}) pose += " " + spell(number);
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS" + names + "\nSIZE" + sizes +
         "\nTYPE" + types + "\nCOUNT" + counts + "\nWIDTH " + std::to_string(cloud.width) + "\nHEIGHT " +
         std::to_string(cloud.height) + "\nVIEWPOINT" + pose + "\nPOINTS " +
         std::to_string(pointCount(cloud)) + "\nDATA binary\n";
}

}  // namespace

RawCloud decodePcd(std::string_view content) {
  const PcdHeader header = parsePcdHeader(content);
  const std::string_view body = content.substr(header.body);
  RawCloud cloud = emptyCloud(header);
  switch (header.storage) {
    case PcdStorage::ASCII:
      decodeAscii(body, header, cloud.table);
      break;
    case PcdStorage::BINARY:
      decodeBinary(body, header, cloud.table);
      break;
    case PcdStorage::COMPRESSED:
      decodeCompressed(body, header, cloud.table);
      break;
  }
  return cloud;
}

void writePcd(const std::string& path, const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint) {
  pcl::Indices all(pointCount(cloud));
  std::iota(all.begin(), all.end(), 0);
  pcl::PCLPointCloud2 packed = selectPoints(cloud, all);
  packed.width = cloud.width;
  packed.height = cloud.height;
  std::string content = headerText(packed, viewpoint);
  content.append(reinterpret_cast<const char*>(packed.data.data()), packed.data.size());
  writeText(path, content);
}

}  // namespace pcl_fft_ground::cli
