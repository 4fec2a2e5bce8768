#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "errors.h"
#include "io/cloud_fields.h"
#include "io/formats.h"
#include "io/scanner.h"
#include "io/text_lines.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// A column's name as the header gives it, as a field's: without quotes, slashes in front and blanks.
std::string fieldNameOf(std::string_view word) {
  std::string name;
  for (const char c : word) {
    if (isQuote(c) || (c == '/' && name.empty())) continue;
    name += static_cast<unsigned char>(c) <= ' ' ? '_' : c;
  }
  while (!name.empty() && name.front() == '_') name.erase(0, 1);
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name;
}

/// Which of x, y, z (0, 1, 2) a column is by its name, a unit in brackets or behind a slash left aside.
std::optional<std::size_t> axisNamed(const std::string& name) {
  static const std::array<std::vector<std::string>, 3> names{
      {{"x", "easting", "east", "lon", "long", "longitude", "point_x", "x_coord", "coord_x", "points:0"},
       {"y", "northing", "north", "lat", "latitude", "point_y", "y_coord", "coord_y", "points:1"},
       {"z", "elevation", "elev", "height", "altitude", "alt", "depth", "point_z", "z_coord", "coord_z",
        "points:2"}}};
  std::string plain = lowered(name.substr(0, name.find_first_of("[(/")));
  while (!plain.empty() && plain.back() == '_') plain.pop_back();
  if (plain.size() > 2 && plain.substr(plain.size() - 2) == "_m") plain.resize(plain.size() - 2);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (std::find(names[axis].begin(), names[axis].end(), plain) != names[axis].end()) return axis;
  return std::nullopt;
}

/// The names of a header line; words that are only a unit, such as `[m]` after a blank, are none.
std::vector<std::string> headerNames(std::string_view line) {
  const bool semicolons = line.find(';') != std::string_view::npos;
  std::vector<std::string> names;
  const bool delimited = line.find_first_of(",;\t") != std::string_view::npos;
  while (!line.empty()) {
    std::string_view word;
    if (delimited && !isQuote(line.front())) {
      const std::size_t end = line.find_first_of(semicolons ? ";" : ",\t");
      word = line.substr(0, end);
      line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
    } else {
      word = takeValue(line, semicolons ? Comma::DECIMAL : Comma::SEPARATOR);
    }
    const bool is_unit = !delimited && !word.empty() && (word.front() == '[' || word.front() == '(');
    if (!is_unit) names.push_back(fieldNameOf(word));
  }
  if (names.size() > 1 && names.back().empty()) names.pop_back();
  return names;
}

bool namesAllAxes(const std::vector<std::string>& names) {
  std::array<bool, 3> named{};
  for (const std::string& name : names)
    if (const auto axis = axisNamed(name)) named[*axis] = true;
  return named[0] && named[1] && named[2];
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return quoted(list);
}

enum class Role { IGNORED, X, Y, Z, LABEL, CLASSES, EXTRA, FOURTH };

/// What the values of a column mean.
struct Column {
  Role role = Role::IGNORED;
  std::string name;

  bool isCoordinate() const { return role == Role::X || role == Role::Y || role == Role::Z; }
};

Role roleOfName(const std::string& name) {
  const std::string plain = lowered(name);
  if (plain == "label") return Role::LABEL;
  return isLabelName(plain) ? Role::CLASSES : Role::EXTRA;
}

/// The place of x, y and z among named columns. The name itself comes before one that means the same (height
/// beside z), an earlier column before a later one.
/// \throws WorkError where the header names some of them, but not all, and not in the first three columns
std::array<std::size_t, 3> axesAmong(const std::vector<std::string>& names) {
  constexpr std::size_t missing = std::numeric_limits<std::size_t>::max();
  std::array<std::size_t, 3> axes{missing, missing, missing};
  for (const bool itself : {true, false})
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto axis = axisNamed(names[i]);
      const bool is_itself = axis && lowered(names[i]) == std::string(1, "xyz"[*axis]);
      if (axis && axes[*axis] == missing && is_itself == itself) axes[*axis] = i;
    }
  if (std::find(axes.begin(), axes.end(), missing) == axes.end()) return axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axes[axis] != missing && axes[axis] != axis)
      throw WorkError("its header does not name all of x, y and z; its columns are " + listed(names));
  }
  return {0, 1, 2};
}

