#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands/align/alignment_options.h"
#include "io/cloud_file.h"
#include "pcl_fft_ground/segment_icp.h"

namespace pcl_fft_ground::cli {

/// A scan of the pair.
struct InputScan {
  std::string path;
  Cloud cloud;
};

/// Two scans and what came of them.
struct AlignedPair {
  InputScan reference;
  InputScan moving;
  Eigen::Isometry3d guess;       ///< reference_from_moving of the clouds' points
  SegmentICP<Point, Point> icp;  ///< has aligned the clouds' points
};

/// The transform between the coordinates of the two files, origins included.
Eigen::Isometry3d transformOfFiles(const AlignedPair& pair);

/// The content of alignment.json.
nlohmann::ordered_json makeAlignmentReport(const AlignedPair& pair, const AlignmentSettings& settings,
                                           const Segmenter& segmenter);

/** Writes alignment.json and alignment.png and, where the pair was aligned, transform.txt and aligned.pcd;
 * where it was not, those of an earlier run are removed, so that nobody takes them for results. */
void writeAlignment(const std::string& directory, const AlignedPair& pair,
                    const nlohmann::ordered_json& report);

/// The page of HTML that shows what came of the pair; alignment.png is in `directory`.
std::string alignmentPage(const std::string& directory, const AlignedPair& pair,
                          const nlohmann::ordered_json& report);

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
