#pragma once

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <string>

#include "commands/align/alignment_options.h"
#include "io/cloud_file.h"
#include "pcl_fft_ground/core/align/segment_alignment.h"
#include "pcl_fft_ground/core/segments/segment.h"

namespace pcl_fft_ground::cli {

/// A scan of the pair.
struct AlignedScan {
  std::string path;
  Cloud cloud;
  core::ScanSegments segments;
};

/// Two scans and what came of them.
struct AlignedPair {
  AlignedScan reference;
  AlignedScan moving;
  Eigen::Isometry3d guess;    ///< reference_from_moving of the clouds' points
  core::Alignment alignment;  ///< of the clouds' points
};

/// "segments", "dense" or "none".
const char* nameOf(core::AlignmentMethod method);

/// The transform between the coordinates of the two files, origins included.
Eigen::Isometry3d transformOfFiles(const AlignedPair& pair);

/// The content of alignment.json.
nlohmann::ordered_json makeAlignmentReport(const AlignedPair& pair, const AlignmentSettings& settings,
                                           const Segmenter& segmenter);

/** Writes alignment.json and alignment.png and, where the pair was aligned, transform.txt and aligned.pcd;
 * where it was not, those of an earlier run are removed, so that nobody takes them for results. */
void writeAlignment(const std::string& directory, const AlignedPair& pair,
                    const nlohmann::ordered_json& report);

}  // namespace pcl_fft_ground::cli
