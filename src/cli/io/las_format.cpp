#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "errors.h"
#include "io/cloud_fields.h"
#include "io/formats.h"
#include "io/las_header.h"

// Offsets and names are those of the ASPRS LAS specification 1.4 R15.
namespace pcl_fft_ground::cli {
namespace {

using Field = pcl::PCLPointField;

constexpr std::size_t shortest_header = 227;  // of the versions 1.0 to 1.2
constexpr std::size_t header_1_4 = 375;
constexpr std::array<std::size_t, 11> record_bytes_of_format{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

std::uint64_t countInHeader(std::string_view content, unsigned minor) {
  const auto legacy = numberAt<std::uint32_t>(content, 107);
  const bool has_long_count =
      minor >= 4 && numberAt<std::uint16_t>(content, 94) >= header_1_4 && content.size() >= header_1_4;
  if (!has_long_count) return legacy;
  const auto count = numberAt<std::uint64_t>(content, 247);
  return count != 0 ? count : legacy;
}

void readTransform(std::string_view content, LasHeader& header) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    header.scale[axis] = numberAt<double>(content, 131 + 8 * static_cast<std::size_t>(axis));
    header.offset[axis] = numberAt<double>(content, 155 + 8 * static_cast<std::size_t>(axis));
    if (!std::isfinite(header.scale[axis]) || header.scale[axis] == 0 || !std::isfinite(header.offset[axis]))
      throw WorkError("the LAS header's scale " + std::to_string(header.scale[axis]) + " or offset " +
                      std::to_string(header.offset[axis]) + " of " + "xyz"[axis] +
                      " is not a finite number, or a scale of 0");
  }
}

void readRecordFormat(std::string_view content, LasHeader& header) {
  constexpr unsigned compression_bits = 0xC0;
  const auto stored = static_cast<std::uint8_t>(content[104]);
  header.is_compressed = (stored & compression_bits) != 0;
  const auto format = static_cast<std::uint8_t>(stored & ~compression_bits);
  if (format >= record_bytes_of_format.size())
    throw WorkError("the LAS header's point format " + std::to_string(format) + " is not from 0 to 10");
  header.format = format;
  header.record_bytes = numberAt<std::uint16_t>(content, 105);
  if (header.record_bytes < record_bytes_of_format[format])
    throw WorkError("the LAS header's points of " + std::to_string(header.record_bytes) +
                    " bytes are too short for point format " + std::to_string(format) + ", which has " +
                    std::to_string(record_bytes_of_format[format]));
}

/// Waveforms or extended variable length records, which may follow the points.
bool hasMoreBehindPoints(std::string_view content, unsigned minor) {
  const bool waveforms = minor >= 3 && content.size() >= 235 && numberAt<std::uint64_t>(content, 227) != 0;
  return waveforms || (minor >= 4 && content.size() >= 247 && numberAt<std::uint32_t>(content, 243) != 0);
}

/// \param file_size bytes of the file, of which `content` may be the first ones only
void readExtent(std::string_view content, std::uint64_t file_size, unsigned minor, LasHeader& header) {
  header.points_begin = numberAt<std::uint32_t>(content, 96);
  if (header.points_begin < shortest_header)
    throw WorkError("the LAS header's offset to its points, " + std::to_string(header.points_begin) +
                    ", lies within the header");
  const std::uint64_t count = countInHeader(content, minor);
  if (header.points_begin > file_size && count != 0)
    throw WorkError("it is truncated: its points begin at byte " + std::to_string(header.points_begin) +
                    " of " + std::to_string(file_size));
  const std::size_t room = file_size - std::min<std::uint64_t>(file_size, header.points_begin);
  const std::size_t most = room / header.record_bytes;
  if (!header.is_compressed && count > most)
    throw WorkError("it is truncated: its header counts " + std::to_string(count) + " points of " +
                    std::to_string(header.record_bytes) + " bytes, and " + std::to_string(room) +
                    " bytes are there");
  if (count > static_cast<std::uint64_t>(max_point_count)) throw WorkError("it holds too many points");
  header.points = static_cast<std::size_t>(count);
  if (header.is_compressed) return;
  if (most > header.points && !hasMoreBehindPoints(content, minor))
    header.remark = "its header counts " + std::to_string(count) + " points, but the file has room for " +
                    std::to_string(most) + ": those beyond the count are not read";
  if (count == 0 && most > 0 && !header.remark.empty())
    throw WorkError("it holds no points: its header counts 0, though " + std::to_string(room) +
                    " bytes follow");
}

}  // namespace

