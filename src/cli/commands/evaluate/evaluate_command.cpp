#include <algorithm>
#include <iostream>
#include <optional>
#include <sstream>
#include <utility>

#include "command_line.h"
#include "commands/commands.h"
#include "commands/evaluate/cloud_evaluation.h"
#include "commands/evaluate/evaluation_pictures.h"
#include "commands/evaluate/evaluation_table.h"
#include "errors.h"
#include "io/output_file.h"
#include "printable.h"
#include "progress.h"
#include "reading_options.h"
#include "report/html_page.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

namespace po = boost::program_options;
using Names = std::vector<std::string>;

const std::vector<Purpose> PURPOSES{Purpose::USE, Purpose::COMPARISON};

constexpr const char* HELP_BEFORE = R"(Usage: pcl_fft_ground evaluate CLOUD... [options]

Runs segmentation methods on labelled clouds (label 1 object, 0 ground, 2 not scored; the classes of LAS; others by
--ground-classes and --ignore-classes) and prints how well they tell the two apart: tpr and tnr are the shares of
object and of ground points that were found. surface_rmse [m] is that of the estimated ground surface: against the true
heights where the cloud has them (a floating-point field 'ground', as of simulate --ground-heights), else against the
points labelled ground. All clouds and methods share one set of parameters. Several clouds are set side by side, too, as
in the paper's Table I.

)";

constexpr const char* HELP_AFTER = R"(
Example:
  pcl_fft_ground simulate wreck -o wreck.pcd --ground-heights
  pcl_fft_ground evaluate wreck.pcd --methods naive,planar,grid,fft-lowpass --max-object-size 1 --pictures errors

Exit status: 0 done, 1 the work failed, 2 wrong usage. A method that fails on a cloud has its reason in the table.
)";

