#include <Eigen/Geometry>
#include <utility>

#include "commands/segment/segment_report.h"
#include "io/output_file.h"
#include "report/html_page.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t MOST_SURFACE_POINTS = 40000;  // of the view's; the scan has the others
constexpr std::size_t MOST_SEGMENTS = 100;          // of the table: the largest

/// The points of the scan by what they are, in the level frame.
std::vector<ViewLayer> scanLayers(const Cloud& cloud, const Segmentation& segmentation) {
  std::vector<ViewLayer> layers{
      {"ground", "#a08f78", {}, {}}, {"objects", "#2f6fd0", {}, {}}, {"neither", "#c94f4f", {}, {}, false}};
  for (const std::size_t n : thinnedIndices(cloud.points->size(), MOST_VIEW_POINTS - MOST_SURFACE_POINTS)) {
    ViewLayer& layer = layers[static_cast<std::size_t>(segmentation.labels[n])];
    layer.points.emplace_back(
        (segmentation.surface.frame_from_input * (*cloud.points)[n].getVector3fMap().cast<double>())
            .cast<float>());
    layer.groups.push_back(segmentation.segments[n]);
  }
  return layers;
}

/// The estimated ground: the middles of its cells, hidden at first, as they lie among the ground's points.
ViewLayer surfaceLayer(const core::GroundSurface& surface) {
  ViewLayer layer{"estimated ground", "#4c9a5b", {}, {}, false};
  for (const std::size_t n :
       thinnedIndices(static_cast<std::size_t>(surface.height.size()), MOST_SURFACE_POINTS)) {
    const auto cell = static_cast<Eigen::Index>(n);
    const Eigen::Index row = cell % surface.height.rows(), col = cell / surface.height.rows();
    const Eigen::Vector2d middle =
        surface.geometry.origin +
        surface.geometry.cell_size *
            Eigen::Vector2d(static_cast<double>(row) + 0.5, static_cast<double>(col) + 0.5);
    layer.points.push_back(Eigen::Vector3d(middle.x(), middle.y(), surface.height(row, col)).cast<float>());
  }
  return layer;
}

std::string countsText(const ordered_json& counts) {
  const auto points = counts["points"].get<double>();
  const auto share = [&](const char* name) {
    return groupedNumber(counts[name].get<long long>()) + " (" +
           fixedNumber(100 * counts[name].get<double>() / points, 1) + " %)";
  };
  return groupedNumber(counts["points"].get<long long>()) + " points: " + share("ground") + " are ground, " +
         share("objects") + " objects, in " + groupedNumber(counts["segments"].get<long long>()) +
         " segments, and " + share("neither") + " neither.";
}

}  // namespace

std::string segmentPage(const std::string& directory, const Cloud& cloud, const Segmentation& segmentation,
                        const ordered_json& report) {
  HtmlPage page;
  page.title = report["input"].get<std::string>() + ": ground and objects";
  page.summary = {countsText(report["counts"]), "Method " + report["method"].get<std::string>() + "."};
  page.warnings = report["warnings"].get<std::vector<std::string>>();
  page.layers = scanLayers(cloud, segmentation);
  page.layers.push_back(surfaceLayer(segmentation.surface));
  page.view_caption = "The scan with its ground level, of large scans a part of the points.";
  const auto picture = [&](const char* name, const char* caption) {
    page.pictures.push_back({caption, fileBytes(directory + "/" + name)});
  };
  picture("labels.png", "Ground and objects from above");
  picture("segments.png", "The segments, the largest ones numbered");
  picture("elevation.png", "The highest point of each cell");
  picture("ground.png", "The estimated ground");
  if (!report["spectrum"].is_null())
    picture("spectrum.png", "The spectrum of the elevation before and after the low-pass");

  if (!report["scores"].is_null())
    page.tables.push_back(
        tableOfRecords("Against the labels of the input", ordered_json::array({report["scores"]})));
  page.tables.push_back(
      tableOfCsv("Segments, by falling size [m]", fileBytes(directory + "/segments.csv"), MOST_SEGMENTS));
  page.tables.push_back(tableOfParameters("Parameters", report["parameters"]));
  page.tables.push_back(tableOfParameters("Up", report["up"]));
  page.tables.push_back(tableOfParameters("Elevation grid", report["elevation"]));
  if (!report["ground"].is_null()) page.tables.push_back(tableOfParameters("Ground [m]", report["ground"]));
  page.tables.push_back(tableOfParameters("Time [s]", report["seconds"]));
  return htmlPage(std::move(page));
}

}  // namespace pcl_fft_ground::cli
