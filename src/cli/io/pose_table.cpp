#include "io/pose_table.h"

#include <array>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "errors.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr const char* HEADER = "submap,x,y,z,qx,qy,qz,qw";

NamedPose parsePose(const std::string& line, const std::string& place) {
  std::istringstream fields(line);
  NamedPose pose;
  std::getline(fields, pose.submap, ',');
  std::array<double, 7> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    char comma = ',';
    if ((i > 0 && !(fields >> comma)) || comma != ',' || !(fields >> numbers[i]))
      throw WorkError(place + ": '" + line + "' is no line of " + HEADER);
  }
  const Eigen::Quaterniond rotation(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (!(rotation.norm() > 0.5)) throw WorkError(place + ": '" + line + "' has no unit quaternion");
  pose.world_from_submap = Eigen::Translation3d(numbers[0], numbers[1], numbers[2]) * rotation.normalized();
  return pose;
}

}  // namespace

std::string asCsv(const std::vector<NamedPose>& poses) {
  std::ostringstream csv;
  csv << HEADER << '\n' << std::setprecision(12);
  for (const NamedPose& pose : poses) {
    const Eigen::Vector3d t = pose.world_from_submap.translation();
    const Eigen::Quaterniond q(pose.world_from_submap.linear());
    csv << pose.submap << ',' << t.x() << ',' << t.y() << ',' << t.z() << ',' << q.x() << ',' << q.y() << ','
        << q.z() << ',' << q.w() << '\n';
  }
  return csv.str();
}

std::vector<NamedPose> readPoses(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw WorkError(path + ": cannot be read");
  std::string line;
  const auto readLine = [&] {
    if (!std::getline(file, line)) return false;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return true;
  };
  readLine();
  if (line != HEADER) throw WorkError(path + ": its first line is not " + HEADER);
  std::vector<NamedPose> poses;
  for (std::size_t number = 2; readLine(); ++number)
    if (!line.empty()) poses.push_back(parsePose(line, path + ", line " + std::to_string(number)));
  return poses;
}

}  // namespace pcl_fft_ground::cli
