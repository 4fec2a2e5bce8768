#include "evaluate_command.h"

#include <chrono>
#include <cmath>
#include <iostream>
#include <optional>
#include <sstream>

#include "command_line.h"
#include "errors.h"
#include "evaluation_table.h"
#include "output_file.h"
#include "progress.h"
#include "segmentation.h"

namespace pcl_fft_ground::cli {
namespace {

namespace po = boost::program_options;

constexpr const char* HELP_BEFORE = R"(Usage: pcl_fft_ground evaluate CLOUD... [options]

Runs segmentation methods on labelled clouds (label 1 object, 0 ground; other labels are not scored) and prints how well
they tell the two apart: the paper's Table I. tpr and tnr are the shares of object and of ground points that were found.
surface_rmse [m] is that of the ground surface at the points labelled ground. All clouds and methods share one set of
parameters.

)";

constexpr const char* HELP_AFTER = R"(
Example:
  pcl_fft_ground simulate wreck -o wreck.pcd
  pcl_fft_ground evaluate wreck.pcd --methods naive,planar,grid,fft-lowpass --max-object-size 1

Exit status: 0 done, 1 the work failed, 2 wrong usage. A method that fails on a cloud has its reason in the table.
)";

po::options_description commandOptions() {
  po::options_description options("General", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add = options.add_options();
  add("methods", po::value<std::string>()->value_name("NAMES"),
      "methods, parted by commas (naive,planar,grid,graph-cut,fft-lowpass,fft)");
  add("csv", po::value<std::string>()->value_name("FILE"), "write the table as CSV, too");
  add("json", po::bool_switch(), "print the table as JSON");
  add("quiet", po::bool_switch(), "no progress and no warnings");
  add("help,h", po::bool_switch(), "show this text");
  return options;
}

std::vector<std::string> chosenMethods(const po::variables_map& values) {
  if (values.count("methods") == 0) return methodNames();
  std::vector<std::string> names;
  std::istringstream list(values["methods"].as<std::string>());
  for (std::string name; std::getline(list, name, ',');) names.push_back(name);
  if (names.empty()) throw UsageError("--methods: allowed are names of methods, parted by commas");
  return names;
}

/// Root mean square of the heights of the points labelled ground above the surface [m]; their noise is part
/// of it.
std::optional<double> surfaceError(const Cloud& cloud, const core::GroundSurface& surface) {
  double sum = 0, count = 0;
  for (std::size_t n = 0; n < cloud.points->size(); ++n) {
    const Eigen::Vector3d p = (*cloud.points)[n].getVector3fMap().cast<double>();
    if (cloud.labels[n] != 0 || !p.allFinite()) continue;
    sum += std::pow(surface.heightAbove(p), 2);
    ++count;
  }
  return count > 0 ? std::optional<double>(std::sqrt(sum / count)) : std::nullopt;
}

EvaluationRow evaluate(const std::string& path, const Cloud& cloud, Segmenter& segmenter) {
  EvaluationRow row;
  row.cloud = path;
  row.method = segmenter.method;
  GroundSegmentation<Point>& filter = *segmenter.filter;
  filter.setInputCloud(cloud.points);
  pcl::PointIndices ground, objects;
  const auto start = std::chrono::steady_clock::now();
  filter.segment(ground, objects);
  row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  row.failure = filter.getError();
  if (!row.failure.empty()) return row;
  row.surface_rmse = surfaceError(cloud, filter.getGroundSurface());
  row.confusion = core::compare(cloud.labels, labelsOf(cloud.points->size(), ground, objects));
  return row;
}

Cloud readLabelledCloud(const std::string& path) {
  Cloud cloud = readCloud(path);
  if (cloud.labels.empty())
    throw WorkError(path + ": has no field 'label' (0 ground, 1 object) to compare with");
  return cloud;
}

void evaluateAll(const po::variables_map& values) {
  if (values.count("cloud") == 0)
    throw UsageError("evaluate: no cloud given: name PCD, PLY or text files with labels");
  const auto clouds = values["cloud"].as<std::vector<std::string>>();
  std::vector<Segmenter> segmenters;
  for (const std::string& method : chosenMethods(values)) segmenters.push_back(makeSegmenter(method, values));
  const bool quiet = values["quiet"].as<bool>();

  Progress progress(quiet);
  std::vector<EvaluationRow> rows;
  for (std::size_t n = 0; n < clouds.size(); ++n) {
    const std::string place =
        "[" + std::to_string(n + 1) + "/" + std::to_string(clouds.size()) + "] " + clouds[n];
    progress.begin("read", place);
    const Cloud cloud = readLabelledCloud(clouds[n]);
    for (Segmenter& segmenter : segmenters) {
      progress.begin(segmenter.method, place + ": " + segmenter.method);
      rows.push_back(evaluate(clouds[n], cloud, segmenter));
      if (quiet) continue;
      for (const std::string& warning : segmenter.filter->getWarnings())
        std::cerr << "pcl_fft_ground: warning: " << clouds[n] << ": " << segmenter.method << ": " << warning
                  << '\n';
    }
  }
  progress.end();
  if (values.count("csv") != 0) writeText(values["csv"].as<std::string>(), asCsv(rows));
  if (values["json"].as<bool>())
    std::cout << asJson(rows).dump(2) << '\n';
  else
    printTable(std::cout, rows);
}

}  // namespace

void runEvaluate(const std::vector<std::string>& arguments) {
  po::options_description shown;
  shown.add(segmenterOptions()).add(commandOptions());
  po::options_description all;
  all.add(shown).add_options()("cloud", po::value<std::vector<std::string>>());
  po::positional_options_description positional;
  positional.add("cloud", -1);
  const po::variables_map values = parseArguments("evaluate", arguments, all, positional);
  if (values["help"].as<bool>())
    std::cout << HELP_BEFORE << shown << HELP_AFTER;
  else
    evaluateAll(values);
}

}  // namespace pcl_fft_ground::cli
