#pragma once

#include <pcl/io/pcd_io.h>

#include <array>
#include <cstring>
#include <limits>

#include "errors.h"
#include "io/cloud_file.h"
#include "temporary_folder.h"

namespace pcl_fft_ground::cli {

inline constexpr float nan = std::numeric_limits<float>::quiet_NaN();

class CloudFile : public TemporaryFolder {
 protected:
  /// The one-line WorkError, naming the file, that reading it must end in.
  static std::string errorOf(const std::string& path) {
    try {
      readCloud(path);
    } catch (const WorkError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("'" + path + "'"), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      return message;
    }
    ADD_FAILURE() << path << " was read";
    return {};
  }

  void expectError(const std::string& name, std::string_view content, const std::string& words) const {
    SCOPED_TRACE(name);
    const std::string message = errorOf(makeFile(name, content));
    EXPECT_NE(message.find(words), std::string::npos) << message;
  }
};

/// A small organised labelled cloud with a NaN, as a filter of PCL would hand it on.
inline pcl::PointCloud<pcl::PointXYZL> labelledCloud() {
  pcl::PointCloud<pcl::PointXYZL> cloud(3, 2);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto value = static_cast<float>(i);
    cloud[i].getVector3fMap() = Eigen::Vector3f(0.1f * value, -1.5f * value, 3.0f + value);
    cloud[i].label = static_cast<std::uint32_t>(i % 3);
  }
  cloud[4].y = nan;
  cloud.is_dense = false;
  return cloud;
}

/// x, y, z FLOAT64 with this many points a few centimetres apart around a UTM position.
inline pcl::PCLPointCloud2 utmCloud(std::size_t points) {
  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z"}) appendField(cloud, name, pcl::PCLPointField::FLOAT64, 1);
  allocatePoints(cloud, points, 1);
  for (std::size_t i = 0; i < points; ++i) {
    const auto step = static_cast<double>(i);
    const std::array<double, 3> xyz{499999.5 + 0.01 * step, 5412345.25 - 0.02 * step, -30.0 + 0.001 * step};
    std::memcpy(cloud.data.data() + i * cloud.point_step, xyz.data(), sizeof xyz);
  }
  return cloud;
}

inline void expectUtmCloud(const Cloud& cloud, std::size_t points, double tolerance) {
  ASSERT_EQ(cloud.points->size(), points);
  EXPECT_EQ(cloud.origin, cloud.origin.array().round().matrix());
  EXPECT_NEAR(cloud.origin.x(), 499999.5, 10.0);
  EXPECT_NEAR(cloud.origin.y(), 5412345.25, 10.0);
  EXPECT_EQ(cloud.origin.z(), 0.0);
  for (std::size_t i = 0; i < points; ++i) {
    const Eigen::Vector3d xyz = (*cloud.points)[i].getVector3fMap().cast<double>() + cloud.origin;
    const auto step = static_cast<double>(i);
    EXPECT_NEAR(xyz.x(), 499999.5 + 0.01 * step, tolerance);
    EXPECT_NEAR(xyz.y(), 5412345.25 - 0.02 * step, tolerance);
    EXPECT_NEAR(xyz.z(), -30.0 + 0.001 * step, tolerance);
  }
}

inline std::vector<float> floatsOf(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  const pcl::PCLPointField* const field = findField(cloud, name);
  EXPECT_NE(field, nullptr) << name;
  if (field == nullptr) return {};
  const std::vector<double> numbers = fieldNumbers(cloud, *field);
  return {numbers.begin(), numbers.end()};
}

inline std::string asciiPcd(const std::string& header, const std::string& body) {
  return "# .PCD v0.7\nVERSION 0.7\n" + header + "DATA ascii\n" + body;
}

inline const std::string xyz_header = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";

inline std::string extent(const std::string& width, const std::string& height, const std::string& points) {
  return "WIDTH " + width + "\nHEIGHT " + height + "\nPOINTS " + points + "\n";
}

/// The three kinds of PCD, as PCL writes them.
enum class Kind { ASCII, BINARY, COMPRESSED };

inline void writeByPcl(const std::string& path, const pcl::PCLPointCloud2& cloud, Kind kind) {
  const Eigen::Vector4f position(1.5f, -2.25f, 3.0f, 0.0f);
  const Eigen::Quaternionf rotation(0.5f, 0.5f, -0.5f, 0.5f);
  pcl::PCDWriter writer;
  switch (kind) {
    case Kind::ASCII:
      ASSERT_EQ(writer.writeASCII(path, cloud, position, rotation, 12), 0);
      break;
    case Kind::BINARY:
      ASSERT_EQ(writer.writeBinary(path, cloud, position, rotation), 0);
      break;
    case Kind::COMPRESSED:
      ASSERT_EQ(writer.writeBinaryCompressed(path, cloud, position, rotation), 0);
      break;
  }
}

}  // namespace pcl_fft_ground::cli