LasHeader parseLasHeader(std::string_view content, std::uint64_t file_size) {
  if (!looksLikeLas(content)) throw WorkError("it is no LAS file: it does not begin with 'LASF'");
  const std::size_t header_bytes =
      content.size() < shortest_header ? shortest_header : numberAt<std::uint16_t>(content, 94);
  if (content.size() < header_bytes)
    throw WorkError("it is truncated: its LAS header has " + std::to_string(header_bytes) +
                    " bytes, and it has " + std::to_string(content.size()));
  const unsigned major = static_cast<std::uint8_t>(content[24]),
                 minor = static_cast<std::uint8_t>(content[25]);
  if (major != 1 || minor > 4)
    throw WorkError("its LAS version " + std::to_string(major) + "." + std::to_string(minor) +
                    " is not from 1.0 to 1.4");
  LasHeader header;
  header.header_bytes = header_bytes;
  header.minor = minor;
  readRecordFormat(content, header);
  readTransform(content, header);
  readExtent(content, file_size, minor, header);
  return header;
}

std::vector<VariableRecord> variableRecords(std::string_view content, std::size_t begin, std::uint64_t count,
                                            RecordKind kind) {
  const bool is_extended = kind == RecordKind::EXTENDED;
  const std::size_t header_bytes = is_extended ? 60 : 54;
  std::vector<VariableRecord> records;
  std::string_view rest = content.substr(std::min(begin, content.size()));
  while (records.size() < count && rest.size() >= header_bytes) {
    const std::uint64_t length =
        is_extended ? numberAt<std::uint64_t>(rest, 20) : numberAt<std::uint16_t>(rest, 20);
    if (length > rest.size() - header_bytes) break;
    const std::string_view whole = rest.substr(0, header_bytes + static_cast<std::size_t>(length));
    const std::string_view user = whole.substr(2, 16);
    records.push_back({user.substr(0, user.find('\0')), numberAt<std::uint16_t>(whole, 18),
                       whole.substr(header_bytes), whole});
    rest.remove_prefix(whole.size());
  }
  return records;
}

