#include "io/cloud_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <new>
#include <set>
#include <sstream>
#include <system_error>

#include "errors.h"
#include "io/cloud_parts.h"
#include "io/output_file.h"
#include "io/scanner.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"

namespace pcl_fft_ground::cli {
namespace {

namespace fs = std::filesystem;

constexpr int neither_label = 2;

std::string readWholeFile(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw WorkError(error ? error.message() : "there is no such file");
  if (fs::is_directory(status)) throw WorkError("it is a folder");
  if (!fs::is_regular_file(status)) throw WorkError("it is not a regular file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw WorkError(std::strerror(errno));
  const auto size = fs::file_size(path, error);
  if (error) throw WorkError(error.message());
  if (size == 0) throw WorkError("it is empty");
  std::string content(size, '\0');
  stream.read(content.data(), static_cast<std::streamsize>(size));
  if (!stream) throw WorkError("it could not be read to its end");
  return content;
}

std::string lowerExtension(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

std::size_t countNumbers(std::string_view line) {
  std::size_t count = 0;
  for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line), ++count)
    if (!parseNumber<double>(word)) return 0;
  return count;
}

/// Two lines of one number, four of 3 and four of 4: size, pose and its matrix.
bool looksLikePtx(std::string_view content) {
  for (const std::size_t numbers : {1, 1, 3, 3, 3, 3, 4, 4, 4, 4})
    if (content.empty() || countNumbers(takeLine(content)) != numbers) return false;
  return true;
}

/// A line `v` with numbers is the first but for comments, names and materials.
bool looksLikeObj(std::string_view content) {
  while (!content.empty()) {
    std::string_view line = takeLine(content);
    const std::string_view word = takeWord(line);
    if (word == "v" || word == "vn" || word == "vt") return countNumbers(line) >= 2;
    const bool may_precede = word.empty() || word.front() == '#' || word == "o" || word == "g" ||
                             word == "mtllib" || word == "usemtl" || word == "s";
    if (!may_precede) return false;
  }
  return false;
}

/// Text whose characters have two bytes, but no mark in front: every other byte is zero.
bool isWideText(std::string_view content) {
  constexpr std::size_t looked_at = 64;
  const std::string_view begin = content.substr(0, looked_at);
  if (begin.size() < 8) return false;
  for (const std::size_t first : {0U, 1U}) {
    bool wide = true;
    for (std::size_t i = 0; i < begin.size(); ++i) {
      const bool printable = static_cast<unsigned char>(begin[i]) >= 0x20 || isBlank(begin[i]);
      wide = wide && (i % 2 == first ? begin[i] == '\0' : printable && begin[i] != '\0');
    }
    if (wide) return true;
  }
  return false;
}

/// A format that is not read, by how a file of it begins, and what to do instead.
struct ForeignFormat {
  std::string_view begin;
  const char* what;
  const char* way_out;
};

constexpr const char* SAVE_OTHERWISE =
    "export it as LAS, PLY, PCD or text (CloudCompare and most programs of its kind do)";
constexpr const char* UNPACK = "unpack it first";

void refuseForeign(std::string_view content, const std::string& extension) {
  using namespace std::string_view_literals;
  constexpr const char* to_utf_8 = "convert it to UTF-8: iconv -f UTF-16 -t UTF-8 IN.txt > OUT.txt";
  static constexpr std::array<ForeignFormat, 14> formats{
      {{"\x1f\x8b"sv, "compressed by gzip", "unpack it first: gunzip FILE"},
       {"BZh"sv, "compressed by bzip2", "unpack it first: bunzip2 FILE"},
       {"\xfd\x37zXZ"sv, "compressed by xz", "unpack it first: unxz FILE"},
       {"\x28\xb5\x2f\xfd"sv, "compressed by zstd", "unpack it first: unzstd FILE"},
       {"PK\x03\x04"sv, "a zip archive", UNPACK},
       {"7z\xbc\xaf"sv, "a 7z archive", UNPACK},
       {"ASTM-E57"sv, "an E57 file", SAVE_OTHERWISE},
       {"\xff\xfe"sv, "text in UTF-16", to_utf_8},
       {"\xfe\xff"sv, "text in UTF-16", to_utf_8},
       {"\x89HDF"sv, "an HDF5 file", SAVE_OTHERWISE},
       {"\x93NUMPY"sv, "a NumPy array", "write it as text: numpy.savetxt('OUT.txt', array)"},
       {"#ROSBAG"sv, "a ROS bag", "convert it by 'rosrun pcl_ros bag_to_pcd IN.bag TOPIC DIR'"},
       {"glTF"sv, "a glTF model", SAVE_OTHERWISE},
       {"solid "sv, "an STL model", SAVE_OTHERWISE}}};
  const auto refuse = [](const std::string& what, const std::string& way_out) {
    throw WorkError("it is " + what + ", which is not read: " + way_out);
  };
  for (const ForeignFormat& format : formats)
    if (content.substr(0, format.begin.size()) == format.begin) refuse(format.what, format.way_out);
  if (extension == ".ptx" || looksLikePtx(content)) refuse("a PTX file", SAVE_OTHERWISE);
  if (extension == ".obj" || looksLikeObj(content)) refuse("a Wavefront OBJ model", SAVE_OTHERWISE);
  if (extension == ".e57") refuse("an E57 file by its name", SAVE_OTHERWISE);
  if (content.substr(0, 5) == "ncols" || content.substr(0, 5) == "NCOLS")
    refuse("an ESRI ASCII grid, a raster", "make points of it: gdal_translate -of XYZ IN.asc OUT.xyz");
  if (isWideText(content)) refuse("text in UTF-16", to_utf_8);
}

RawCloud decodeAs(CloudFormat format, std::string_view content) {
  switch (format) {
    case CloudFormat::PCD:
      return decodePcd(content);
    case CloudFormat::PLY:
      return decodePly(content);
    case CloudFormat::LAS:
      return decodeLas(content);
    case CloudFormat::KITTI:
    case CloudFormat::NUSCENES:
      return decodeFloats(content, format);
    case CloudFormat::TEXT:
      break;
  }
  return decodeText(content);
}

bool isBin(const std::string& path, std::string_view content) {
  return lowerExtension(path) == ".bin" && !looksLikePly(content) && !looksLikePcd(content);
}

}  // namespace

CloudFormat formatOf(const std::string& path, std::string_view content, const ReadOptions& options) {
  const std::string extension = lowerExtension(path);
  if (!options.format) refuseForeign(content, extension);
  const bool is_bin = isBin(path, content);
  return options.format                                 ? *options.format
         : looksLikePly(content)                        ? CloudFormat::PLY
         : looksLikeLas(content)                        ? CloudFormat::LAS
         : is_bin                                       ? CloudFormat::KITTI
         : looksLikePcd(content) || extension == ".pcd" ? CloudFormat::PCD
         : extension == ".ply"                          ? CloudFormat::PLY
         : extension == ".las" || extension == ".laz"   ? CloudFormat::LAS
                                                        : CloudFormat::TEXT;
}

namespace {

RawCloud decode(const std::string& path, const std::string& content, const ReadOptions& options,
                CloudFormat& format) {
  format = formatOf(path, content, options);
  const bool is_bin = isBin(path, content);
  if (is_bin && !options.format && format == CloudFormat::KITTI) return decodeFloats(content, std::nullopt);
  return decodeAs(format, content);
}

/// Lets the first field that is called X, Y or Z be x, y or z where there is no such one.
void nameCoordinates(pcl::PCLPointCloud2& table) {
  for (const auto& [upper, lower] : {std::pair{"X", "x"}, {"Y", "y"}, {"Z", "z"}})
    if (findField(table, lower) == nullptr) renameField(table, upper, lower);
}

std::vector<double> coordinate(const pcl::PCLPointCloud2& table, const std::string& name) {
  const pcl::PCLPointField* const field = findField(table, name);
  if (field == nullptr) {
    std::string names;
    for (const auto& other : table.fields) names += " " + other.name;
    throw WorkError("it has no field '" + name + "'; its fields are:" + names.substr(0, 200));
  }
  if (field->count != 1) {
    throw WorkError("its field '" + name + "' has " + std::to_string(field->count) +
                    " values for each point, not 1");
  }
  return fieldNumbers(table, *field);
}

/// The table with the first x, y and z replaced by those of `points`; all other fields as they are.
pcl::PCLPointCloud2 withFloatCoordinates(const pcl::PCLPointCloud2& table,
                                         const pcl::PointCloud<pcl::PointXYZ>& points) {
  const std::array<const pcl::PCLPointField*, 3> axes{findField(table, "x"), findField(table, "y"),
                                                      findField(table, "z")};
  pcl::PCLPointCloud2 result;
  for (const auto& field : table.fields) {
    const bool is_axis = std::find(axes.begin(), axes.end(), &field) != axes.end();
    const int type = is_axis ? static_cast<int>(pcl::PCLPointField::FLOAT32) : field.datatype;
    appendField(result, field.name, static_cast<std::uint8_t>(type), field.count);
  }
  allocatePoints(result, table.width, table.height);
  for (std::size_t f = 0; f < table.fields.size(); ++f) {
    const auto axis = std::find(axes.begin(), axes.end(), &table.fields[f]) - axes.begin();
    const std::size_t size = fieldSize(result.fields[f]);
    const std::uint8_t* source = table.data.data() + table.fields[f].offset;
    std::uint8_t* target = result.data.data() + result.fields[f].offset;
    for (const auto& point : points) {
      if (axis < 3) std::memcpy(target, &point.data[axis], sizeof(float));
      if (axis == 3) std::memcpy(target, source, size);
      source += table.point_step;
      target += result.point_step;
    }
  }
  return result;
}

pcl::PointCloud<pcl::PointXYZ>::Ptr toPoints(const Coordinates& xyz, const Eigen::Vector3d& origin,
                                             const pcl::PCLPointCloud2& table, const Viewpoint& viewpoint) {
  auto points = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  points->resize(xyz[0].size());
  points->width = table.width;
  points->height = table.height;
  points->sensor_origin_.head<3>() = viewpoint.position.cast<float>();
  points->sensor_orientation_ = viewpoint.rotation.normalized().cast<float>();
  points->is_dense = true;
  for (std::size_t i = 0; i < points->size(); ++i) {
    auto& point = (*points)[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point.data[axis] = static_cast<float>(xyz[axis][i] - origin[static_cast<Eigen::Index>(axis)]);
      if (!std::isfinite(point.data[axis])) points->is_dense = false;
    }
  }
  return points;
}

/// Makes the points that are not to be used NaN.
void withhold(const std::vector<bool>& withheld, pcl::PointCloud<pcl::PointXYZ>& points) {
  for (std::size_t n = 0; n < withheld.size(); ++n) {
    if (!withheld[n]) continue;
    points[n].getVector3fMap().setConstant(std::numeric_limits<float>::quiet_NaN());
    points.is_dense = false;
  }
}

}  // namespace

std::vector<double> labelNumbers(const RawCloud& raw) {
  const char* const las_field = "classification";
  const pcl::PCLPointField* const field =
      raw.label_scheme == LabelScheme::ASPRS ? findField(raw.table, las_field) : findLabelField(raw.table);
  if (field == nullptr) return {};
  std::vector<double> numbers = fieldNumbers(raw.table, *field);
  for (std::size_t n = 0; n < raw.withheld.size(); ++n)
    if (raw.withheld[n]) numbers[n] = std::numeric_limits<double>::quiet_NaN();
  const bool any = std::any_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v); });
  return any ? numbers : std::vector<double>();
}

