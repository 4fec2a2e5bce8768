#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "commands/align/alignment_options.h"
#include "io/cloud_file.h"
#include "pcl_fft_ground/core/survey/survey.h"

namespace pcl_fft_ground::cli {

/// The name under which dense point-to-plane ICP of whole clouds stands among the methods.
constexpr const char* DENSE_ICP = "dense-icp";

/// What is appended to the name of a method where dense ICP of the overlap steps in for missing segments.
constexpr const char* WITH_FALLBACK = "+dense";

/// The method that segments for this one: without WITH_FALLBACK.
std::string segmenterOf(const std::string& method);

/// A sub-map of a survey, without its points.
struct Submap {
  std::string name;        ///< of its file, without the folder
  std::string path;        ///< of its file
  Eigen::Vector3d origin;  ///< subtracted from the coordinates of its file [m]
  double voxel_size = 0;   ///< that suits its points [m]
};

/// A file that is no sub-map after all.
struct LeftOut {
  std::string name;    ///< of the file, without the folder
  std::string reason;  ///< in a sentence that names the file
};

/// What a user should know of how a file was read.
struct FileRemark {
  std::string path;  ///< of the file
  std::string remark;
};

/// A folder of sub-maps.
struct SurveyFolder {
  std::vector<Submap> submaps;           ///< in the order of their names
  std::vector<core::SurveyScan> scans;   ///< likewise; of the points less their origins
  std::vector<Eigen::Isometry3d> truth;  ///< likewise, if truth.csv gives them: one per sub-map, or empty
  std::vector<LeftOut> left_out;         ///< what cannot be read or holds no finite point
  std::vector<FileRemark> remarks;       ///< what there is to say of how its files were read
};

/// The clouds (*.pcd, *.ply, *.las, in any case) in a folder, in the order of their names.
/// \throws WorkError naming the folder, if it cannot be read or holds fewer than two, or the cloud whose name
///         would break a table
std::vector<std::string> listSubmaps(const std::string& folder);

/** Reads all sub-maps of a folder once, one at a time.
 * \param sigmas how far their poses by navigation are trusted
 * \param report called with the number of each sub-map before it is read
 * \throws WorkError naming the folder if fewer than two can be used, or a truth.csv that does not fit them
 */
SurveyFolder readSurvey(const std::string& folder, const core::NavigationSigmas& sigmas,
                        const std::function<void(std::size_t)>& report);

/// Names, sizes and times of the files of a folder's sub-maps and of their truth: changes when one of them
/// does.
std::vector<std::string> fingerprintOf(const std::string& folder);

/// A sub-map as alignment sees it.
struct SubmapDescription {
  core::ScanSegments segments;
  std::string error;  ///< why the method cannot work on it; empty if it can
};

/** \brief The sub-maps of a survey as alignment needs them, each read and segmented when it is first asked
 * for.
 *
 * Descriptions, about a megabyte each, are kept; of the clouds only the last few.
 */
class SurveyScans {
 public:
  /// Keeps references. \param segmenters those of the methods that will be asked for, but DENSE_ICP
  SurveyScans(const std::vector<Submap>& submaps, const AlignmentSettings& settings,
              std::vector<Segmenter>& segmenters);

  /// The points of a sub-map that are of use. Threads may ask at the same time.
  /// \throws WorkError naming the file
  std::shared_ptr<const core::Points> points(std::size_t submap);

  /// What a method finds in a sub-map, with or without WITH_FALLBACK. \throws WorkError naming the file that
  /// cannot be read
  const SubmapDescription& describe(const std::string& method, std::size_t submap);

  /// The same of what has been described. Threads may ask at the same time.
  const SubmapDescription& described(const std::string& method, std::size_t submap) const {
    return descriptions_.at({segmenterOf(method), submap});
  }

 private:
  struct Loaded {
    std::size_t submap;
    Cloud cloud;
    core::Points points;
  };
  std::shared_ptr<const Loaded> load(std::size_t submap);
  SubmapDescription describeAnew(const std::string& segmenter, std::size_t submap);

  const std::vector<Submap>& submaps_;
  const AlignmentSettings& settings_;
  std::vector<Segmenter>& segmenters_;
  std::mutex mutex_;                            // of what follows
  std::deque<std::shared_ptr<Loaded>> loaded_;  ///< the last one asked for in front
  std::map<std::pair<std::string, std::size_t>, SubmapDescription> descriptions_;
};

}  // namespace pcl_fft_ground::cli
