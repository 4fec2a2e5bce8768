#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/align/scan_coverage.h"

namespace pcl_fft_ground::cli {

/// A sub-map of a survey, without its points.
struct Submap {
  std::string name;              ///< of its file, without the folder
  std::string path;              ///< of its file
  Eigen::Vector3d origin;        ///< subtracted from the coordinates of its file [m]
  Eigen::Isometry3d navigation;  ///< maps its points, less the origin, to the world
  Eigen::Vector3d centroid;      ///< of its points, less the origin [m]
  core::ScanCoverage coverage;   ///< of its points, less the origin
};

/// A folder of sub-maps.
struct SurveyFolder {
  std::vector<Submap> submaps;           ///< in the order of their names
  std::vector<Eigen::Isometry3d> truth;  ///< likewise, if truth.csv gives them: one per sub-map, or empty
};

/// The clouds (*.pcd, *.ply) in a folder, in the order of their names.
/// \throws WorkError naming the folder, if it cannot be read or holds fewer than two, or the cloud whose name
///         would break a table
std::vector<std::string> listSubmaps(const std::string& folder);

/** Reads all sub-maps of a folder once, one at a time.
 * \param report called with the number of each sub-map before it is read
 * \throws WorkError naming the file that cannot be read */
SurveyFolder readSurvey(const std::string& folder, const std::function<void(std::size_t)>& report);

/// Names, sizes and times of the files of a folder's sub-maps and of their truth: changes when one of them
/// does.
std::vector<std::string> fingerprintOf(const std::string& folder);

}  // namespace pcl_fft_ground::cli