/// The columns that a header names.
std::vector<Column> namedColumns(const std::vector<std::string>& names) {
  const std::array<std::size_t, 3> axes = axesAmong(names);
  std::vector<Column> columns(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto axis = static_cast<std::size_t>(std::find(axes.begin(), axes.end(), i) - axes.begin());
    const bool repeated = std::any_of(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(i),
                                      [&](const Column& other) { return other.name == names[i]; });
    if (axis < 3)
      columns[i] = {std::array{Role::X, Role::Y, Role::Z}[axis], std::string(1, "xyz"[axis])};
    else if (const Role role = roleOfName(names[i]); role == Role::LABEL)
      columns[i] = {repeated ? Role::IGNORED : role, "label"};
    else if (!names[i].empty() && !repeated)
      columns[i] = {role, names[i]};
  }
  for (Column& column : columns)  // such as a second x, or a Z beside the z of another name
    if (!column.isCoordinate() && (column.name == "x" || column.name == "y" || column.name == "z"))
      column.role = Role::IGNORED;
  return columns;
}

/// The columns of a file that does not name them.
std::vector<Column> countedColumns(std::size_t count) {
  std::vector<Column> columns{{Role::X, "x"}, {Role::Y, "y"}, {Role::Z, "z"}};
  for (std::size_t i = 3; i < count; ++i)
    columns.push_back({count == 4 ? Role::FOURTH : Role::EXTRA, "field" + std::to_string(i + 1)});
  return columns;
}

[[noreturn]] void failMalformed(std::size_t line_number, std::string_view line,
                                const std::vector<Column>& columns) {
  const bool labelled = std::any_of(columns.begin(), columns.end(),
                                    [](const Column& column) { return column.role == Role::LABEL; });
  throw WorkError("line " + std::to_string(line_number) + " is malformed: " + quoted(line) + " is not " +
                  std::to_string(columns.size()) + " values with x, y, z numbers" +
                  (labelled ? " and the label a whole number" : ""));
}

/// Appends the numbers of a line.
/// \return whether they fit the columns
bool decodeLine(std::string_view line, const Values& values, const std::vector<Column>& columns,
                std::vector<double>& numbers) {
  // A separator at the end has an empty value behind it where one is missing.
  const bool last_is_empty =
      values.size() + 1 == columns.size() && columns.size() > 3 && endsWithSeparator(line);
  if (values.size() != columns.size() && !last_is_empty) return false;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto number = i < values.size() ? parseReal(values[i]) : std::nullopt;
    if (columns[i].isCoordinate() && !number) return false;
    if (columns[i].role == Role::LABEL) {
      if (!number || (std::isfinite(*number) && *number != std::round(*number))) return false;
      if (std::abs(*number) > std::numeric_limits<std::int32_t>::max()) return false;
    }
    numbers.push_back(number.value_or(not_a_number));
  }
  return true;
}

/// Notices files of whole numbers parted by commas that are halves of numbers with decimal commas: then every
/// second value is the digits behind a comma, as many in each line, or with a zero in front.
class DecimalCommaSuspicion {
 public:
  void look(const Values& values) {
    ++lines_;
    if (values.size() < 6 || values.size() % 2 != 0) possible_ = false;
    for (std::size_t i = 0; possible_ && i < values.size(); ++i) {
      const std::string_view digits = values[i].substr(i % 2 == 0 && values[i].substr(0, 1) == "-" ? 1 : 0);
      possible_ = (!digits.empty() || i % 2 == 1) && std::all_of(digits.begin(), digits.end(), isDigit);
      if (i % 2 == 0) continue;
      if (digits.size() > 1 && digits.front() == '0') zero_in_front_ = true;
      if (lines_ == 1 && i == 1) width_ = digits.size();
      if (digits.size() != width_) same_width_ = false;
    }
  }

  bool isFounded() const {
    return possible_ && lines_ > 0 && (zero_in_front_ || (same_width_ && width_ >= 2 && lines_ >= 3));
  }

