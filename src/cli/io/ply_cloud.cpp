#include "io/ply_cloud.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "errors.h"
#include "io/cloud_fields.h"
#include "io/ply_header.h"
#include "io/scanner.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr std::size_t largest_value = 8;  // bytes

[[noreturn]] void failTruncated(const PlyElement& element) {
  throw WorkError("it is truncated: it ends before the last of " + std::to_string(element.count) +
                  " elements " + quoted(element.name));
}

/// Takes the values of a PLY file one by one, however they are stored.
class ValueReader {
 public:
  ValueReader(std::string_view body, PlyStorage storage) : rest_(body), storage_(storage) {}

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

std::string fieldName(const std::string& property) {
  const bool normal = property == "nx" || property == "ny" || property == "nz";
  return normal ? "normal_" + property.substr(1) : property;
}

pcl::PCLPointCloud2 readVertices(ValueReader& reader, const PlyElement& vertices) {
  pcl::PCLPointCloud2 table;
  for (const auto& property : vertices.properties) {
    if (!property.length_type) appendField(table, fieldName(property.name), property.datatype, 1);
  }
  if (table.fields.empty()) throw WorkError("its vertices have no properties x, y, z");
  reader.checkRoom(vertices);
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

}  // namespace pcl_fft_ground::cli
