#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "commands/align/alignment_options.h"
#include "commands/survey/survey_folder.h"
#include "io/cloud_file.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::cli {

/** \brief The sub-maps of a survey as alignment needs them, each read and segmented when it is first asked
 * for.
 *
 * Descriptions, about a megabyte each, are kept; of the clouds only the last few.
 */
class SurveyScans {
 public:
  /// \param segmenters those of the methods that will be asked for, but DENSE_ICP
  SurveyScans(const std::vector<Submap>& submaps, const AlignmentSettings& settings,
              std::vector<Segmenter>& segmenters);

  /// The points of a sub-map; the reference holds until the points or segments of two other
  /// sub-maps are asked for.
  /// \throws WorkError naming the file
  const core::Points& points(std::size_t submap);

  /// The segments that a method finds in a sub-map, with or without WITH_FALLBACK. \throws WorkError naming
  /// the file
  const core::ScanSegments& segments(const std::string& method, std::size_t submap);

 private:
  struct Loaded {
    std::size_t submap;
    Cloud cloud;
    core::Points points;
  };
  const Loaded& load(std::size_t submap);
  core::ScanSegments describe(const std::string& method, std::size_t submap);

  const std::vector<Submap>& submaps_;
  const AlignmentSettings& settings_;
  std::vector<Segmenter>& segmenters_;
  std::deque<std::unique_ptr<Loaded>> loaded_;  ///< the last one asked for in front
  std::map<std::pair<std::string, std::size_t>, core::ScanSegments> segments_;
};

}  // namespace pcl_fft_ground::cli