namespace {

/// The different numbers, in order, the first ten at most.
std::string listValues(const std::vector<double>& numbers) {
  constexpr std::size_t most_values = 10;
  std::set<double> values;
  for (const double number : numbers)
    if (std::isfinite(number)) values.insert(number);
  std::ostringstream list;
  std::size_t count = 0;
  for (const double value : values) {
    if (count == most_values) break;
    list << (count++ == 0 ? "" : ", ") << value;
  }
  if (values.size() > most_values) list << " ... (" << values.size() << " values)";
  return list.str();
}

/// \return nothing where it is not known what the numbers mean
std::optional<LabelMeaning> meaningOf(const std::vector<double>& numbers, LabelScheme scheme,
                                      bool is_called_label, const ReadOptions& options) {
  const bool asprs = scheme == LabelScheme::ASPRS;
  const std::vector<int> ground = options.ground_classes.value_or(std::vector<int>{asprs ? 2 : 0});
  if (options.ground_classes || options.ignored_classes || asprs) {
    const std::vector<int> ignored =
        options.ignored_classes.value_or(asprs ? std::vector<int>{0, 1, 7, 12, 18} : std::vector<int>{});
    return LabelMeaning{ground, ignored};
  }
  bool has_ground = false, has_2 = false;
  for (const double number : numbers) {
    if (!std::isfinite(number)) continue;
    if (number != 0 && number != 1 && number != 2) return std::nullopt;
    has_ground = has_ground || number == 0;
    has_2 = has_2 || number == 2;
  }
  // Classes 1 and 2 without a 0 are those of LAS by another name more likely: there 2 is the ground.
  if (!is_called_label && has_2 && !has_ground) return std::nullopt;
  return LabelMeaning{ground, {neither_label}};
}

}  // namespace

