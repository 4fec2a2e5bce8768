#include "survey_command.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

#include "command_line.h"
#include "errors.h"
#include "output_file.h"
#include "pose_table.h"
#include "progress.h"
#include "segment_report.h"
#include "survey_record.h"
#include "survey_report.h"

namespace pcl_fft_ground::cli {
namespace {

namespace po = boost::program_options;
using nlohmann::ordered_json;

constexpr const char* HELP_BEFORE = R"(Usage: pcl_fft_ground survey FOLDER -o DIR [options]

Aligns the sub-maps of a survey: every *.pcd or *.ply in FOLDER, in the order of their names; the VIEWPOINT of each is
its pose by navigation, z up. Each sub-map is paired with its nearest by the paper's rule, and every pair is aligned
with every method that tells ground from objects: the paper's Table II, where delta Nx is the change of the number of
occupied 2 cm voxels of the pair (negative: crisper). dense-icp is point-to-plane ICP of the whole clouds; +dense behind
a method lets ICP of the overlap step in where there are too few segments, gated as all else. Where FOLDER has a
truth.csv (submap,x,y,z,qx,qy,qz,qw), it is also told how right the alignments are. Then all pairs that overlap are
aligned with one method, and their results and the navigation become one map.
)";

constexpr const char* HELP_AFTER = R"(
DIR is made if need be and receives
  pairs.csv                         all results, a line per pair and method, written after each: a run that was broken
                                    off goes on where it stopped, if its parameters and sub-maps are the same
  poses.csv                         pose of each sub-map by the global alignment: submap,x,y,z,qx,qy,qz,qw
  merged.pcd                        all sub-maps in one, a point per cubic centimetre, with the number of the sub-map
  site_before.png site_after.png    the site as navigation has it and after global alignment
  survey.json parameters.json       both tables and the global alignment; the parameters

Examples:
  pcl_fft_ground simulate survey wreck -o wreck --points 200000
  pcl_fft_ground survey wreck -o result --max-object-size 1
  pcl_fft_ground survey wreck -o result_paper --paper --methods naive,planar,grid,fft-lowpass

Exit status: 0 done, 1 the work failed, 2 wrong usage.
)";

