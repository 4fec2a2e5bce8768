#include <pcl/io/lzf.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <optional>

#include "errors.h"
#include "io/cloud_fields.h"
#include "io/cloud_file.h"
#include "io/formats.h"
#include "io/output_file.h"
#include "io/scanner.h"

namespace pcl_fft_ground::cli {
namespace {

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
  std::size_t body = 0;              ///< where the points begin in the file
  std::string pose_fault;            ///< why the viewpoint is no pose; empty if it is one
  std::vector<std::string> remarks;  ///< as in RawCloud
};

using Words = std::vector<std::string_view>;
using HeaderLines = std::map<std::string_view, Words>;

constexpr std::array<std::string_view, 11> keywords{"VERSION",   "FIELDS", "COLUMNS", "SIZE",
                                                    "TYPE",      "COUNT",  "WIDTH",   "HEIGHT",
                                                    "VIEWPOINT", "POINTS", "DATA"};

bool isKeyword(std::string_view word) {
  return std::find(keywords.begin(), keywords.end(), word) != keywords.end();
}

Words splitWords(std::string_view line) {
  Words words;
  for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line)) words.push_back(word);
  return words;
}

/// All lines up to DATA by their keyword; `rest` is left at the first byte after them.
HeaderLines collectLines(std::string_view& rest) {
  HeaderLines lines;
  for (int number = 1; !rest.empty(); ++number) {
    const std::string_view line = takeLine(rest);
    const Words words = splitWords(line);
    if (words.empty() || words.front().front() == '#') continue;
    if (!isKeyword(words.front())) {
      throw WorkError("line " + std::to_string(number) + " is no line of a PCD header: " + quoted(line));
    }
    lines[words.front()] = Words(words.begin() + 1, words.end());
    if (words.front() == "DATA") return lines;
  }
  throw WorkError("the PCD header is truncated: it has no DATA line");
}

/// The words of a line that has one for each field; nothing if the line is missing.
std::optional<Words> wordsPerField(const HeaderLines& lines, std::string_view keyword, std::size_t fields) {
  const auto found = lines.find(keyword);
  if (found == lines.end()) return std::nullopt;
  if (found->second.size() != fields) {
    throw WorkError("the PCD header's " + std::string(keyword) + " has " +
                    std::to_string(found->second.size()) + " values for " + std::to_string(fields) +
                    " fields");
  }
  return found->second;
}

std::uint8_t fieldType(std::string_view type, std::string_view size) {
  static const std::map<std::string, std::uint8_t> types{
      {"I1", pcl::PCLPointField::INT8},    {"I2", pcl::PCLPointField::INT16},
      {"I4", pcl::PCLPointField::INT32},   {"I8", INT64_FIELD},
      {"U1", pcl::PCLPointField::UINT8},   {"U2", pcl::PCLPointField::UINT16},
      {"U4", pcl::PCLPointField::UINT32},  {"U8", UINT64_FIELD},
      {"F4", pcl::PCLPointField::FLOAT32}, {"F8", pcl::PCLPointField::FLOAT64},
      {"B1", pcl::PCLPointField::UINT8}};
  const auto found = types.find(std::string(type) + std::string(size));
  if (found != types.end()) return found->second;
  throw WorkError("the PCD header's TYPE " + quoted(type) + " of SIZE " + quoted(size) +
                  " is none of I and U of 1, 2, 4 or 8 bytes and F of 4 or 8");
}

std::uint32_t fieldCount(std::string_view word) {
  const auto count = parseNumber<std::int64_t>(word);
  if (count && *count >= 0 && *count <= static_cast<std::int64_t>(max_point_bytes)) {
    return static_cast<std::uint32_t>(*count);
  }
  throw WorkError("the PCD header's COUNT " + quoted(word) + " is not from 0 to " +
                  std::to_string(max_point_bytes));
}

void parseFields(const HeaderLines& lines, PcdHeader& header) {
  const auto found = lines.count("FIELDS") != 0 ? lines.find("FIELDS") : lines.find("COLUMNS");
  if (found == lines.end() || found->second.empty()) throw WorkError("the PCD header names no FIELDS");
  const Words& names = found->second;
  const auto sizes = wordsPerField(lines, "SIZE", names.size());
  const auto types = wordsPerField(lines, "TYPE", names.size());
  const auto counts = wordsPerField(lines, "COUNT", names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    pcl::PCLPointField field;
    field.name = names[i];
    field.datatype = fieldType(types ? (*types)[i] : "F", sizes ? (*sizes)[i] : "4");
    field.count = counts ? fieldCount((*counts)[i]) : 1;
    field.offset = static_cast<pcl::uindex_t>(header.point_bytes);
    header.point_bytes += fieldSize(field);
    if (header.point_bytes > max_point_bytes) {
      throw WorkError("the PCD header's SIZE and COUNT make a point of more than " +
                      std::to_string(max_point_bytes) + " bytes");
    }
    if (field.count > 0)
      header.fields.push_back(field);
    else if (field.name != "_")  // as pcl::PCDReader does
      header.remarks.push_back("its field " + quoted(field.name) + " has COUNT 0 and is left out");
  }
}

/// The number on the line WIDTH, HEIGHT or POINTS; nothing if the line is missing.
std::optional<std::int64_t> pointNumber(const HeaderLines& lines, std::string_view keyword) {
  const auto found = lines.find(keyword);
  if (found == lines.end()) return std::nullopt;
  const std::string_view word = found->second.empty() ? std::string_view() : found->second.front();
  const auto number = parseNumber<std::int64_t>(word);
  if (number && *number >= 0 && *number <= max_point_count) return number;
  throw WorkError("the PCD header's " + std::string(keyword) + " " + quoted(word) +
                  " is not a whole number from 0 to " + std::to_string(max_point_count));
}