std::vector<int> labelsBy(const LabelMeaning& meaning, const std::vector<double>& numbers) {
  const auto is_among = [](const std::vector<int>& classes, double number) {
    return std::any_of(classes.begin(), classes.end(), [&](int c) { return c == number; });
  };
  std::vector<int> labels;
  labels.reserve(numbers.size());
  for (const double number : numbers) {
    const bool is_ground = is_among(meaning.ground, number);
    const bool is_neither = !std::isfinite(number) || (!is_ground && is_among(meaning.ignored, number));
    labels.push_back(is_neither ? neither_label : is_ground ? 0 : 1);
  }
  return labels;
}

LabelVerdict judgeLabels(const std::vector<double>& numbers, const RawCloud& raw,
                         const ReadOptions& options) {
  if (numbers.empty()) {
    if (!options.ground_classes && !options.ignored_classes) return {};
    return {std::nullopt, "it has no labels that --ground-classes or --ignore-classes could tell apart"};
  }
  const bool is_called_label = findField(raw.table, "label") != nullptr;
  const auto meaning = meaningOf(numbers, raw.label_scheme, is_called_label, options);
  if (!meaning) {
    return {std::nullopt, "its labels are " + listValues(numbers) + ": no scores, as " +
                              (is_called_label ? "only 0 (ground), 1 (object) and 2 (neither) are known"
                                               : "it is not known which of them are ground") +
                              "; --ground-classes and --ignore-classes tell"};
  }
  const std::vector<int> labels = labelsBy(*meaning, numbers);
  const bool known_ground = std::find(labels.begin(), labels.end(), 0) != labels.end();
  if (options.ground_classes && !known_ground)
    return {std::nullopt,
            "none of its labels, " + listValues(numbers) + ", is among --ground-classes: no scores"};
  return {meaning, ""};
}

