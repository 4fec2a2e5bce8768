#include "commands/survey/survey_scans.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "errors.h"
#include "io/pose_table.h"
#include "methods/segmentation.h"
#include "pcl_fft_ground/scan_describer.h"

namespace pcl_fft_ground::cli {
namespace {

namespace fs = std::filesystem;

std::string truthPath(const std::string& folder) {
  return folder + "/truth.csv";
}

/// \return why its VIEWPOINT is no pose; empty if it is one
/// \throws std::exception if the file is no sub-map
std::string addSubmap(const std::string& path, const core::NavigationSigmas& sigmas, SurveyFolder& survey) {
  const Cloud cloud = readCloud(path);
  const core::Points points = usablePoints(*cloud.points).points;
  if (points.cols() == 0) throw WorkError(path + ": none of its points is finite; at least one has to be");
  for (const std::string& remark : cloud.remarks) survey.remarks.push_back({path, remark});
  core::SurveyScan scan = core::surveyScan(points, cloud.viewpoint.asTransform(), sigmas);
  survey.scans.push_back(std::move(scan));
  survey.submaps.push_back(
      {fs::path(path).filename().string(), path, cloud.origin, core::voxelSizeFor(points)});
  return cloud.pose_fault;
}

/// Adds a sub-map or says why the file is none.
/// \throws WorkError naming the file if its VIEWPOINT is no pose: navigation is at fault then, not a scan
void addOrLeaveOut(const std::string& path, const core::NavigationSigmas& sigmas, SurveyFolder& survey) {
  std::string pose_fault;
  try {
    pose_fault = addSubmap(path, sigmas, survey);
  } catch (const WorkError& error) {
    survey.left_out.push_back({fs::path(path).filename().string(), error.what()});
  } catch (const std::logic_error& error) {  // of the core: points that are spread too widely
    survey.left_out.push_back({fs::path(path).filename().string(), path + ": " + error.what()});
  }
  if (!pose_fault.empty()) throw WorkError(path + ": " + pose_fault);
}

/// The true pose of every sub-map; empty if there is no table.
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
  const std::string name = entry.path().filename().string();
  std::error_code ignored;  // a link to nowhere is no sub-map
  if (!hasCloudName(name) || name.front() == '.' || !entry.is_regular_file(ignored)) return false;
  if (name.find_first_of(",\"\n\r") != std::string::npos)
    throw WorkError(entry.path().string() + ": a sub-map's name has no commas, quotes or line breaks");
  return true;
}

std::string fingerprint(const std::string& path) {
  return fs::path(path).filename().string() + " " + std::to_string(fs::file_size(path)) + " " +
         std::to_string(fs::last_write_time(path).time_since_epoch().count());
}

}  // namespace

std::string segmenterOf(const std::string& method) {
  const std::string suffix = WITH_FALLBACK;
  const bool has_suffix = method.size() > suffix.size() &&
                          method.compare(method.size() - suffix.size(), suffix.size(), suffix) == 0;
  return has_suffix ? method.substr(0, method.size() - suffix.size()) : method;
}

std::vector<std::string> listSubmaps(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (isSubmap(entry)) paths.push_back(entry.path().string());
  if (error) throw WorkError(folder + ": " + error.message());
  if (paths.size() < 2)
    throw WorkError(folder + ": has " + std::to_string(paths.size()) +
                    " sub-maps (*.pcd, *.ply, *.las); a survey needs at least 2");
  std::sort(paths.begin(), paths.end());
  return paths;
}

SurveyFolder readSurvey(const std::string& folder, const core::NavigationSigmas& sigmas,
                        const std::function<void(std::size_t)>& report) {
  SurveyFolder survey;
  for (const std::string& path : listSubmaps(folder)) {
    report(survey.submaps.size() + survey.left_out.size() + 1);
    addOrLeaveOut(path, sigmas, survey);
  }
  if (survey.submaps.size() < 2)
    throw WorkError(folder + ": " + std::to_string(survey.submaps.size()) +
                    " of its sub-maps can be used, a survey needs at least 2; " +
                    survey.left_out.front().reason);
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

SurveyScans::SurveyScans(const std::vector<Submap>& submaps, const AlignmentSettings& settings,
                         std::vector<Segmenter>& segmenters)
    : submaps_(submaps), settings_(settings), segmenters_(segmenters) {}

std::shared_ptr<const SurveyScans::Loaded> SurveyScans::load(std::size_t submap) {
  const std::lock_guard<std::mutex> lock(mutex_);
  constexpr std::size_t MOST_LOADED = 3;
  const auto found = std::find_if(loaded_.begin(), loaded_.end(),
                                  [&](const auto& loaded) { return loaded->submap == submap; });
  std::shared_ptr<Loaded> wanted;
  if (found != loaded_.end()) {
    wanted = std::move(*found);
    loaded_.erase(found);
  } else {
    Cloud cloud = readCloud(submaps_[submap].path);
    core::Points points = usablePoints(*cloud.points).points;
    wanted = std::make_shared<Loaded>(Loaded{submap, std::move(cloud), std::move(points)});
  }
  loaded_.push_front(std::move(wanted));
  if (loaded_.size() > MOST_LOADED) loaded_.pop_back();
  return loaded_.front();
}

std::shared_ptr<const core::Points> SurveyScans::points(std::size_t submap) {
  const std::shared_ptr<const Loaded> loaded = load(submap);
  return {loaded, &loaded->points};
}

const SubmapDescription& SurveyScans::describe(const std::string& method, std::size_t submap) {
  const auto key = std::make_pair(segmenterOf(method), submap);
  const auto known = descriptions_.find(key);
  if (known != descriptions_.end()) return known->second;
  return descriptions_.emplace(key, describeAnew(key.first, submap)).first->second;
}

SubmapDescription SurveyScans::describeAnew(const std::string& segmenter, std::size_t submap) {
  const std::shared_ptr<const Loaded> loaded = load(submap);
  ScanDescriber<Point> describer;
  describer.setSegmentParameters(settings_.segments);
  if (segmenter == DENSE_ICP) return {describer.describeAsGround(loaded->cloud.points), describer.getError()};
  const auto found = std::find_if(segmenters_.begin(), segmenters_.end(),
                                  [&](const Segmenter& s) { return s.method == segmenter; });
  if (found == segmenters_.end()) throw std::invalid_argument("no segmenter for method " + segmenter);
  describer.setGroundSegmentation(found->filter);
  if (found->sensor) describer.setSensorPosition(*found->sensor - loaded->cloud.origin);
  core::ScanSegments segments = describer.describe(loaded->cloud.points);
  return {std::move(segments), describer.getError()};
}

}  // namespace pcl_fft_ground::cli
