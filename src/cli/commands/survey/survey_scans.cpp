#include "commands/survey/survey_scans.h"

#include <algorithm>
#include <stdexcept>

#include "commands/align/scan_description.h"
#include "commands/survey/survey_pair.h"

namespace pcl_fft_ground::cli {

SurveyScans::SurveyScans(const std::vector<Submap>& submaps, const AlignmentSettings& settings,
                         std::vector<Segmenter>& segmenters)
    : submaps_(submaps), settings_(settings), segmenters_(segmenters) {}

const SurveyScans::Loaded& SurveyScans::load(std::size_t submap) {
  constexpr std::size_t MOST_LOADED = 3;
  const auto found = std::find_if(loaded_.begin(), loaded_.end(),
                                  [&](const auto& loaded) { return loaded->submap == submap; });
  std::unique_ptr<Loaded> wanted;
  if (found != loaded_.end()) {
    wanted = std::move(*found);
    loaded_.erase(found);
  } else {
    const std::string& path = submaps_[submap].path;
    Cloud cloud = readCloud(path);
    core::Points points = usablePoints(path, cloud);
    wanted = std::make_unique<Loaded>(Loaded{submap, std::move(cloud), std::move(points)});
  }
  loaded_.push_front(std::move(wanted));
  if (loaded_.size() > MOST_LOADED) loaded_.pop_back();
  return *loaded_.front();
}

const core::Points& SurveyScans::points(std::size_t submap) {
  return load(submap).points;
}

const core::ScanSegments& SurveyScans::segments(const std::string& method, std::size_t submap) {
  const auto key = std::make_pair(segmenterOf(method), submap);
  const auto known = segments_.find(key);
  if (known != segments_.end()) return known->second;
  return segments_.emplace(key, describe(key.first, submap)).first->second;
}

core::ScanSegments SurveyScans::describe(const std::string& method, std::size_t submap) {
  const Loaded& loaded = load(submap);
  const std::string& path = submaps_[submap].path;
  if (method == DENSE_ICP) return describeAsGround(path, loaded.points, settings_.segments);
  const auto segmenter = std::find_if(segmenters_.begin(), segmenters_.end(),
                                      [&](const Segmenter& s) { return s.method == method; });
  if (segmenter == segmenters_.end()) throw std::invalid_argument("no segmenter for method " + method);
  return describeCloud(path, loaded.cloud, *segmenter, settings_.segments);
}

}  // namespace pcl_fft_ground::cli
