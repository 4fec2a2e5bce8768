#include "commands/survey/survey_folder.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "commands/align/scan_description.h"
#include "errors.h"
#include "io/cloud_file.h"
#include "io/pose_table.h"

namespace pcl_fft_ground::cli {
namespace {

namespace fs = std::filesystem;

std::string truthPath(const std::string& folder) {
  return folder + "/truth.csv";
}

Submap readSubmap(const std::string& path) {
  const Cloud cloud = readCloud(path);
  const core::Points points = usablePoints(path, cloud);
  return {fs::path(path).filename().string(),
          path,
          cloud.origin,
          cloud.viewpoint.asTransform(),
          points.cast<double>().rowwise().mean(),
          coverageOf(path, points)};
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
    truth.push_back(pose->world_from_submap * Eigen::Translation3d(submap.origin));
  }
  return truth;
}

bool isSubmap(const fs::directory_entry& entry) {
  const std::string name = entry.path().filename().string(), ending = entry.path().extension().string();
  std::error_code ignored;  // a link to nowhere is no sub-map
  if ((ending != ".pcd" && ending != ".ply") || name.front() == '.' || !entry.is_regular_file(ignored))
    return false;
  if (name.find_first_of(",\"\n\r") != std::string::npos)
    throw WorkError(entry.path().string() + ": a sub-map's name has no commas, quotes or line breaks");
  return true;
}

std::string fingerprint(const std::string& path) {
  return fs::path(path).filename().string() + " " + std::to_string(fs::file_size(path)) + " " +
         std::to_string(fs::last_write_time(path).time_since_epoch().count());
}

}  // namespace

std::vector<std::string> listSubmaps(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (isSubmap(entry)) paths.push_back(entry.path().string());
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
  survey.truth = truthOf(survey.submaps, truthPath(folder));
  return survey;
}

std::vector<std::string> fingerprintOf(const std::string& folder) {
  std::vector<std::string> prints;
  for (const std::string& path : listSubmaps(folder)) prints.push_back(fingerprint(path));
  std::error_code ignored;
  if (fs::exists(truthPath(folder), ignored)) prints.push_back(fingerprint(truthPath(folder)));
  return prints;
}

}  // namespace pcl_fft_ground::cli
