#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/align/segment_alignment.h"
#include "pcl_fft_ground/core/segments/segment.h"

namespace pcl_fft_ground::cli {

/// What a picture of a pair shows.
struct PairImage {
  const core::ScanSegments& reference;
  const core::ScanSegments& moving;
  Eigen::Isometry3d before;  ///< reference_from_moving as guessed
  Eigen::Isometry3d after;   ///< as aligned
  std::vector<core::SegmentMatch> matches;
  std::string result;  ///< title of the second panel
};

/** alignment.png, after the paper's Fig. 5: two scans from above before and after alignment. The reference is
 * blue, its segments turquoise; the moving scan red, its segments yellow; after alignment matched segments
 * are black.
 *
 * \param path of exactly the PNG file to write
 * \throws WorkError naming the file, where it cannot be written
 */
void drawAlignment(const std::filesystem::path& path, const PairImage& image);

}  // namespace pcl_fft_ground::cli
