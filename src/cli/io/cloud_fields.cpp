#include "io/cloud_fields.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "io/scanner.h"

namespace pcl_fft_ground::cli {
namespace {

/// Calls `use` with a value of the C++ type that a field type stands for.
template <typename Use>
auto withType(std::uint8_t datatype, Use&& use) {
  switch (datatype) {
    case pcl::PCLPointField::INT8:
      return use(std::int8_t{});
    case BOOL_FIELD:
    case pcl::PCLPointField::UINT8:
      return use(std::uint8_t{});
    case pcl::PCLPointField::INT16:
      return use(std::int16_t{});
    case pcl::PCLPointField::UINT16:
      return use(std::uint16_t{});
    case pcl::PCLPointField::INT32:
      return use(std::int32_t{});
    case pcl::PCLPointField::UINT32:
      return use(std::uint32_t{});
    case INT64_FIELD:
      return use(std::int64_t{});
    case UINT64_FIELD:
      return use(std::uint64_t{});
    case pcl::PCLPointField::FLOAT32:
      return use(float{});
    case pcl::PCLPointField::FLOAT64:
      return use(double{});
    default:
      throw std::invalid_argument("unknown field type " + std::to_string(datatype));
  }
}

/// As parseNumber, but an integer may also be written as "1.0" or "1e3".
template <typename Number>
std::optional<Number> parseAs(std::string_view text) {
  const std::optional<Number> exact = parseNumber<Number>(text);
  if (exact || std::is_floating_point_v<Number>) return exact;
  const std::optional<double> real = parseNumber<double>(text);
  const double limit = std::ldexp(1.0, std::numeric_limits<Number>::digits);
  const double lowest = std::is_signed_v<Number> ? -limit : 0.0;
  if (!real || *real != std::trunc(*real) || *real < lowest || *real >= limit) return std::nullopt;
  return static_cast<Number>(*real);
}

/// A layout of the wanted fields, packed.
pcl::PCLPointCloud2 packedLayout(const pcl::PCLPointCloud2& cloud,
                                 const std::vector<pcl::PCLPointField>& wanted) {
  pcl::PCLPointCloud2 result;
  result.header = cloud.header;
  result.is_dense = cloud.is_dense;
  for (const auto& field : wanted) appendField(result, field.name, field.datatype, field.count);
  return result;
}

/// Copies the wanted fields of point `from` behind one another to `bytes`.
void copyPoint(const pcl::PCLPointCloud2& cloud, const std::vector<pcl::PCLPointField>& wanted,
               std::size_t from, std::uint8_t* bytes) {
  const std::uint8_t* const point = cloud.data.data() + from * cloud.point_step;
  for (const auto& field : wanted) {
    std::memcpy(bytes, point + field.offset, fieldSize(field));
    bytes += fieldSize(field);
  }
}

bool hasField(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  return findField(cloud, name) != nullptr;
}

std::string freeName(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  int number = 2;
  while (hasField(cloud, name + "_" + std::to_string(number))) ++number;
  return name + "_" + std::to_string(number);
}

/// The field that findField finds, to be changed.
pcl::PCLPointField& fieldToChange(pcl::PCLPointCloud2& cloud, const std::string& name) {
  return *std::find_if(cloud.fields.begin(), cloud.fields.end(),
                       [&](const auto& f) { return f.name == name; });
}

}  // namespace

std::size_t valueSize(std::uint8_t datatype) {
  return withType(datatype, [](auto value) { return sizeof value; });
}

std::size_t fieldSize(const pcl::PCLPointField& field) {
  return valueSize(field.datatype) * field.count;
}

void appendField(pcl::PCLPointCloud2& cloud, const std::string& name, std::uint8_t datatype,
                 std::uint32_t count) {
  pcl::PCLPointField field;
  field.name = name;
  field.datatype = datatype;
  field.count = count;
  field.offset = cloud.point_step;
  cloud.point_step += static_cast<pcl::uindex_t>(fieldSize(field));
  cloud.fields.push_back(field);
}

void allocatePoints(pcl::PCLPointCloud2& cloud, std::size_t width, std::size_t height) {
  cloud.width = static_cast<pcl::uindex_t>(width);
  cloud.height = static_cast<pcl::uindex_t>(height);
  cloud.row_step = static_cast<pcl::uindex_t>(width * cloud.point_step);
  cloud.data.assign(width * height * cloud.point_step, 0);
}

const pcl::PCLPointField* findField(const pcl::PCLPointCloud2& cloud, std::string_view name) {
  const auto found =
      std::find_if(cloud.fields.begin(), cloud.fields.end(), [&](const auto& f) { return f.name == name; });
  return found == cloud.fields.end() ? nullptr : &*found;
}

bool isLabelName(std::string_view name) {
  static const std::array<std::string_view, 6> names{"label",        "class",        "classification",
                                                     "scalar_label", "scalar_class", "scalar_classification"};
  std::string plain(name);
  for (char& c : plain) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(names.begin(), names.end(), plain) != names.end();
}

const pcl::PCLPointField* findLabelField(const pcl::PCLPointCloud2& cloud) {
  const pcl::PCLPointField* found = findField(cloud, "label");
  for (const auto& field : cloud.fields)
    if (found == nullptr && isLabelName(field.name)) found = &field;
  return found != nullptr && found->count == 1 ? found : nullptr;
}

double loadNumber(const std::uint8_t* bytes, std::uint8_t datatype) {
  return withType(datatype, [&](auto value) {
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  });
}

bool storeNumber(std::string_view text, std::uint8_t datatype, std::uint8_t* bytes) {
  return withType(datatype, [&](auto type) {
    const auto value = parseAs<decltype(type)>(text);
    if (value) std::memcpy(bytes, &*value, sizeof *value);
    return value.has_value();
  });
}

std::vector<double> fieldNumbers(const pcl::PCLPointCloud2& cloud, const pcl::PCLPointField& field) {
  std::vector<double> numbers(pointCount(cloud));
  withType(field.datatype, [&](auto value) {
    const std::uint8_t* bytes = cloud.data.data() + field.offset;
    for (double& number : numbers) {
      std::memcpy(&value, bytes, sizeof value);
      number = static_cast<double>(value);
      bytes += cloud.point_step;
    }
  });
  return numbers;
}

void renameField(pcl::PCLPointCloud2& cloud, const std::string& from, const std::string& to) {
  if (from == to || !hasField(cloud, from)) return;
  while (hasField(cloud, to)) fieldToChange(cloud, to).name = freeName(cloud, to);
  fieldToChange(cloud, from).name = to;
}

namespace {

template <typename Value>
void setField(pcl::PCLPointCloud2& cloud, const std::string& name, const std::vector<Value>& values,
              std::uint8_t datatype) {
  if (values.size() != pointCount(cloud)) {
    throw std::invalid_argument("field '" + name + "' needs one value for each of " +
                                std::to_string(pointCount(cloud)) + " points, not " +
                                std::to_string(values.size()));
  }
  std::vector<pcl::PCLPointField> kept;
  for (const auto& field : cloud.fields) {
    if (field.name != name && field.name != "_") kept.push_back(field);
  }
  pcl::PCLPointCloud2 result = packedLayout(cloud, kept);
  const std::size_t value_offset = result.point_step;
  appendField(result, name, datatype, 1);
  allocatePoints(result, cloud.width, cloud.height);
  std::uint8_t* bytes = result.data.data();
  for (std::size_t i = 0; i < values.size(); ++i, bytes += result.point_step) {
    copyPoint(cloud, kept, i, bytes);
    std::memcpy(bytes + value_offset, &values[i], sizeof values[i]);
  }
  cloud = std::move(result);
}

}  // namespace

void setInt32Field(pcl::PCLPointCloud2& cloud, const std::string& name,
                   const std::vector<std::int32_t>& values) {
  setField(cloud, name, values, pcl::PCLPointField::INT32);
}

void setFloatField(pcl::PCLPointCloud2& cloud, const std::string& name, const std::vector<float>& values) {
  setField(cloud, name, values, pcl::PCLPointField::FLOAT32);
}

pcl::PCLPointCloud2 selectPoints(const pcl::PCLPointCloud2& cloud, const pcl::Indices& indices) {
  std::vector<pcl::PCLPointField> kept;
  for (const auto& field : cloud.fields) {
    if (field.name != "_") kept.push_back(field);
  }
  pcl::PCLPointCloud2 result = packedLayout(cloud, kept);
  allocatePoints(result, indices.size(), 1);
  std::uint8_t* bytes = result.data.data();
  for (const pcl::index_t index : indices) {
    if (index < 0 || static_cast<std::size_t>(index) >= pointCount(cloud)) {
      throw std::out_of_range("point " + std::to_string(index) + " of a cloud of " +
                              std::to_string(pointCount(cloud)) + " points");
    }
    copyPoint(cloud, kept, static_cast<std::size_t>(index), bytes);
    bytes += result.point_step;
  }
  return result;
}

}  // namespace pcl_fft_ground::cli