namespace {

/// The fields that stand in a record as they are.
std::vector<Field> plainFields(const LasHeader& header) {
  const bool is_new = header.isNewFormat();
  std::vector<Field> fields{recordField("intensity", 12, Field::UINT16),
                            recordField("user_data", 17, Field::UINT8),
                            recordField("point_source_id", is_new ? 20 : 18, Field::UINT16)};
  const unsigned format = header.format;
  const bool has_time = format == 1 || (format >= 3);
  if (has_time) fields.push_back(recordField("gps_time", is_new ? 22 : 20, Field::FLOAT64));
  std::size_t colours = 0;
  if (format == 2) colours = 20;
  if (format == 3 || format == 5) colours = 28;
  if (format == 7 || format == 8 || format == 10) colours = 30;
  if (colours != 0) {
    fields.push_back(recordField("red", colours, Field::UINT16));
    fields.push_back(recordField("green", colours + 2, Field::UINT16));
    fields.push_back(recordField("blue", colours + 4, Field::UINT16));
  }
  if (format == 8 || format == 10) fields.push_back(recordField("nir", 36, Field::UINT16));
  return fields;
}

/// Appends the bytes of a value, as a field after the others.
template <typename Value>
void put(std::uint8_t*& bytes, Value value) {
  std::memcpy(bytes, &value, sizeof value);
  bytes += sizeof value;
}

/// The fields that are computed: coordinates, and what shares its bytes with others.
pcl::PCLPointCloud2 computedFields(std::string_view body, const LasHeader& header, std::size_t points) {
  pcl::PCLPointCloud2 table;
  for (const char* name : {"x", "y", "z"}) appendField(table, name, Field::FLOAT64, 1);
  for (const char* name : {"classification", "return_number", "number_of_returns"})
    appendField(table, name, Field::UINT8, 1);
  appendField(table, "scan_angle", Field::FLOAT32, 1);
  allocatePoints(table, points, 1);
  std::uint8_t* bytes = table.data.data();
  for (std::size_t n = 0; n < points; ++n) {
    const std::string_view record = body.substr(n * header.record_bytes, header.record_bytes);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      put(bytes, header.scale[i] * numberAt<std::int32_t>(record, 4 * axis) + header.offset[i]);
    }
    const auto returns = static_cast<std::uint8_t>(record[14]);
    const auto classes = static_cast<std::uint8_t>(record[header.classPlace()]);
    constexpr float degrees_of_unit = 0.006F;
    if (header.isNewFormat()) {
      put(bytes, classes);
      put(bytes, static_cast<std::uint8_t>(returns & 0x0FU));
      put(bytes, static_cast<std::uint8_t>(returns >> 4U));
      put(bytes, degrees_of_unit * static_cast<float>(numberAt<std::int16_t>(record, 18)));
    } else {
      put(bytes, static_cast<std::uint8_t>(classes & 0x1FU));
      put(bytes, static_cast<std::uint8_t>(returns & 0x07U));
      put(bytes, static_cast<std::uint8_t>((returns >> 3U) & 0x07U));
      put(bytes, static_cast<float>(numberAt<std::int8_t>(record, 16)));
    }
  }
  return table;
}

/// Two tables of the same points as one, the fields of `left` first.
pcl::PCLPointCloud2 joined(const pcl::PCLPointCloud2& left, const pcl::PCLPointCloud2& right) {
  pcl::PCLPointCloud2 table;
  for (const auto* part : {&left, &right})
    for (const Field& field : part->fields) appendField(table, field.name, field.datatype, field.count);
  allocatePoints(table, left.width, left.height);
  std::uint8_t* bytes = table.data.data();
  for (std::size_t n = 0; n < pointCount(left); ++n)
    for (const auto* part : {&left, &right}) {
      std::memcpy(bytes, part->data.data() + n * part->point_step, part->point_step);
      bytes += part->point_step;
    }
  return table;
}

/// The coordinate reference system that the records in front of the points name: WKT, or else the EPSG code
/// among the GeoTIFF keys. Records that lie end the search.
std::string crsOf(std::string_view content, const LasHeader& header) {
  constexpr std::uint16_t wkt = 2112, geotiff_keys = 34735, geographic_key = 2048, projected_key = 3072;
  constexpr std::uint16_t first_code = 1024, user_defined = 32767;
  std::string by_key;
  for (const VariableRecord& record :
       variableRecords(content.substr(0, header.points_begin), header.header_bytes,
                       numberAt<std::uint32_t>(content, 100), RecordKind::PLAIN)) {
    if (record.user != "LASF_Projection") continue;
    if (record.id == wkt) return std::string(record.data.substr(0, record.data.find('\0')));
    for (std::size_t key = 8; record.id == geotiff_keys && key + 8 <= record.data.size(); key += 8) {
      const auto id = numberAt<std::uint16_t>(record.data, key),
                 place = numberAt<std::uint16_t>(record.data, key + 2),
                 code = numberAt<std::uint16_t>(record.data, key + 6);
      const bool is_code = place == 0 && code >= first_code && code < user_defined;
      if (is_code && (id == projected_key || (id == geographic_key && by_key.empty())))
        by_key = "EPSG:" + std::to_string(code);
    }
  }
  return by_key;
}

