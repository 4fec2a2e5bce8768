#include "commands/simulate/simulated_scan.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "io/cloud_fields.h"
#include "io/cloud_file.h"

namespace pcl_fft_ground::cli {
namespace {

/// "tilt_degrees = 90: ..." becomes "--tilt = 90: ...".
std::string asOption(const std::string& message) {
  const std::size_t end = message.find(' ');
  std::string name = message.substr(0, end);
  if (name == "tilt_degrees") name = "tilt";
  std::replace(name.begin(), name.end(), '_', '-');
  return "--" + name + message.substr(end);
}

pcl::PCLPointCloud2 asCloud(const core::SimulatedScan& scan) {
  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z"}) appendField(cloud, name, pcl::PCLPointField::FLOAT32, 1);
  allocatePoints(cloud, scan.labels.size(), 1);
  for (std::size_t i = 0; i < scan.labels.size(); ++i) {
    const Eigen::Vector3f point = scan.points.col(static_cast<Eigen::Index>(i));
    std::memcpy(cloud.data.data() + i * cloud.point_step, point.data(), sizeof(float) * 3);
  }
  setInt32Field(cloud, "label", scan.labels);
  setInt32Field(cloud, "segment", scan.segments);
  return cloud;
}

}  // namespace

void withOptionNames(const std::function<void()>& simulate) {
  try {
    simulate();
  } catch (const std::invalid_argument& error) {
    throw UsageError(asOption(error.what()));
  }
}

void writeSimulatedScan(const std::string& path, const core::SimulatedScan& scan,
                        const Eigen::Isometry3d& viewpoint, GroundHeights heights) {
  pcl::PCLPointCloud2 cloud = asCloud(scan);
  if (heights == GroundHeights::WRITE) setFloatField(cloud, "ground", scan.ground_heights);
  writePcd(path, cloud, {viewpoint.translation(), Eigen::Quaterniond(viewpoint.linear())});
}

}  // namespace pcl_fft_ground::cli
