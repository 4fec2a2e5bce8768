#include "io/ply_header.h"

#include <pcl/PCLPointField.h>

#include <map>

#include "errors.h"
#include "io/raw_cloud.h"
#include "io/scanner.h"

namespace pcl_fft_ground::cli {
namespace {

std::uint8_t valueType(std::string_view word) {
  using Field = pcl::PCLPointField;
  static const std::map<std::string_view, std::uint8_t> types{
      {"char", Field::INT8},      {"int8", Field::INT8},       {"uchar", Field::UINT8},
      {"uint8", Field::UINT8},    {"short", Field::INT16},     {"int16", Field::INT16},
      {"ushort", Field::UINT16},  {"uint16", Field::UINT16},   {"int", Field::INT32},
      {"int32", Field::INT32},    {"uint", Field::UINT32},     {"uint32", Field::UINT32},
      {"float", Field::FLOAT32},  {"float32", Field::FLOAT32}, {"double", Field::FLOAT64},
      {"float64", Field::FLOAT64}};
  const auto found = types.find(word);
  if (found == types.end()) throw WorkError("the PLY header has the unknown type " + quoted(word));
  return found->second;
}

std::uint8_t lengthType(std::string_view word) {
  const std::uint8_t type = valueType(word);
  if (type != pcl::PCLPointField::FLOAT32 && type != pcl::PCLPointField::FLOAT64) return type;
  throw WorkError("the PLY header has a list whose length is of type " + quoted(word) + ", not an integer");
}

PlyStorage parseFormat(std::string_view words) {
  const std::string_view format = takeWord(words);
  const std::string_view version = takeWord(words);
  if (version != "1.0") throw WorkError("the PLY header's version " + quoted(version) + " is not 1.0");
  if (format == "ascii") return PlyStorage::ASCII;
  if (format == "binary_little_endian") return PlyStorage::BINARY_LITTLE;
  if (format == "binary_big_endian") return PlyStorage::BINARY_BIG;
  throw WorkError("the PLY header's format " + quoted(format) +
                  " is not ascii, binary_little_endian or binary_big_endian");
}

PlyElement parseElement(std::string_view words) {
  PlyElement element;
  element.name = takeWord(words);
  const std::string_view word = takeWord(words);
  const auto count = parseNumber<std::int64_t>(word);
  if (!count || *count < 0 || *count > max_point_count) {
    throw WorkError("the PLY header's number of elements " + quoted(element.name) + ", " + quoted(word) +
                    ", is not a whole number from 0 to " + std::to_string(max_point_count));
  }
  element.count = static_cast<std::size_t>(*count);
  return element;
}

PlyProperty parseProperty(std::string_view words) {
  PlyProperty property;
  std::string_view type = takeWord(words);
  if (type == "list") {
    property.length_type = lengthType(takeWord(words));
    type = takeWord(words);
  }
  property.datatype = valueType(type);
  property.name = takeWord(words);
  if (property.name.empty()) throw WorkError("the PLY header has a property without a name");
  return property;
}

/// Takes in one line of the header behind the first.
/// \return whether it was the last one
bool parseLine(std::string_view line, PlyHeader& header, bool& has_format) {
  std::string_view words = line;
  const std::string_view keyword = takeWord(words);
  if (keyword == "end_header") return true;
  if (keyword == "format") {
    header.storage = parseFormat(words);
    has_format = true;
  } else if (keyword == "element") {
    header.elements.push_back(parseElement(words));
  } else if (keyword == "property" && !header.elements.empty()) {
    header.elements.back().properties.push_back(parseProperty(words));
  } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
    throw WorkError("this is no line of a PLY header: " + quoted(line));
  }
  return false;
}

}  // namespace

bool looksLikePly(std::string_view content) {
  return takeLine(content) == "ply";
}

PlyHeader parsePlyHeader(std::string_view content) {
  if (!looksLikePly(content)) throw WorkError("it is no PLY file: its first line is not 'ply'");
  std::string_view rest = content;
  takeLine(rest);
  PlyHeader header;
  bool has_format = false;
  bool complete = false;
  while (!complete) {
    if (rest.empty()) throw WorkError("the PLY header is truncated: it has no end_header line");
    complete = parseLine(takeLine(rest), header, has_format);
  }
  if (!has_format) throw WorkError("the PLY header has no format line");
  header.body = content.size() - rest.size();
  return header;
}

}  // namespace pcl_fft_ground::cli