 private:
  std::size_t lines_ = 0, width_ = 0;
  bool possible_ = true, zero_in_front_ = false, same_width_ = true;
};

/// What stands in front of the points of a text.
struct Preamble {
  std::vector<std::string> names;
  bool has_header = false;
  std::string_view first_line;  ///< of the points; empty if there are none
};

/// Takes the mark of a comment and the blanks behind it off a line.
/// \return whether there was one
bool takeCommentMark(std::string_view& line) {
  const bool is_slashes = line.substr(0, 2) == "//";
  const bool is_comment = is_slashes || line.front() == '#' || line.front() == '%' || line.front() == '!';
  while (is_comment && !line.empty() &&
         (isBlank(line.front()) || line.front() == '#' || line.front() == '/' || line.front() == '%' ||
          line.front() == '!'))
    line.remove_prefix(1);
  return is_comment;
}

/// Whether a line has only units, as it may stand below a header.
bool isLineOfUnits(const Values& values) {
  static const std::array<std::string_view, 8> units{"m",   "mm",      "cm",     "ft",
                                                     "deg", "degrees", "metres", "meters"};
  return std::all_of(values.begin(), values.end(), [](std::string_view value) {
    return value.empty() || value.front() == '[' || value.front() == '(' ||
           std::find(units.begin(), units.end(), lowered(value)) != units.end();
  });
}

/// Reads up to the first line of the points.
Preamble readPreamble(Lines& lines) {
  Preamble preamble;
  bool has_count = false;
  for (std::string_view line = lines.next(); !line.empty(); line = lines.next()) {
    const bool is_slashes = line.substr(0, 2) == "//";
    if (takeCommentMark(line)) {  // which is a header if it names what has to be named
      std::vector<std::string> names = headerNames(line);
      const bool is_first = is_slashes && preamble.names.empty();  // as CloudCompare writes it, by any names
      if (!preamble.has_header && (is_first || namesAllAxes(names))) preamble.names = std::move(names);
      continue;
    }
    line = line.substr(0, line.find('#'));
    const Values values = splitValues(line, meaningOfCommas(line));
    const bool is_count = values.size() == 1 && parseNumber<double>(values.front());
    if (is_count && !has_count) {
      has_count = true;
    } else if (!preamble.names.empty() && isLineOfUnits(values)) {
      continue;
    } else if (!parseReal(values.front()) && !preamble.has_header) {
      preamble.names = headerNames(line);
      preamble.has_header = true;
    } else {
      preamble.first_line = line;
      return preamble;
    }
  }
  return preamble;
}

/// The columns of a file: as its header names them, if that is one of columns and not a title.
std::vector<Column> columnsOf(const Preamble& preamble, std::size_t count,
                              std::vector<std::string>& remarks) {
  const std::vector<std::string>& names = preamble.names;
  const bool knows_axis =
      std::any_of(names.begin(), names.end(), [](const auto& name) { return axisNamed(name).has_value(); });
  // A title may have any words, 'depth' among them; a comment any letters.
  const bool fits = names.size() == count || (names.size() == count + 1 && names.size() > 3);
  const bool named = names.size() >= 3 && (fits || (preamble.has_header && namesAllAxes(names)));
  if (!named) return countedColumns(count);
  if (!knows_axis)
    remarks.push_back("its header names none of x, y and z: its first three columns, " +
                      listed({names.begin(), names.begin() + 3}) + ", are taken for them");
  for (const std::string& name : names) {
    const std::string plain = lowered(name);
    if (plain != "lon" && plain != "longitude" && plain != "lat" && plain != "latitude") continue;
    remarks.push_back("its column " + quoted(name) +
                      " holds degrees by its name: lengths are in the file's units, so coordinates projected "
                      "to metres are needed for a right result");
    break;
  }
  return namedColumns(names);
}

/// The numbers of a column as a field of the type that holds them best.
struct FieldType {
  std::string name;
  std::uint8_t datatype = pcl::PCLPointField::FLOAT32;
};

