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
#include <system_error>

#include "errors.h"
#include "io/pcd_header.h"
#include "io/ply_cloud.h"
#include "io/ply_header.h"
#include "io/raw_cloud.h"
#include "io/text_cloud.h"

namespace pcl_fft_ground::cli {
namespace {

namespace fs = std::filesystem;

constexpr int neither_label = 2;

using Coordinates = std::array<std::vector<double>, 3>;

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

RawCloud decode(const std::string& path, const std::string& content) {
  const std::string extension = lowerExtension(path);
  if (looksLikePly(content)) return decodePly(content);
  if (looksLikePcd(content) || extension == ".pcd") return decodePcd(content);
  if (extension == ".ply") return decodePly(content);
  return decodeText(content);
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

/// The median of the finite values, rounded to whole metres, if it is large; else 0.
double axisOrigin(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }),
               values.end());
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return std::abs(*middle) > LARGE_COORDINATE ? std::round(*middle) : 0.0;
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

/// The labels as whole numbers; a field of several values per point is no label.
std::vector<int> toLabels(const pcl::PCLPointCloud2& table) {
  const pcl::PCLPointField* const field = findField(table, "label");
  if (field == nullptr || field->count != 1) return {};
  const std::vector<double> numbers = fieldNumbers(table, *field);
  std::vector<int> labels(numbers.size());
  std::transform(numbers.begin(), numbers.end(), labels.begin(), [](double number) {
    constexpr double limit = std::numeric_limits<int>::max();
    return std::abs(number) <= limit ? static_cast<int>(std::lround(number)) : neither_label;
  });
  return labels;
}

Cloud interpret(const RawCloud& raw) {
  if (pointCount(raw.table) == 0) throw WorkError("it holds no points");
  const Coordinates xyz{coordinate(raw.table, "x"), coordinate(raw.table, "y"), coordinate(raw.table, "z")};
  Cloud cloud;
  cloud.origin = Eigen::Vector3d(axisOrigin(xyz[0]), axisOrigin(xyz[1]), axisOrigin(xyz[2]));
  cloud.viewpoint = raw.viewpoint;
  cloud.viewpoint.position = raw.viewpoint.asTransform() * cloud.origin;
  cloud.points = toPoints(xyz, cloud.origin, raw.table, cloud.viewpoint);
  cloud.fields = withFloatCoordinates(raw.table, *cloud.points);
  cloud.fields.is_dense = cloud.points->is_dense;
  cloud.labels = toLabels(raw.table);
  return cloud;
}

}  // namespace

Cloud readCloud(const std::string& path) {
  try {
    const RawCloud raw = decode(path, readWholeFile(path));
    return interpret(raw);
  } catch (const WorkError& error) {
    throw WorkError("cannot read '" + path + "': " + error.what());
  } catch (const std::bad_alloc&) {
    throw WorkError("cannot read '" + path + "': there is not enough memory for it");
  }
}

}  // namespace pcl_fft_ground::cli
