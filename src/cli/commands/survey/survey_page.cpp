#include <utility>

#include "commands/survey/survey_report.h"
#include "io/cloud_fields.h"
#include "io/cloud_file.h"
#include "io/output_file.h"
#include "report/html_page.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::ordered_json;

/// merged.pcd of a survey, its sub-maps as groups.
ViewLayer siteLayer(const std::string& directory) {
  ViewLayer layer{"site", "#8a97a3", {}, {}};
  const Cloud merged = readCloud(directory + "/merged.pcd");
  const pcl::PCLPointField* const field = findField(merged.fields, "submap");
  const std::vector<double> submaps =
      field == nullptr ? std::vector<double>() : fieldNumbers(merged.fields, *field);
  for (const std::size_t n : thinnedIndices(merged.points->size(), MOST_VIEW_POINTS)) {
    layer.points.push_back((*merged.points)[n].getVector3fMap());
    if (!submaps.empty()) layer.groups.push_back(static_cast<int>(submaps[n]) + 1);
  }
  return layer;
}

/// Navigation, chained and global: voxels, and errors where the truth is known.
ordered_json placementRows(const ordered_json& placements) {
  ordered_json rows = ordered_json::array();
  for (const auto& [name, placement] : placements.items()) {
    ordered_json row{{"poses", name}, {"occupied voxels", placement["occupied_voxels"]}};
    if (placement.contains("errors")) row.update(placement["errors"]);
    rows.push_back(row);
  }
  return rows;
}

void addTables(HtmlPage& page, const std::string& name, const ordered_json& report) {
  page.tables.push_back(
      tableOfRecords(name + ": crispness before and after alignment (Table II)", report["crispness"]));
  page.tables.push_back(tableOfRecords(name + ": pairs that overlap [m, degrees]", report["accuracy"]));
  page.tables.push_back(tableOfRecords(name + ": the poses of the sub-maps [m, degrees]",
                                       placementRows(report["global"]["placements"])));
}

}  // namespace

std::string surveyPage(const SurveyRequest& request, const std::vector<SurveyOutcome>& outcomes,
                       const std::vector<ordered_json>& reports) {
  HtmlPage page;
  page.title = "Survey " + request.surveys.front().name;
  if (request.surveys.size() > 1)
    page.title += " and " + std::to_string(request.surveys.size() - 1) + " more";
  page.groups = "sub-map";
  const SurveyOutcome& whole = outcomes.back();
  page.summary = {std::to_string(whole.submaps) + " sub-maps. Global alignment by " + request.mapping + ": " +
                  std::to_string(whole.edges) + " aligned pairs, " + std::to_string(whole.rejected_edges) +
                  " of them rejected."};
  for (const LeftOut& file : whole.left_out) page.warnings.push_back("left out: " + file.reason);
  for (const FileRemark& file : whole.remarks) page.warnings.push_back(file.path + ": " + file.remark);
  page.view_caption = "Survey " + request.surveys.front().name +
                      " after global alignment, of large sites a part of the points.";
  page.layers = {siteLayer(request.surveys.front().directory)};
  for (const SurveyTask& task : request.surveys) {
    page.pictures.push_back(
        {task.name + " as navigation has it", fileBytes(task.directory + "/site_before.png")});
    page.pictures.push_back(
        {task.name + " after global alignment", fileBytes(task.directory + "/site_after.png")});
  }
  for (std::size_t n = outcomes.size(); n-- > 0;) addTables(page, outcomes[n].name, reports[n]);
  for (const SurveyTask& task : request.surveys)
    page.tables.push_back(
        tableOfParameters(task.name + ": parameters of the alignment", task.parameters["alignment"]));
  for (const Segmenter& segmenter : request.segmenters)
    page.tables.push_back(tableOfParameters("Parameters of " + segmenter.method, segmenter.parameters));
  return htmlPage(std::move(page));
}

}  // namespace pcl_fft_ground::cli