void parseExtent(const HeaderLines& lines, PcdHeader& header) {
  const auto points = pointNumber(lines, "POINTS");
  std::int64_t width = pointNumber(lines, "WIDTH").value_or(0);
  const std::int64_t height = std::max<std::int64_t>(pointNumber(lines, "HEIGHT").value_or(1), 1);
  if (width == 0 && height == 1)
    width = points.value_or(0);  // files older than version 0.7 need give POINTS only
  if (points.value_or(width * height) != width * height || width * height > max_point_count) {
    throw WorkError("the PCD header's WIDTH " + std::to_string(width) + " x HEIGHT " +
                    std::to_string(height) + " is not its POINTS, " +
                    std::to_string(points.value_or(max_point_count)));
  }
  header.width = static_cast<std::size_t>(width);
  header.height = static_cast<std::size_t>(height);
}

void parseViewpoint(const HeaderLines& lines, PcdHeader& header) {
  const auto found = lines.find("VIEWPOINT");
  if (found == lines.end()) return;
  std::vector<double> numbers;
  for (const std::string_view word : found->second) {
    const auto number = parseNumber<double>(word);
    if (!number || !std::isfinite(*number)) {
      throw WorkError("the PCD header's VIEWPOINT has " + quoted(word) + " where a finite number belongs");
    }
    numbers.push_back(*number);
  }
  if (numbers.size() != 7) {
    throw WorkError("the PCD header's VIEWPOINT has " + std::to_string(numbers.size()) +
                    " numbers, not the 7 of tx ty tz qw qx qy qz");
  }
  header.viewpoint.position = {numbers[0], numbers[1], numbers[2]};
  if (header.viewpoint.position.cwiseAbs().maxCoeff() > Viewpoint::FARTHEST)
    throw WorkError("the PCD header's VIEWPOINT lies more than 1e8 m from the origin");
  const Eigen::Quaterniond rotation(numbers[3], numbers[4], numbers[5], numbers[6]);
  if (rotation.norm() > 0)
    header.viewpoint.rotation = rotation;
  else
    header.pose_fault =
        "its VIEWPOINT has a quaternion of zeros, which is no rotation (1 0 0 0 is none at all)";
}

PcdStorage parseStorage(const Words& words) {
  std::string word(words.empty() ? std::string_view() : words.front());
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (word == "ascii") return PcdStorage::ASCII;
  if (word == "binary") return PcdStorage::BINARY;
  if (word == "binary_compressed") return PcdStorage::COMPRESSED;
  throw WorkError("the PCD header's DATA " + quoted(word) + " is not ascii, binary or binary_compressed");
}

PcdHeader parsePcdHeader(std::string_view content) {
  std::string_view rest = content;
  const HeaderLines lines = collectLines(rest);
  PcdHeader header;
  parseFields(lines, header);
  parseExtent(lines, header);
  parseViewpoint(lines, header);
  header.storage = parseStorage(lines.at("DATA"));
  header.body = content.size() - rest.size();
  return header;
}

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
  cloud.pose_fault = header.pose_fault;
  cloud.remarks = header.remarks;
  return cloud;
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
  if (needed != 0) requireRoom(points, needed - 1, body.size());
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

pcl::PCLPointCloud2 decodeBinary(std::string_view body, const PcdHeader& header, std::size_t width,
                                 std::size_t height) {
  std::vector<pcl::PCLPointField> wanted;
  std::remove_copy_if(header.fields.begin(), header.fields.end(), std::back_inserter(wanted), isPadding);
  return readRecords(body, header.point_bytes, wanted, width, height);
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

}  // namespace

std::string pcdHeader(const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint) {
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

bool looksLikePcd(std::string_view content) {
  while (!content.empty()) {
    std::string_view line = takeLine(content);
    if (line.substr(0, 6) == "# .PCD") return true;
    const std::string_view word = takeWord(line);
    if (!word.empty() && word.front() != '#') return isKeyword(word);
  }
  return false;
}

RawCloud decodePcd(std::string_view content) {
  const PcdHeader header = parsePcdHeader(content);
  const std::string_view body = content.substr(header.body);
  RawCloud cloud = emptyCloud(header);
  switch (header.storage) {
    case PcdStorage::ASCII:
      decodeAscii(body, header, cloud.table);
      break;
    case PcdStorage::BINARY:
      cloud.table = decodeBinary(body, header, header.width, header.height);
      break;
    case PcdStorage::COMPRESSED:
      decodeCompressed(body, header, cloud.table);
      break;
  }
  return cloud;
}

std::optional<RecordFile> pcdRecords(std::string_view head) {
  const PcdHeader header = parsePcdHeader(head);
  if (header.storage != PcdStorage::BINARY || header.point_bytes == 0) return std::nullopt;
  return RecordFile{header.body,
                    header.point_bytes,
                    header.width,
                    header.height,
                    [header](std::string_view records) {
                      RawCloud cloud = emptyCloud(header);
                      cloud.table = decodeBinary(records, header, records.size() / header.point_bytes, 1);
                      return cloud;
                    },
                    nullptr};
}

void writePcd(const std::string& path, const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint) {
  pcl::Indices all(pointCount(cloud));
  std::iota(all.begin(), all.end(), 0);
  pcl::PCLPointCloud2 packed = selectPoints(cloud, all);
  packed.width = cloud.width;
  packed.height = cloud.height;
  std::string content = pcdHeader(packed, viewpoint);
  content.append(reinterpret_cast<const char*>(packed.data.data()), packed.data.size());
  writeText(path, content);
}

}  // namespace pcl_fft_ground::cli
