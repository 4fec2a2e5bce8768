#include <string>
#include <utility>

#include "commands/align/align_report.h"
#include "io/output_file.h"
#include "report/html_page.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::ordered_json;

/// A scan in the coordinates of the reference.
ViewLayer scanLayer(const std::string& name, const std::string& colour, bool shown, const Cloud& cloud,
                    const Eigen::Isometry3d& reference_from_scan) {
  ViewLayer layer{name, colour, {}, {}, shown};
  for (const std::size_t n : thinnedIndices(cloud.points->size(), MOST_VIEW_POINTS / 3))
    layer.points.emplace_back(
        (reference_from_scan * (*cloud.points)[n].getVector3fMap().cast<double>()).cast<float>());
  return layer;
}

/// The matches: centroids in the coordinates of either file.
ordered_json matchRows(const ordered_json& matches) {
  ordered_json rows = ordered_json::array();
  for (const ordered_json& match : matches)
    rows.push_back(
        {{"match", rows.size() + 1}, {"in reference", match["reference"]}, {"in moving", match["moving"]}});
  return rows;
}

}  // namespace

std::string alignmentPage(const std::string& directory, const AlignedPair& pair, const ordered_json& report) {
  const bool accepted = report["accepted"].get<bool>();
  HtmlPage page;
  page.title = report["moving"].get<std::string>() + " aligned to " + report["reference"].get<std::string>();
  if (accepted)
    page.summary = {"Aligned by " + report["method"].get<std::string>() + ": " +
                    std::to_string(report["matches"].size()) + " matched segments, score " +
                    fixedNumber(report["score"].get<double>(), 2) + ", overlap " +
                    fixedNumber(100 * report["overlap"].get<double>(), 0) + " %."};
  else
    page.summary = {"Not aligned: " + report["refusal"].get<std::string>()};
  page.warnings = report["warnings"].get<std::vector<std::string>>();
  page.view_caption = "Both scans in the coordinates of the reference, a part of their points.";
  page.layers = {scanLayer("reference", "#2f6fd0", true, pair.reference.cloud, Eigen::Isometry3d::Identity()),
                 scanLayer("moving, as guessed", "#e0a030", !accepted, pair.moving.cloud, pair.guess)};
  if (accepted)
    page.layers.push_back(scanLayer("moving, aligned", "#d0454c", true, pair.moving.cloud,
                                    pair.icp.getAlignment().reference_from_moving));
  page.pictures = {{"Both scans from above, before and after", fileBytes(directory + "/alignment.png")}};
  const auto part = [&](const char* caption, const char* name) {
    page.tables.push_back(tableOfParameters(caption, report[name]));
  };
  if (accepted)
    page.tables.push_back({"From the coordinates of moving to those of reference", {"", "", "", ""}, {}});
  for (const ordered_json& row : report["reference_from_moving"])
    if (accepted)
      page.tables.back().rows.push_back(
          {fixedNumber(row[0].get<double>(), 6), fixedNumber(row[1].get<double>(), 6),
           fixedNumber(row[2].get<double>(), 6), fixedNumber(row[3].get<double>(), 6)});
  part("Crispness: occupied voxels of 2 cm", "crispness");
  if (!report["matches"].empty())
    page.tables.push_back(
        tableOfRecords("Matched segments: their centroids [m]", matchRows(report["matches"])));
  part("Parameters of the alignment", "parameters");
  page.tables.push_back(
      tableOfParameters("Parameters of " + report["segmentation"]["method"].get<std::string>(),
                        report["segmentation"]["parameters"]));
  return htmlPage(std::move(page));
}

}  // namespace pcl_fft_ground::cli
