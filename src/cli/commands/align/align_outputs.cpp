#include "commands/align/align_outputs.h"

#include <cstring>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <system_error>

#include "commands/align/alignment_picture.h"
#include "commands/align/scan_description.h"
#include "commands/segment/segment_report.h"
#include "io/cloud_fields.h"
#include "io/output_file.h"
#include "io/pcd_cloud.h"
#include "pcl_fft_ground/core/align/crispness.h"
#include "pictures/axes.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::ordered_json;

template <typename Matrix>
ordered_json rowsOf(const Matrix& matrix) {
  ordered_json rows = ordered_json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    ordered_json row = ordered_json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(row);
  }
  return rows;
}

std::vector<double> listOf(const Eigen::Vector3d& place) {
  return {place.x(), place.y(), place.z()};
}

/// The centroids of matched segments, in the coordinates of the files.
ordered_json matchesOf(const AlignedPair& pair) {
  const auto place = [](const AlignedScan& scan, std::size_t segment) {
    return listOf(scan.segments.segments[segment].centroid + scan.cloud.origin);
  };
  ordered_json matches = ordered_json::array();
  for (const core::SegmentMatch& match : pair.alignment.matches)
    matches.push_back({{"reference", place(pair.reference, match.reference)},
                       {"moving", place(pair.moving, match.moving)}});
  return matches;
}

ordered_json crispnessOf(const AlignedPair& pair) {
  const core::Points reference = usablePoints(pair.reference.path, pair.reference.cloud);
  const core::Points moving = usablePoints(pair.moving.path, pair.moving.cloud);
  const Eigen::Isometry3d& after = pair.alignment.reference_from_moving;
  const std::size_t nx_before = core::occupiedVoxels(moving, reference, pair.guess);
  const std::size_t nx_after = core::occupiedVoxels(moving, reference, after);
  const auto orNull = [](const std::optional<double>& value) {
    return value ? ordered_json(*value) : ordered_json();
  };
  return {{"nx_before", nx_before},
          {"nx_after", nx_after},
          {"delta_nx_percent", core::crispnessChange(nx_before, nx_after)},
          {"overlap_before", orNull(core::overlapCrispness(moving, reference, pair.guess))},
          {"overlap_after", orNull(core::overlapCrispness(moving, reference, after))}};
}

/// The moving cloud with all its fields, placed in the coordinates of the reference's file, less its origin.
pcl::PCLPointCloud2 alignedCloud(const AlignedPair& pair) {
  const Eigen::Isometry3d& target_from_source = pair.alignment.reference_from_moving;
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
  if (!pair.alignment.accepted) return "Not aligned";
  return "After alignment: " + std::to_string(pair.alignment.matches.size()) + " matches, Nx " +
         fixedNumber(report["crispness"]["delta_nx_percent"].get<double>(), 2) + " %";
}

}  // namespace

const char* nameOf(core::AlignmentMethod method) {
  switch (method) {
    case core::AlignmentMethod::SEGMENTS:
      return "segments";
    case core::AlignmentMethod::DENSE:
      return "dense";
    case core::AlignmentMethod::NONE:
      break;
  }
  return "none";
}

Eigen::Isometry3d transformOfFiles(const AlignedPair& pair) {
  return Eigen::Translation3d(pair.reference.cloud.origin) * pair.alignment.reference_from_moving *
         Eigen::Translation3d(-pair.moving.cloud.origin);
}

ordered_json makeAlignmentReport(const AlignedPair& pair, const AlignmentSettings& settings,
                                 const Segmenter& segmenter) {
  const core::Alignment& alignment = pair.alignment;
  ordered_json report{{"reference", pair.reference.path},
                      {"moving", pair.moving.path},
                      {"accepted", alignment.accepted},
                      {"refusal", alignment.refusal},
                      {"method", nameOf(alignment.method)},
                      {"reference_from_moving", rowsOf(transformOfFiles(pair).matrix())},
                      {"origin", listOf(pair.reference.cloud.origin)},
                      {"covariance", rowsOf(alignment.covariance)},
                      {"score", alignment.score},
                      {"overlap", alignment.overlap},
                      {"segments",
                       {{"reference", pair.reference.segments.segments.size()},
                        {"moving", pair.moving.segments.segments.size()}}},
                      {"matches", matchesOf(pair)},
                      {"crispness", crispnessOf(pair)}};
  report["parameters"] = settings.described;
  report["segmentation"] = {{"method", segmenter.method}, {"parameters", segmenter.parameters}};
  return report;
}

void writeAlignment(const std::string& directory, const AlignedPair& pair, const ordered_json& report) {
  const PairImage image{
      pair.reference.segments, pair.moving.segments,    pair.guess, pair.alignment.reference_from_moving,
      pair.alignment.matches,  panelTitle(pair, report)};
  writeWhole(directory + "/alignment.png", [&](const std::string& path) { drawAlignment(path, image); });
  if (pair.alignment.accepted) {
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