po::options_description commandOptions() {
  po::options_description options("General", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add = options.add_options();
  add("methods", po::value<std::string>()->value_name("NAMES"),
      ("methods, parted by commas (" + joined(methodNames(), ",") +
       "); also, to compare with, PCL's own: " + joined(methodNames(Purpose::COMPARISON), ", "))
          .c_str());
  add("csv", po::value<std::string>()->value_name("FILE"), "write the table as CSV, too");
  add("pictures", po::value<std::string>()->value_name("DIR"),
      "draw a picture of each cloud to this directory, made if need be: the truth and each method's labels, "
      "errors coloured by kind");
  addThreadsOption(options);
  addReportOption(options);
  add("json", po::bool_switch(), "print the table as JSON");
  add("quiet", po::bool_switch(), "no progress and no warnings");
  add("help,h", po::bool_switch(), "show this text");
  return options;
}

/// The names without those that came before.
Names withoutRepeats(const Names& names) {
  Names kept;
  for (const std::string& name : names)
    if (std::find(kept.begin(), kept.end(), name) == kept.end()) kept.push_back(name);
  return kept;
}

Names chosenMethods(const po::variables_map& values) {
  if (values.count("methods") == 0) return methodNames();
  Names names;
  std::istringstream list(values["methods"].as<std::string>());
  for (std::string name; std::getline(list, name, ',');) names.push_back(name);
  if (names.empty()) throw UsageError("--methods: allowed are names of methods, parted by commas");
  return withoutRepeats(names);
}

Names chosenClouds(const po::variables_map& values) {
  if (values.count("cloud") == 0)
    throw UsageError("evaluate: no cloud given: name files (PCD, PLY, LAS, text) with labels");
  return withoutRepeats(values["cloud"].as<Names>());
}

void requireName(const po::variables_map& values, const std::string& option, const std::string& what) {
  if (values.count(option) != 0 && values[option].as<std::string>().empty())
    throw UsageError("--" + option + ": allowed is the name of " + what);
}

std::vector<Segmenter> makeSegmenters(const po::variables_map& values) {
  std::vector<Segmenter> segmenters;
  for (const std::string& method : chosenMethods(values))
    segmenters.push_back(makeSegmenter(method, values, PURPOSES));
  return segmenters;
}

/// "[2/5] name": which of the clouds it is.
std::string placeOf(const Names& clouds, std::size_t n) {
  return "[" + std::to_string(n + 1) + "/" + std::to_string(clouds.size()) + "] " + clouds[n];
}

/// Reads all clouds once before the long work, which a bad one among the last would undo, and before anything
/// is written.
void checkClouds(const Names& clouds, const ReadOptions& reading, bool quiet, Progress& progress) {
  for (std::size_t n = 0; n < clouds.size(); ++n) {
    progress.begin("check", placeOf(clouds, n) + ": checking");
    const LabelledCloud cloud = readLabelledCloud(clouds[n], reading);
    for (const std::string& remark : cloud.cloud.remarks)
      if (!quiet) printWarning(clouds[n] + ": " + remark);
  }
}

void printWarnings(const std::string& cloud, const Segmenter& segmenter) {
  for (const std::string& warning : segmenter.filter->getWarnings())
    printWarning(cloud + ": " + segmenter.method + ": " + warning);
}

void writePicture(const std::string& directory, const std::string& name, const LabelledCloud& cloud,
                  const Eigen::Vector3d& up, const std::vector<Evaluation>& evaluations) {
  writeWhole(directory + "/" + name,
             [&](const std::string& temporary) { drawEvaluations(temporary, cloud, up, evaluations); });
}

/// Adds what is to be seen of a cloud to the page; the view is of the first one, by the last method.
void addToPage(HtmlPage& page, const std::string& path, const LabelledCloud& cloud, const Eigen::Vector3d& up,
               const std::vector<Evaluation>& evaluations) {
  page.pictures.push_back({cloud.path + ": the truth, and what each method made of it",
                           writtenBytes(path, [&](const std::string& temporary) {
                             drawEvaluations(temporary, cloud, up, evaluations);
                           })});
  if (!page.layers.empty()) return;
  page.layers = evaluationLayers(cloud, up, evaluations.back());
  page.view_caption =
      cloud.path + " by " + evaluations.back().row.method + ": what was found, and what was not.";
}

/// The page of the results. \param page with its pictures, its view and its warnings
std::string pageText(HtmlPage page, const Names& clouds, const std::vector<Segmenter>& segmenters,
                     const std::vector<EvaluationRow>& rows) {
  const nlohmann::ordered_json results = asJson(rows);
  page.title = "Methods compared on " +
               (clouds.size() == 1 ? clouds.front() : std::to_string(clouds.size()) + " clouds");
  nlohmann::ordered_json means = nlohmann::ordered_json::array();
  for (const auto& [method, values] : results["means"].items()) {
    means.push_back({{"method", method}});
    means.back().update(values);
  }
  if (clouds.size() > 1) page.tables.push_back(tableOfRecords("Means over the clouds", means));
  page.tables.push_back(tableOfRecords("Scores", results["results"]));
  for (const Segmenter& segmenter : segmenters)
    page.tables.push_back(tableOfParameters("Parameters of " + segmenter.method, segmenter.parameters));
  return htmlPage(std::move(page));
}

std::vector<EvaluationRow> evaluateAll(const Names& clouds, std::vector<Segmenter>& segmenters,
                                       const po::variables_map& values, HtmlPage& page) {
  const bool quiet = values["quiet"].as<bool>();
  const Names pictures = pictureNames(clouds);
  Progress progress(quiet);
  const ReadOptions reading = readOptions(values);
  checkClouds(clouds, reading, quiet, progress);
  std::optional<OutputFolder> folder;
  if (values.count("pictures") != 0) folder.emplace(values["pictures"].as<std::string>());
  std::vector<EvaluationRow> rows;
  for (std::size_t n = 0; n < clouds.size(); ++n) {
    progress.begin("read", placeOf(clouds, n));
    const LabelledCloud cloud = readLabelledCloud(clouds[n], reading);
    std::vector<Evaluation> evaluations;
    for (Segmenter& segmenter : segmenters) {
      progress.begin(segmenter.method, placeOf(clouds, n) + ": " + segmenter.method);
      evaluations.push_back(evaluateMethod(cloud, segmenter));
      rows.push_back(evaluations.back().row);
      for (const std::string& warning : segmenter.filter->getWarnings())
        page.warnings.push_back(clouds[n] + ": " + segmenter.method + ": " + warning);
      if (!quiet) printWarnings(clouds[n], segmenter);
    }
    const Eigen::Vector3d up = segmenters.front().filter->getUpDirection();
    progress.begin("pictures", placeOf(clouds, n) + ": drawing");
    if (values.count("pictures") != 0)
      writePicture(values["pictures"].as<std::string>(), pictures[n], cloud, up, evaluations);
    if (values.count("report") != 0)
      addToPage(page, values["report"].as<std::string>(), cloud, up, evaluations);
  }
  return rows;
}

}  // namespace

void runEvaluate(const std::vector<std::string>& arguments) {
  po::options_description shown;
  shown.add(segmenterOptions(PURPOSES)).add(readingOptions(Labels::USED)).add(commandOptions());
  po::options_description all;
  all.add(shown).add_options()("cloud", po::value<Names>());
  po::positional_options_description positional;
  positional.add("cloud", -1);
  const po::variables_map values = parseArguments("evaluate", arguments, all, positional);
  if (values["help"].as<bool>()) {
    std::cout << HELP_BEFORE << shown << HELP_AFTER;
    return;
  }
  const Names clouds = chosenClouds(values);
  requireName(values, "csv", "a file");
  requireName(values, "pictures", "a directory");
  const core::Threads threads(threadsOf(values));
  std::vector<Segmenter> segmenters = makeSegmenters(values);
  const std::string path = reportPath(values, "");
  HtmlPage page;
  const std::vector<EvaluationRow> rows = evaluateAll(clouds, segmenters, values, page);
  if (values["json"].as<bool>())
    std::cout << asText(asJson(rows));
  else
    printTable(std::cout, rows);
  if (values.count("csv") != 0) writeText(values["csv"].as<std::string>(), asCsv(rows));
  if (!path.empty()) writeText(path, pageText(page, clouds, segmenters, rows));
}

}  // namespace pcl_fft_ground::cli
