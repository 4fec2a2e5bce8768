#include "commands/align/align_report.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <system_error>

#include "io/cloud_fields.h"
#include "io/cloud_file.h"
#include "io/output_file.h"
#include "methods/segmentation.h"
#include "pcl_fft_ground/core/align/crispness.h"
#include "pcl_fft_ground/version.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::ordered_json;

/// The centroids of matched segments, in the coordinates of the files.
ordered_json matchesOf(const AlignedPair& pair) {
  const auto place = [](const core::ScanSegments& scan, std::size_t segment, const Cloud& cloud) {
    return asList(scan.segments[segment].centroid + cloud.origin);
  };
  ordered_json matches = ordered_json::array();
  for (const core::SegmentMatch& match : pair.icp.getMatches())
    matches.push_back({{"reference", place(pair.icp.getTargetScan(), match.reference, pair.reference.cloud)},
                       {"moving", place(pair.icp.getSourceScan(), match.moving, pair.moving.cloud)}});
  return matches;
}

/// What there is to say about the two files, each line with the file's name.
std::vector<std::string> warningsOf(const AlignedPair& pair) {
  std::vector<std::string> warnings;
  for (const InputScan* scan : {&pair.reference, &pair.moving})
    for (const std::string& remark : scan->cloud.remarks) warnings.push_back(scan->path + ": " + remark);
  return warnings;
}

ordered_json crispnessOf(const AlignedPair& pair) {
  const core::Points reference = usablePoints(*pair.reference.cloud.points).points;
  const core::Points moving = usablePoints(*pair.moving.cloud.points).points;
  const Eigen::Isometry3d& after = pair.icp.getAlignment().reference_from_moving;
  const std::size_t nx_before = core::occupiedVoxels(moving, reference, pair.guess);
  const std::size_t nx_after = core::occupiedVoxels(moving, reference, after);
  return {{"nx_before", nx_before},
          {"nx_after", nx_after},
          {"delta_nx_percent", core::crispnessChange(nx_before, nx_after)},
          {"overlap_before", orNull(core::overlapCrispness(moving, reference, pair.guess))},
          {"overlap_after", orNull(core::overlapCrispness(moving, reference, after))}};
}

/// The moving cloud with all its fields, placed in the coordinates of the reference's file, less its origin.
pcl::PCLPointCloud2 alignedCloud(const AlignedPair& pair) {
  const Eigen::Isometry3d& target_from_source = pair.icp.getAlignment().reference_from_moving;
  pcl::PCLPointCloud2 cloud = pair.moving.cloud.fields;
  for (std::size_t n = 0; n < pair.moving.cloud.points->size(); ++n) {
    const Eigen::Vector3d point = (*pair.moving.cloud.points)[n].getVector3fMap().cast<double>();
    const Eigen::Vector3f placed = (target_from_source * point).cast<float>();
    const char* const axes[] = {"x", "y", "z"};
    for (int axis = 0; axis < 3; ++axis)
      std::memcpy(cloud.data.data() + n * cloud.point_step + findField(cloud, axes[axis])->offset,
                  &placed[axis], sizeof(float));
  }
  return cloud;
}

std::string matrixText(const Eigen::Isometry3d& transform) {
  std::ostringstream text;
  text << std::setprecision(12);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) text << transform.matrix()(i, j) << (j < 3 ? ' ' : '\n');
  return text.str();
}

std::string panelTitle(const AlignedPair& pair, const ordered_json& report) {
  if (!pair.icp.getAlignment().accepted) return "Not aligned";
  return "After alignment: " + std::to_string(pair.icp.getMatches().size()) + " matches, Nx " +
         fixedNumber(report["crispness"]["delta_nx_percent"].get<double>(), 2) + " %";
}

}  // namespace

Eigen::Isometry3d transformOfFiles(const AlignedPair& pair) {
  return Eigen::Translation3d(pair.reference.cloud.origin) * pair.icp.getAlignment().reference_from_moving *
         Eigen::Translation3d(-pair.moving.cloud.origin);
}

ordered_json makeAlignmentReport(const AlignedPair& pair, const AlignmentSettings& settings,
                                 const Segmenter& segmenter) {
  const core::Alignment& alignment = pair.icp.getAlignment();
  const core::ScanSegments &reference = pair.icp.getTargetScan(), &moving = pair.icp.getSourceScan();
  ordered_json report{
      {"version", PCL_FFT_GROUND_VERSION},
      {"reference", pair.reference.path},
      {"moving", pair.moving.path},
      {"accepted", alignment.accepted},
      {"refusal", alignment.refusal},
      {"method", nameOf(alignment.method)},
      {"reference_from_moving", asRows(transformOfFiles(pair).matrix())},
      {"origin", asList(pair.reference.cloud.origin)},
      {"covariance", asRows(alignment.covariance)},
      {"score", alignment.score},
      {"overlap", alignment.overlap},
      {"segments", {{"reference", reference.segments.size()}, {"moving", moving.segments.size()}}},
      {"voxel_size", std::max(reference.voxel_size, moving.voxel_size)},
      {"matches", matchesOf(pair)},
      {"crispness", crispnessOf(pair)},
      {"warnings", warningsOf(pair)}};
  report["parameters"] = settings.described;
  report["parameters"]["max-sigma"] =
      core::largestSigma(settings.alignment, std::max(reference.voxel_size, moving.voxel_size));
  report["segmentation"] = {{"method", segmenter.method}, {"parameters", segmenter.parameters}};
  return report;
}

void writeAlignment(const std::string& directory, const AlignedPair& pair, const ordered_json& report) {
  const PairImage image{pair.icp.getTargetScan(),
                        pair.icp.getSourceScan(),
                        pair.guess,
                        pair.icp.getAlignment().reference_from_moving,
                        pair.icp.getMatches(),
                        panelTitle(pair, report)};
  writeWhole(directory + "/alignment.png", [&](const std::string& path) { drawAlignment(path, image); });
  if (pair.icp.getAlignment().accepted) {
    writeText(directory + "/transform.txt", matrixText(transformOfFiles(pair)));
    writePcd(directory + "/aligned.pcd", alignedCloud(pair), pair.reference.cloud.viewpoint);
  } else {
    std::error_code ignored;
    for (const char* name : {"/transform.txt", "/aligned.pcd"})
      std::filesystem::remove(directory + name, ignored);
  }
  writeText(directory + "/alignment.json", asText(report));
}

}  // namespace pcl_fft_ground::cli