/// \return nothing for a column to leave out
std::optional<FieldType> fieldTypeOf(const Column& column, const std::vector<double>& numbers,
                                     std::size_t place, std::size_t step) {
  constexpr double largest_exact = 16777216;  // beyond it floats lose whole numbers (times in seconds, say)
  if (column.role == Role::IGNORED) return std::nullopt;
  if (column.isCoordinate()) return FieldType{column.name, pcl::PCLPointField::FLOAT64};
  bool whole = true, known = true, large = false, any = false, all = true;
  for (std::size_t n = place; n < numbers.size(); n += step) {
    const double number = numbers[n];
    if (std::isnan(number)) {
      all = false;
      continue;
    }
    any = true;
    whole = whole && number == std::round(number) && std::abs(number) <= largest_exact;
    known = known && (number == 0 || number == 1 || number == 2);
    large = large || (std::isfinite(number) && std::abs(number) > largest_exact);
  }
  if (column.role == Role::FOURTH && any && known)
    return FieldType{
        "label", static_cast<std::uint8_t>(all ? pcl::PCLPointField::INT32 : pcl::PCLPointField::FLOAT32)};
  if (!any && column.name.substr(0, 5) == "field") return std::nullopt;  // words without a name
  const bool classes = column.role == Role::LABEL || column.role == Role::CLASSES;
  if (classes && whole && all) return FieldType{column.name, pcl::PCLPointField::INT32};
  return FieldType{column.name, static_cast<std::uint8_t>(large ? pcl::PCLPointField::FLOAT64
                                                                : pcl::PCLPointField::FLOAT32)};
}

void storeReal(double number, std::uint8_t datatype, std::uint8_t* bytes) {
  const auto store = [&](auto value) { std::memcpy(bytes, &value, sizeof value); };
  if (datatype == pcl::PCLPointField::INT32) return store(static_cast<std::int32_t>(number));
  if (datatype == pcl::PCLPointField::FLOAT32) return store(static_cast<float>(number));
  store(number);
}

/// \param numbers  those of each point behind one another, one for each column
pcl::PCLPointCloud2 toTable(const std::vector<Column>& columns, const std::vector<double>& numbers) {
  pcl::PCLPointCloud2 table;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto type = fieldTypeOf(columns[i], numbers, i, columns.size());
    if (!type) continue;
    appendField(table, type->name, type->datatype, 1);
    places.push_back(i);
  }
  const std::size_t points = numbers.size() / columns.size();
  if (points > static_cast<std::size_t>(max_point_count)) throw WorkError("it holds too many points");
  allocatePoints(table, points, 1);
  for (std::size_t n = 0; n < points; ++n)
    for (std::size_t f = 0; f < places.size(); ++f)
      storeReal(numbers[n * columns.size() + places[f]], table.fields[f].datatype,
                table.data.data() + n * table.point_step + table.fields[f].offset);
  return table;
}

}  // namespace

RawCloud decodeText(std::string_view content) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (content.substr(0, byte_order_mark.size()) == byte_order_mark)
    content.remove_prefix(byte_order_mark.size());
  if (content.find('\0') != std::string_view::npos)
    throw WorkError(
        "it is neither PCD nor PLY nor LAS nor text; --format kitti or nuscenes reads float32 values");

  RawCloud cloud;
  Lines lines(content);
  const Preamble preamble = readPreamble(lines);
  std::string_view line = preamble.first_line;
  if (line.empty()) return cloud;
  const Comma comma = meaningOfCommas(line, lines);
  const std::vector<Column> columns = columnsOf(preamble, splitValues(line, comma).size(), cloud.remarks);
  std::vector<double> numbers;
  DecimalCommaSuspicion suspicion;
  for (; !line.empty(); line = lines.nextData()) {
    const Values values = splitValues(line, comma);
    if (!decodeLine(line, values, columns, numbers)) failMalformed(lines.number(), line, columns);
    suspicion.look(values);
  }
  if (comma == Comma::SEPARATOR && suspicion.isFounded())
    throw WorkError(
        "its values look like decimal commas that are parted by commas, too: " + quoted(preamble.first_line) +
        "; write them with decimal points or part them by semicolons");
  cloud.table = toTable(columns, numbers);
  return cloud;
}

}  // namespace pcl_fft_ground::cli