/// Whether x and y are degrees: WKT of a geographic system that is not projected, or a code of the block that
/// the GeoTIFF specification gives to such systems, 4000 to 4999.
bool isGeographic(std::string_view crs) {
  const auto names = [&](std::string_view word) { return crs.find(word) != std::string_view::npos; };
  if (crs.substr(0, 6) == "EPSG:4") return crs.size() == std::string_view("EPSG:4999").size();
  return (names("GEOGCS") || names("GEOGCRS")) && !names("PROJCS") && !names("PROJCRS");
}

RawCloud decodePoints(std::string_view body, const LasHeader& header, std::size_t points,
                      const std::string& crs) {
  RawCloud cloud;
  cloud.label_scheme = LabelScheme::ASPRS;
  cloud.crs = crs;
  if (!header.remark.empty()) cloud.remarks.push_back(header.remark);
  if (isGeographic(crs))
    cloud.remarks.push_back(
        "its coordinate reference system is geographic: x and y are degrees, and no lengths can be right; "
        "project the points first, as with filters.reprojection of PDAL");
  cloud.table = joined(computedFields(body, header, points),
                       readRecords(body, header.record_bytes, plainFields(header), points));
  cloud.withheld.resize(points);
  for (std::size_t n = 0; n < points; ++n)
    cloud.withheld[n] = header.isWithheld(body.substr(n * header.record_bytes, header.record_bytes));
  return cloud;
}

void reclassify(const LasHeader& header, char* record, int number) {
  const int most = header.isNewFormat() ? 255 : 31;
  if (number > most)
    throw WorkError("class " + std::to_string(number) + " is above " + std::to_string(most) +
                    ", the highest of point format " + std::to_string(header.format));
  char& stored = record[header.classPlace()];
  const unsigned flags = header.isNewFormat() ? 0U : static_cast<std::uint8_t>(stored) & 0xE0U;
  stored = static_cast<char>(flags | static_cast<unsigned>(number));
}

}  // namespace

bool looksLikeLas(std::string_view content) {
  return content.substr(0, 4) == "LASF";
}

RawCloud decodeLas(std::string_view content) {
  const LasHeader header = parseLasHeader(content, content.size());
  if (header.is_compressed) {
    RawCloud cloud = decodeLas(unpackedLas(content));
    cloud.is_compressed = true;
    return cloud;
  }
  const std::string_view body = content.substr(std::min(content.size(), header.points_begin));
  return decodePoints(body, header, header.points, crsOf(content, header));
}

std::optional<RecordFile> lasRecords(std::string_view head, std::uint64_t file_size) {
  const LasHeader header = parseLasHeader(head, file_size);
  if (header.is_compressed)
    throw WorkError("it is compressed (LAZ), and cannot be read in parts, as --tile asks for: " +
                    std::string(UNPACK_LAZ));
  const std::string crs = crsOf(head, header);
  return RecordFile{header.points_begin,
                    header.record_bytes,
                    header.points,
                    1,
                    [header, crs](std::string_view records) {
                      return decodePoints(records, header, records.size() / header.record_bytes, crs);
                    },
                    [header](char* record, int number) { reclassify(header, record, number); }};
}

std::string reclassifiedLas(std::string content, const std::vector<int>& classes) {
  const LasHeader header = parseLasHeader(content, content.size());
  if (classes.size() != header.points)
    throw WorkError("it has changed: it had " + std::to_string(classes.size()) + " points and has " +
                    std::to_string(header.points));
  if (header.is_compressed) return packedLas(reclassifiedLas(unpackedLas(content), classes));
  for (std::size_t n = 0; n < classes.size(); ++n)
    if (classes[n] >= 0)
      reclassify(header, content.data() + header.points_begin + n * header.record_bytes, classes[n]);
  return content;
}

}  // namespace pcl_fft_ground::cli
