#pragma once

#include <functional>
#include <string>

#include "commands/survey/survey_poses.h"

namespace pcl_fft_ground::cli {

/// Voxels of 2 cm that all sub-maps together occupy: the fewer, the crisper the whole.
struct SiteCrispness {
  std::size_t navigation = 0;
  std::size_t chained = 0;
  std::size_t global = 0;
};

/** Writes merged.pcd, all sub-maps as the global alignment places them (a point per cubic centimetre, with
 * the number of its sub-map), and the pictures site_before.png and site_after.png.
 *
 * Where the coordinates are large merged.pcd is relative to whole metres, which its VIEWPOINT gives.
 * The sub-maps are read once more, one at a time.
 *
 * \param report called with the number of each sub-map before it is read
 * \throws WorkError naming the file that cannot be read or written
 */
SiteCrispness writeSiteMap(const std::string& folder, const SurveyFolder& survey, const SurveyPoses& poses,
                           const std::function<void(std::size_t)>& report);

}  // namespace pcl_fft_ground::cli
