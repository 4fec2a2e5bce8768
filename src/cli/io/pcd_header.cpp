#include "io/pcd_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "errors.h"
#include "io/cloud_fields.h"
#include "io/raw_cloud.h"
#include "io/scanner.h"

namespace pcl_fft_ground::cli {
namespace {

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
  if (count && *count >= 1 && *count <= static_cast<std::int64_t>(max_point_bytes)) {
    return static_cast<std::uint32_t>(*count);
  }
  throw WorkError("the PCD header's COUNT " + quoted(word) + " is not from 1 to " +
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
    header.fields.push_back(field);
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
  if (rotation.norm() > 0) header.viewpoint.rotation = rotation;
}

PcdStorage parseStorage(const Words& words) {
  const std::string_view word = words.empty() ? std::string_view() : words.front();
  if (word == "ascii") return PcdStorage::ASCII;
  if (word == "binary") return PcdStorage::BINARY;
  if (word == "binary_compressed") return PcdStorage::COMPRESSED;
  throw WorkError("the PCD header's DATA " + quoted(word) + " is not ascii, binary or binary_compressed");
}

}  // namespace

bool looksLikePcd(std::string_view content) {
  while (!content.empty()) {
    std::string_view line = takeLine(content);
    if (line.substr(0, 6) == "# .PCD") return true;
    const std::string_view word = takeWord(line);
    if (!word.empty() && word.front() != '#') return isKeyword(word);
  }
  return false;
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

}  // namespace pcl_fft_ground::cli