Cloud interpretCoordinates(RawCloud raw, const Coordinates& xyz, const Eigen::Vector3d& origin) {
  Cloud cloud;
  cloud.origin = origin;
  cloud.viewpoint = raw.viewpoint;
  cloud.viewpoint.position = raw.viewpoint.asTransform() * cloud.origin;
  cloud.pose_fault = raw.pose_fault;
  cloud.remarks = raw.remarks;
  cloud.crs = raw.crs;
  cloud.is_compressed = raw.is_compressed;
  cloud.points = toPoints(xyz, cloud.origin, raw.table, cloud.viewpoint);
  cloud.fields = withFloatCoordinates(raw.table, *cloud.points);
  withhold(raw.withheld, *cloud.points);
  cloud.fields.is_dense = cloud.points->is_dense;
  return cloud;
}

Coordinates coordinatesOf(RawCloud& raw) {
  nameCoordinates(raw.table);
  return {coordinate(raw.table, "x"), coordinate(raw.table, "y"), coordinate(raw.table, "z")};
}

namespace {

Cloud interpret(RawCloud raw, const ReadOptions& options) {
  if (pointCount(raw.table) == 0) throw WorkError("it holds no points");
  const Coordinates xyz = coordinatesOf(raw);
  const Eigen::Vector3d origin(core::wholeOrigin(xyz[0]), core::wholeOrigin(xyz[1]),
                               core::wholeOrigin(xyz[2]));
  const std::vector<double> numbers = labelNumbers(raw);
  const LabelVerdict verdict = judgeLabels(numbers, raw, options);
  Cloud cloud = interpretCoordinates(std::move(raw), xyz, origin);
  cloud.label_fault = verdict.fault;
  if (verdict.meaning) cloud.labels = labelsBy(*verdict.meaning, numbers);
  return cloud;
}

}  // namespace

Cloud readCloud(const std::string& path, const ReadOptions& options) {
  try {
    CloudFormat format = CloudFormat::PCD;
    RawCloud raw = decode(path, readWholeFile(path), options, format);
    Cloud cloud = interpret(std::move(raw), options);
    cloud.format = format;
    return cloud;
  } catch (const WorkError& error) {
    throw WorkError("cannot read '" + path + "': " + error.what());
  } catch (const std::bad_alloc&) {
    throw WorkError("cannot read '" + path + "': there is not enough memory for it");
  }
}

void writeReclassified(const std::string& path, const std::string& input, const std::vector<int>& classes) {
  try {
    writeText(path, reclassifiedLas(readWholeFile(input), classes));
  } catch (const WorkError& error) {
    const std::string message = error.what();
    throw WorkError(message.find("'" + path + "'") != std::string::npos
                        ? message
                        : "cannot write '" + path + "': of '" + input + "': " + message);
  }
}

bool hasCloudName(const std::string& path) {
  const std::string extension = lowerExtension(path);
  return extension == ".pcd" || extension == ".ply" || extension == ".las" || extension == ".laz";
}

}  // namespace pcl_fft_ground::cli
