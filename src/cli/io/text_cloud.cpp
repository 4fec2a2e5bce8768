#include "io/text_cloud.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "errors.h"
#include "io/cloud_fields.h"
#include "io/scanner.h"

namespace pcl_fft_ground::cli {
namespace {

enum class Role { IGNORED, COORDINATE, LABEL, EXTRA };

/// What the values of a line mean, and where in a point's bytes they go.
struct Column {
  Role role = Role::IGNORED;
  std::size_t offset = 0;
};

bool isSeparator(char c) {
  return isBlank(c) || c == ',' || c == ';';
}

/// Takes the first value off a line, with the one comma or semicolon behind it; so `1,,2` has an empty
/// value.
std::string_view takeValue(std::string_view& line) {
  std::size_t length = 0;
  while (length < line.size() && !isSeparator(line[length])) ++length;
  const std::string_view value = line.substr(0, length);
  line.remove_prefix(length);
  skipBlanks(line);
  if (!line.empty() && isSeparator(line.front())) line.remove_prefix(1);
  skipBlanks(line);
  return value;
}

/// Takes the next line that has values, without comment and blanks in front.
/// \return empty at the end
std::string_view takeDataLine(std::string_view& rest, std::size_t& line_number) {
  while (!rest.empty()) {
    std::string_view line = takeLine(rest);
    ++line_number;
    line = line.substr(0, line.find('#'));
    skipBlanks(line);
    if (!line.empty()) return line;
  }
  return {};
}

std::vector<std::string> splitValues(std::string_view line) {
  std::vector<std::string> values;
  while (!line.empty()) values.emplace_back(takeValue(line));
  return values;
}

bool isHeader(const std::vector<std::string>& values) {
  return !parseNumber<double>(values.front()) || values.size() == 1;
}

/// A column's name as a field's: lower case, without the quotes and slashes that some programs put in
/// front.
std::string columnName(const std::string& value) {
  std::string name;
  for (const char c : value) {
    if (c != '"' && c != '/') name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return name;
}

/// Appends a field for a column of values; `table` is the layout so far.
Column appendColumn(pcl::PCLPointCloud2& table, const std::string& name, Role role) {
  const Column column{role, table.point_step};
  const auto type = role == Role::COORDINATE ? pcl::PCLPointField::FLOAT64
                    : role == Role::LABEL    ? pcl::PCLPointField::INT32
                                             : pcl::PCLPointField::FLOAT32;
  appendField(table, name, static_cast<std::uint8_t>(type), 1);
  return column;
}

/// The columns that a header line names; empty if it names none of x, y, z. A name's second column is
/// ignored.
std::vector<Column> namedColumns(const std::vector<std::string>& header, pcl::PCLPointCloud2& table) {
  std::vector<std::string> names(header.size());
  std::transform(header.begin(), header.end(), names.begin(), columnName);
  const auto named = [&](const char* name) { return std::count(names.begin(), names.end(), name) != 0; };
  if (!named("x") && !named("y") && !named("z")) return {};
  if (!named("x") || !named("y") || !named("z"))
    throw WorkError("its header line does not name all of x, y and z");
  std::vector<Column> columns;
  for (const std::string& name : names) {
    const bool coordinate = name == "x" || name == "y" || name == "z";
    const Role role = coordinate ? Role::COORDINATE : name == "label" ? Role::LABEL : Role::EXTRA;
    const bool wanted = !name.empty() && findField(table, name) == nullptr;
    columns.push_back(wanted ? appendColumn(table, name, role) : Column{});
  }
  return columns;
}

/// The columns of a file that does not name them.
std::vector<Column> countedColumns(std::size_t count, pcl::PCLPointCloud2& table) {
  std::vector<Column> columns(std::max<std::size_t>(count, 3));
  for (std::size_t i = 0; i < 3; ++i)
    columns[i] = appendColumn(table, std::string(1, "xyz"[i]), Role::COORDINATE);
  if (count == 4) columns[3] = appendColumn(table, "label", Role::LABEL);
  return columns;
}

template <typename Value>
void store(Value value, std::uint8_t* bytes) {
  std::memcpy(bytes, &value, sizeof value);
}

/// Stores one value of a line.
/// \return false if it is not what its column asks for
bool storeValue(std::string_view text, const Column& column, std::uint8_t* point) {
  if (column.role == Role::IGNORED) return true;
  const auto number = parseNumber<double>(text);
  std::uint8_t* const bytes = point + column.offset;
  if (column.role == Role::EXTRA) {
    store(static_cast<float>(number.value_or(std::numeric_limits<double>::quiet_NaN())), bytes);
    return true;
  }
  if (!number) return false;
  if (column.role == Role::COORDINATE) {
    store(*number, bytes);
    return true;
  }
  if (std::isnan(*number)) {
    store(std::int32_t{2}, bytes);
    return true;
  }
  return storeNumber(text, pcl::PCLPointField::INT32, bytes);
}

/// Stores the values of a line as one point.
/// \return whether they fit the columns
bool decodeLine(std::string_view line, const std::vector<Column>& columns, std::uint8_t* point) {
  for (const Column& column : columns) {
    if (line.empty() || !storeValue(takeValue(line), column, point)) return false;
  }
  return line.empty();
}

[[noreturn]] void failMalformed(std::size_t line_number, std::string_view line,
                                const std::vector<Column>& columns) {
  const bool labelled = std::any_of(columns.begin(), columns.end(),
                                    [](const Column& column) { return column.role == Role::LABEL; });
  throw WorkError("line " + std::to_string(line_number) + " is malformed: " + quoted(line) + " is not " +
                  std::to_string(columns.size()) + " values with x, y, z numbers" +
                  (labelled ? " and the label a whole number" : ""));
}

}  // namespace

RawCloud decodeText(std::string_view content) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (content.substr(0, byte_order_mark.size()) == byte_order_mark)
    content.remove_prefix(byte_order_mark.size());
  if (content.find('\0') != std::string_view::npos) throw WorkError("it is neither PCD nor PLY nor text");

  RawCloud cloud;
  std::size_t line_number = 0;
  std::string_view line = takeDataLine(content, line_number);
  if (line.empty()) return cloud;
  std::vector<Column> columns;
  if (const auto values = splitValues(line); isHeader(values)) {
    columns = namedColumns(values, cloud.table);
    line = takeDataLine(content, line_number);
  }
  if (columns.empty()) columns = countedColumns(splitValues(line).size(), cloud.table);

  const std::size_t step = cloud.table.point_step;
  std::vector<std::uint8_t> data;
  for (; !line.empty(); line = takeDataLine(content, line_number)) {
    data.resize(data.size() + step);
    if (!decodeLine(line, columns, data.data() + data.size() - step))
      failMalformed(line_number, line, columns);
  }
  if (data.size() / step > static_cast<std::size_t>(max_point_count))
    throw WorkError("it holds too many points");
  allocatePoints(cloud.table, 0, 1);
  cloud.table.width = static_cast<pcl::uindex_t>(data.size() / step);
  cloud.table.row_step = static_cast<pcl::uindex_t>(data.size());
  cloud.table.data = std::move(data);
  return cloud;
}

}  // namespace pcl_fft_ground::cli
