#pragma once

#include <pcl/console/print.h>
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <cmath>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "commands/commands.h"
#include "io/cloud_fields.h"
#include "io/cloud_file.h"
#include "temporary_folder.h"

namespace pcl_fft_ground::cli {

using Words = std::vector<std::string>;

/// Collects what goes to a C++ stream while it lives.
class StreamText {
 public:
  explicit StreamText(std::ostream& stream) : stream_(stream), original_(stream.rdbuf(text_.rdbuf())) {}
  ~StreamText() { stream_.rdbuf(original_); }
  StreamText(const StreamText&) = delete;
  StreamText& operator=(const StreamText&) = delete;
  std::string str() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::ostream& stream_;
  std::streambuf* original_;
};

/// What a command printed.
struct Printed {
  std::string out;
  std::string err;
};

/// Runs a command with both C++ streams collected; its exceptions pass.
template <typename Command>
Printed run(const Command& command, const Words& words) {
  const StreamText out(std::cout), err(std::cerr);
  command(words);
  return {out.str(), err.str()};
}

/// A scan of 2 m x 2 m with a point in each cell of 0.02 m: a gentle wave and a box, 0.3 m x 0.3 m, 0.2 m
/// high.
inline pcl::PointCloud<pcl::PointXYZL> boxScan() {
  constexpr std::uint32_t SIDE = 100;
  pcl::PointCloud<pcl::PointXYZL> cloud(SIDE, SIDE);
  for (std::uint32_t row = 0; row < SIDE; ++row)
    for (std::uint32_t column = 0; column < SIDE; ++column) {
      const bool is_box = column >= 40 && column < 55 && row >= 60 && row < 75;
      pcl::PointXYZL& p = cloud(column, row);
      p.x = 0.02f * static_cast<float>(column);
      p.y = 0.02f * static_cast<float>(row);
      p.z = 0.02f * std::sin(3.0f * p.x) * std::cos(3.0f * p.y) + (is_box ? 0.2f : 0.0f);
      p.label = is_box ? 1 : 0;
    }
  return cloud;
}

/// A folder for the outputs and a scan to segment; PCL's console is silent, as in the program.
class CommandFixture : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    verbosity_ = pcl::console::getVerbosityLevel();
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  }

  void TearDown() override {
    pcl::console::setVerbosityLevel(verbosity_);
    TemporaryFolder::TearDown();
  }

  template <typename PointT>
  std::string makeCloud(const std::string& name, const pcl::PointCloud<PointT>& cloud) const {
    pcl::PCLPointCloud2 fields;
    pcl::toPCLPointCloud2(cloud, fields);
    const Eigen::Vector4f& position = cloud.sensor_origin_;
    const Eigen::Quaternionf& rotation = cloud.sensor_orientation_;
    writePcd(pathOf(name), fields, {position.head<3>().cast<double>(), rotation.cast<double>()});
    return pathOf(name);
  }

  /// A file of the scan's points without labels.
  std::string makeScan() const {
    pcl::PointCloud<pcl::PointXYZ> points;
    pcl::copyPointCloud(boxScan(), points);
    return makeCloud("scan.pcd", points);
  }

  std::string output() const { return pathOf("out"); }
  std::string outputOf(const std::string& name) const { return (folder_ / "out" / name).string(); }
  bool hasOutput() const { return std::filesystem::exists(output()); }

  /// `segment INPUT -o out` with cells and objects of the sizes that suit the scan.
  Printed segment(const std::string& input, const Words& more = {}) const {
    Words words{input, "-o", output(), "--cell-size", "0.04", "--max-object-size", "0.6"};
    words.insert(words.end(), more.begin(), more.end());
    return run(runSegment, words);
  }

  /// A cloud as PCL itself reads it.
  static pcl::PCLPointCloud2 readByPcl(const std::string& path) {
    pcl::PCLPointCloud2 cloud;
    EXPECT_EQ(pcl::io::loadPCDFile(path, cloud), 0) << path;
    return cloud;
  }

  /// The values of a field as PCL reads them; fails the test if there is no such field.
  static std::vector<double> valuesOf(const pcl::PCLPointCloud2& cloud, const std::string& name) {
    const pcl::PCLPointField* const field = findField(cloud, name);
    EXPECT_NE(field, nullptr) << name;
    return field == nullptr ? std::vector<double>() : fieldNumbers(cloud, *field);
  }

 private:
  pcl::console::VERBOSITY_LEVEL verbosity_ = pcl::console::L_INFO;
};

}  // namespace pcl_fft_ground::cli
