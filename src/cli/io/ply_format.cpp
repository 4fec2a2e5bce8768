#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <string>

#include "errors.h"
#include "io/cloud_fields.h"
#include "io/formats.h"
#include "io/scanner.h"

namespace pcl_fft_ground::cli {
namespace {

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

constexpr std::size_t largest_value = 8;  // bytes

[[noreturn]] void failTruncated(const PlyElement& element) {
  throw WorkError("it is truncated: it ends before the last of " + std::to_string(element.count) +
                  " elements " + quoted(element.name));
}

/// Takes the values of a PLY file one by one, however they are stored.
class ValueReader {
 public:
  ValueReader(std::string_view body, PlyStorage storage) : rest_(body), storage_(storage) {}

  std::string_view rest() const { return rest_; }
  PlyStorage storage() const { return storage_; }

  /// Checks that the file may still hold all of an element, before anything is allocated for it.
  void checkRoom(const PlyElement& element) const {
    std::size_t least = 0;
    for (const auto& property : element.properties) {
      const std::uint8_t first_type = property.length_type.value_or(property.datatype);
      least += storage_ == PlyStorage::ASCII ? 2 : valueSize(first_type);  // ascii: a digit and a separator
    }
    const std::size_t room = rest_.size() + (storage_ == PlyStorage::ASCII ? 1 : 0);
    if (least != 0 && element.count > room / least) failTruncated(element);
  }

  /// Stores the next value at `bytes`.
  void take(const PlyElement& element, std::uint8_t datatype, std::uint8_t* bytes) {
    if (storage_ == PlyStorage::ASCII) {
      const std::string_view word = takeWord(rest_);
      if (word.empty()) failTruncated(element);
      if (!storeNumber(word, datatype, bytes)) {
        throw WorkError("an element " + quoted(element.name) + " has the malformed value " + quoted(word));
      }
      return;
    }
    const std::size_t size = valueSize(datatype);
    if (rest_.size() < size) failTruncated(element);
    std::memcpy(bytes, rest_.data(), size);
    if (storage_ == PlyStorage::BINARY_BIG) std::reverse(bytes, bytes + size);
    rest_.remove_prefix(size);
  }

  /// Passes over a list.
  void skipList(const PlyElement& element, const PlyProperty& list) {
    std::array<std::uint8_t, largest_value> value{};
    take(element, *list.length_type, value.data());
    const double length = loadNumber(value.data(), *list.length_type);
    for (double i = 0; i < length; ++i) take(element, list.datatype, value.data());
  }

  /// Passes over all of an element.
  void skip(const PlyElement& element) {
    if (element.properties.empty()) return;
    std::array<std::uint8_t, largest_value> value{};
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const auto& property : element.properties) {
        if (property.length_type) skipList(element, property);
        if (!property.length_type) take(element, property.datatype, value.data());
      }
    }
  }

 private:
  std::string_view rest_;
  PlyStorage storage_;
};

bool hasLists(const PlyElement& element) {
  return std::any_of(element.properties.begin(), element.properties.end(),
                     [](const PlyProperty& property) { return property.length_type.has_value(); });
}

std::string fieldName(const std::string& property) {
  const bool normal = property == "nx" || property == "ny" || property == "nz";
  return normal ? "normal_" + property.substr(1) : property;
}

/// Vertices without lists are records of one size.
struct VertexRecords {
  std::vector<pcl::PCLPointField> fields;
  std::size_t bytes = 0;
  ByteOrder order = ByteOrder::LITTLE;

  VertexRecords(const PlyElement& vertices, PlyStorage storage)
      : order(storage == PlyStorage::BINARY_BIG ? ByteOrder::BIG : ByteOrder::LITTLE) {
    for (const auto& property : vertices.properties) {
      fields.push_back(recordField(fieldName(property.name), bytes, property.datatype));
      bytes += valueSize(property.datatype);
    }
  }

  pcl::PCLPointCloud2 read(std::string_view body, std::size_t count) const {
    return readRecords(body, bytes, fields, count, 1, order);
  }
};

pcl::PCLPointCloud2 readVertices(ValueReader& reader, const PlyElement& vertices) {
  pcl::PCLPointCloud2 table;
  for (const auto& property : vertices.properties) {
    if (!property.length_type) appendField(table, fieldName(property.name), property.datatype, 1);
  }
  if (table.fields.empty()) throw WorkError("its vertices have no properties x, y, z");
  reader.checkRoom(vertices);
  if (!hasLists(vertices) && reader.storage() != PlyStorage::ASCII)
    return VertexRecords(vertices, reader.storage()).read(reader.rest(), vertices.count);
  allocatePoints(table, vertices.count, 1);
  std::uint8_t* bytes = table.data.data();
  for (std::size_t i = 0; i < vertices.count; ++i) {
    for (const auto& property : vertices.properties) {
      if (property.length_type) {
        reader.skipList(vertices, property);
      } else {
        reader.take(vertices, property.datatype, bytes);
        bytes += valueSize(property.datatype);
      }
    }
  }
  return table;
}

}  // namespace

bool looksLikePly(std::string_view content) {
  return takeLine(content) == "ply";
}

RawCloud decodePly(std::string_view content) {
  const PlyHeader header = parsePlyHeader(content);
  ValueReader reader(content.substr(header.body), header.storage);
  for (const auto& element : header.elements) {
    if (element.name == "vertex") {
      RawCloud cloud;
      cloud.table = readVertices(reader, element);
      return cloud;
    }
    reader.checkRoom(element);
    reader.skip(element);
  }
  throw WorkError("the PLY header has no element 'vertex'");
}

std::optional<RecordFile> plyRecords(std::string_view head) {
  const PlyHeader header = parsePlyHeader(head);
  const bool is_first = !header.elements.empty() && header.elements.front().name == "vertex";
  if (!is_first || header.storage == PlyStorage::ASCII || hasLists(header.elements.front()))
    return std::nullopt;
  const VertexRecords records(header.elements.front(), header.storage);
  if (records.bytes == 0) return std::nullopt;
  return RecordFile{header.body,
                    records.bytes,
                    header.elements.front().count,
                    1,
                    [records](std::string_view bytes) {
                      RawCloud cloud;
                      cloud.table = records.read(bytes, bytes.size() / records.bytes);
                      return cloud;
                    },
                    nullptr};
}

}  // namespace pcl_fft_ground::cli
