#include "survey/survey_folder.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "align/scan_description.h"
#include "errors.h"
#include "io/cloud_file.h"
#include "io/pose_table.h"
#include "pcl_fft_ground/core/segment.h"

namespace pcl_fft_ground::cli {
namespace {

namespace fs = std::filesystem;

constexpr double CELLS_PER_VOXEL = 2.5;  // of the coverage, as in the description of a scan

Submap readSubmap(const std::string& path) {
  const Cloud cloud = readCloud(path);
  const core::Points points = finitePoints(path, cloud);
  const double cell_size = CELLS_PER_VOXEL * core::voxelSizeFor(points);
  return {fs::path(path).filename().string(), path, worldFromPoints(cloud),
          points.cast<double>().rowwise().mean(), core::coverageOf(points, cell_size)};
}

/// The true pose of every sub-map; empty if the table does not name them all.
std::vector<Eigen::Isometry3d> truthOf(const std::vector<Submap>& submaps, const std::string& path) {
  std::vector<Eigen::Isometry3d> truth;
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return truth;
  const std::vector<NamedPose> poses = readPoses(path);
  for (const Submap& submap : submaps) {
    const auto pose =
        std::find_if(poses.begin(), poses.end(), [&](const NamedPose& p) { return p.submap == submap.name; });
    if (pose == poses.end()) throw WorkError(path + ": has no pose of '" + submap.name + "'");
    truth.push_back(pose->world_from_submap);
  }
  return truth;
}

}  // namespace

std::vector<std::string> listSubmaps(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string ending = entry.path().extension().string();
    if (entry.is_regular_file(error) && (ending == ".pcd" || ending == ".ply") &&
        entry.path().filename().string().front() != '.')
      paths.push_back(entry.path().string());
  }
  if (error) throw WorkError(folder + ": " + error.message());
  if (paths.size() < 2)
    throw WorkError(folder + ": has " + std::to_string(paths.size()) +
                    " sub-maps (*.pcd, *.ply); a survey needs at least 2");
  std::sort(paths.begin(), paths.end());
  return paths;
}

SurveyFolder readSurvey(const std::string& folder, const std::function<void(std::size_t)>& report) {
  SurveyFolder survey;
  for (const std::string& path : listSubmaps(folder)) {
    report(survey.submaps.size() + 1);
    survey.submaps.push_back(readSubmap(path));
  }
  survey.truth = truthOf(survey.submaps, folder + "/truth.csv");
  return survey;
}

std::vector<std::string> fingerprintOf(const std::string& folder) {
  std::vector<std::string> prints;
  for (const std::string& path : listSubmaps(folder)) {
    const auto time = fs::last_write_time(path).time_since_epoch().count();
    prints.push_back(fs::path(path).filename().string() + " " + std::to_string(fs::file_size(path)) + " " +
                     std::to_string(time));
  }
  return prints;
}

}  // namespace pcl_fft_ground::cli