po::options_description commandOptions() {
  const NavigationTrust trust;
  po::options_description options("General", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add = options.add_options();
  add("output,o", po::value<std::string>()->value_name("DIR"),
      "directory for the results; other files in it stay");
  add("methods", po::value<std::string>()->value_name("NAMES"),
      "methods, parted by commas; the last one but dense-icp makes the map "
      "(naive,planar,grid,graph-cut,fft-lowpass,fft,dense-icp,fft+dense)");
  add("navigation-sigma", po::value<double>()->default_value(trust.horizontal, "0.1")->value_name("M"),
      "standard deviation of the places by navigation [m], above 0");
  add("heading-sigma", po::value<double>()->default_value(trust.heading, "2")->value_name("DEG"),
      "standard deviation of the headings by navigation [degrees], above 0");
  add("json", po::bool_switch(), "print survey.json");
  add("quiet", po::bool_switch(), "print nothing but errors");
  add("help,h", po::bool_switch(), "show this text");
  return options;
}

/// What the user wants done.
struct Request {
  std::string folder;
  std::string directory;
  std::vector<std::string> methods;
  std::string mapping;  ///< method of the global alignment
  NavigationTrust trust;
  AlignmentSettings settings;
  std::vector<Segmenter> segmenters;
  ordered_json parameters;
};

std::vector<std::string> chosenMethods(const po::variables_map& values) {
  std::vector<std::string> names = methodNames();
  names.push_back(DENSE_ICP);
  names.push_back(std::string("fft") + WITH_FALLBACK);
  if (values.count("methods") == 0) return names;
  names.clear();
  std::istringstream list(values["methods"].as<std::string>());
  for (std::string name; std::getline(list, name, ',');)
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  if (names.empty()) throw UsageError("--methods: allowed are names of methods, parted by commas");
  return names;
}

double positive(const po::variables_map& values, const char* option) {
  const auto value = values[option].as<double>();
  if (value > 0 && std::isfinite(value)) return value;
  std::ostringstream message;
  message << "--" << option << " " << value << ": allowed is a finite number above 0";
  throw UsageError(message.str());
}

std::string required(const po::variables_map& values, const char* option, const char* what) {
  if (values.count(option) == 0 || values[option].as<std::string>().empty())
    throw UsageError(std::string("survey: no ") + what);
  return values[option].as<std::string>();
}

/// All that the results depend on: other parameters make other results.
ordered_json describeRequest(const Request& request) {
  ordered_json parameters{{"folder", request.folder}, {"alignment", request.settings.described}};
  for (const Segmenter& segmenter : request.segmenters)
    parameters["segmentation"][segmenter.method] = segmenter.parameters;
  parameters["submaps"] = fingerprintOf(request.folder);
  return parameters;
}

/// A segmenter for each method that needs one.
std::vector<Segmenter> makeSegmenters(const std::vector<std::string>& methods,
                                      const po::variables_map& values, Version version) {
  std::vector<Segmenter> segmenters;
  for (const std::string& method : methods) {
    const std::string name = segmenterOf(method);
    const bool is_there = std::any_of(segmenters.begin(), segmenters.end(),
                                      [&](const Segmenter& segmenter) { return segmenter.method == name; });
    if (name != DENSE_ICP && !is_there) segmenters.push_back(makeAlignmentSegmenter(name, values, version));
  }
  return segmenters;
}

Request parseRequest(const po::variables_map& values) {
  Request request;
  request.folder = required(values, "folder", "folder of sub-maps given");
  request.directory = required(values, "output", "output given: name a folder by -o DIR");
  request.methods = chosenMethods(values);
  request.settings = alignmentSettings(values);
  request.trust = {positive(values, "navigation-sigma"), positive(values, "heading-sigma")};
  request.mapping = request.methods.front();
  for (const std::string& method : request.methods)
    if (method != DENSE_ICP) request.mapping = method;
  request.segmenters = makeSegmenters(request.methods, values, request.settings.version);
  request.parameters = describeRequest(request);
  return request;
}

/// Aligns what the record does not have yet.
std::vector<PairResult> alignPairs(Request& request, const SurveyFolder& survey, Progress& progress) {
  std::vector<std::string> names;
  for (const Submap& submap : survey.submaps) names.push_back(submap.name);
  SurveyRecord record(request.directory, request.parameters, names);
  SurveyScans scans(survey.submaps, request.settings, std::move(request.segmenters));
  const std::vector<PairTask> tasks = planPairs(survey, request.methods, request.mapping);
  std::vector<PairResult> results;
  for (const PairTask& task : tasks) {
    const PairResult* known = record.find(task);
    if (known == nullptr) {
      progress.begin("align", "[" + std::to_string(results.size() + 1) + "/" + std::to_string(tasks.size()) +
                                  "] " + names[task.pair.reference] + " and " + names[task.pair.moving] +
                                  ": " + task.method);
      record.add(alignPair(task, survey, scans, request.settings));
      known = &record.results().back();
    }
    results.push_back(*known);
  }
  return results;
}

void writePoses(const std::string& directory, const SurveyFolder& survey,
                const std::vector<Eigen::Isometry3d>& poses) {
  std::vector<NamedPose> table;
  for (std::size_t i = 0; i < poses.size(); ++i) table.push_back({survey.submaps[i].name, poses[i]});
  writeText(directory + "/poses.csv", asCsv(table));
}

void surveyFolder(const po::variables_map& values) {
  Request request = parseRequest(values);
  const bool quiet = values["quiet"].as<bool>();
  makeDirectory(request.directory);
  Progress progress(quiet);
  const auto reportReading = [&](std::size_t submap) {
    progress.begin("read", "reading sub-map " + std::to_string(submap));
  };
  const SurveyFolder survey = readSurvey(request.folder, reportReading);
  const std::vector<PairResult> results = alignPairs(request, survey, progress);
  GlobalResult global{request.mapping, solveSurvey(survey, results, request.mapping, request.trust), {}};
  writePoses(request.directory, survey, global.poses.global);
  global.crispness = writeSiteMap(request.directory, survey, global.poses, reportReading);
  progress.end();

  const ordered_json report = makeSurveyReport(survey, results, global, request.parameters);
  writeText(request.directory + "/survey.json", asText(report));
  if (values["json"].as<bool>())
    std::cout << asText(report);
  else if (!quiet)
    printSurvey(std::cout, survey, results, global);
}

}  // namespace

void runSurvey(const std::vector<std::string>& arguments) {
  po::options_description shown;
  shown.add(commandOptions()).add(alignmentOptions("none")).add(segmenterOptions());
  po::options_description all;
  all.add(shown).add_options()("folder", po::value<std::string>());
  po::positional_options_description positional;
  positional.add("folder", 1);
  const po::variables_map values = parseArguments("survey", arguments, all, positional);
  if (values["help"].as<bool>())
    std::cout << HELP_BEFORE << shown << HELP_AFTER;
  else
    surveyFolder(values);
}

}  // namespace pcl_fft_ground::cli
