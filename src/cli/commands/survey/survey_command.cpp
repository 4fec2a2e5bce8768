#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <sstream>
#include <system_error>

#include "command_line.h"
#include "commands/commands.h"
#include "commands/survey/survey_report.h"
#include "commands/survey/survey_run.h"
#include "errors.h"
#include "io/output_file.h"
#include "pcl_fft_ground/version.h"
#include "printable.h"
#include "progress.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using nlohmann::ordered_json;

constexpr const char* HELP_BEFORE = R"(Usage: pcl_fft_ground survey FOLDER... -o DIR [options]

Aligns the sub-maps of a survey: every *.pcd or *.ply in FOLDER, in the order of their names; the VIEWPOINT of each is
its pose by navigation, z up. Each sub-map is paired with its nearest by the paper's rule, and every pair is aligned
with every method that tells ground from objects: the paper's Table II, where delta Nx is the change of the number of
occupied 2 cm voxels of the pair (negative: crisper). dense-icp is point-to-plane ICP of the whole clouds; +dense behind
a method lets ICP of the overlap step in where there are too few segments, gated as all else. Where FOLDER has a
truth.csv (submap,x,y,z,qx,qy,qz,qw), it is also told how right the alignments are. Then all pairs that overlap are
aligned with one method, and their results and the navigation become one map. Of several folders each is a survey of its
own, with its results in DIR/NAME of the folder; the tables are then printed for all of them together, too.
)";

constexpr const char* HELP_AFTER = R"(
DIR is made if need be and receives
  pairs.csv                         all results, a line per pair and method. Until it is written a pairs.journal takes
                                    each result in, and a run that was broken off goes on where it stopped, if its
                                    parameters and sub-maps are the same.
                                    Transforms are between the points less their `origins` in survey.json, if any
  poses.csv                         pose of each sub-map by the global alignment: submap,x,y,z,qx,qy,qz,qw
  merged.pcd                        all sub-maps in one, a point per cubic centimetre, with the number of the sub-map;
                                    where coordinates are large the VIEWPOINT gives what is subtracted
  site_before.png site_after.png    the site as navigation has it and after global alignment
  survey.json parameters.json       both tables and the global alignment; the parameters. Of several folders DIR has a
                                    survey.json, too, of all of them

A survey can be shared among machines that see the same folders: --shard 1/3, 2/3 and 3/3 align a third of the pairs
each and write nothing but a journal; a last run without --shard makes the results of them. A shard that was broken off
goes on where it stopped, or the last run does its rest.

Examples:
  pcl_fft_ground simulate survey wreck -o wreck --points 200000
  pcl_fft_ground survey wreck -o result --max-object-size 1
  pcl_fft_ground survey site_1 site_2 site_3 -o results --max-object-size 1 --methods fft,fft+dense
  pcl_fft_ground survey wreck -o result_paper --paper --methods naive,planar,grid,fft-lowpass

Exit status: 0 done, 1 the work failed, 2 wrong usage.
)";

void requireMethod(const std::string& name) {
  const std::vector<std::string> segmenters = methodNames();
  if (name != DENSE_ICP &&
      std::find(segmenters.begin(), segmenters.end(), segmenterOf(name)) == segmenters.end())
    throw UsageError("--methods " + name + ": allowed are " + joined(segmenters, ", ") + ", " + DENSE_ICP +
                     ", all but the last with or without " + WITH_FALLBACK);
}

/// What is run where nothing else is asked for.
std::vector<std::string> defaultMethods() {
  std::vector<std::string> names = methodNames();
  names.push_back(DENSE_ICP);
  names.push_back(methodNames().back() + WITH_FALLBACK);
  return names;
}

std::vector<std::string> chosenMethods(const po::variables_map& values) {
  if (values.count("methods") == 0) return defaultMethods();
  std::vector<std::string> names;
  std::istringstream list(values["methods"].as<std::string>());
  for (std::string name; std::getline(list, name, ',');) {
    name.erase(0, name.find_first_not_of(' '));
    name.erase(name.find_last_not_of(' ') + 1);
    requireMethod(name);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  if (names.empty()) throw UsageError("--methods: allowed are names of methods, parted by commas");
  return names;
}

double within(const po::variables_map& values, const char* option, double lowest, double highest) {
  const auto value = values[option].as<double>();
  if (value >= lowest && value <= highest) return value;
  std::ostringstream message;
  message << "--" << option << " " << value << ": allowed is " << lowest << " to " << highest;
  throw UsageError(message.str());
}

/// The folder, whatever the way to it. \throws UsageError for an empty name
fs::path absolutePath(const std::string& folder) {
  if (folder.empty()) throw UsageError("survey: the name of a folder is empty");
  const fs::path path = fs::absolute(folder).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

/// All that the results depend on: other parameters make other results.
ordered_json describe(const std::string& folder, const SurveyRequest& request) {
  ordered_json parameters{{"version", PCL_FFT_GROUND_VERSION},
                          {"folder", absolutePath(folder).string()},
                          {"alignment", request.settings.described}};
  for (const Segmenter& segmenter : request.segmenters)
    parameters["segmentation"][segmenter.method] = segmenter.parameters;
  parameters["submaps"] = fingerprintOf(folder);
  return parameters;
}

/// A survey for each folder; of several each has a folder of its own name for its results.
std::vector<SurveyTask> tasksOf(const std::vector<std::string>& folders, const SurveyRequest& request) {
  std::vector<SurveyTask> tasks;
  for (const std::string& folder : folders) {
    const std::string name = absolutePath(folder).filename().string();
    for (const SurveyTask& other : tasks)
      if (other.name == name)
        throw UsageError("survey: " + other.folder + " and " + folder +
                         " have the same name, which their results would share");
    const std::string directory = folders.size() == 1 ? request.directory : request.directory + "/" + name;
    std::error_code ignored;
    if (fs::equivalent(folder, directory, ignored))
      throw UsageError("-o " + request.directory + ": the results would lie among the sub-maps of " + folder);
    tasks.push_back({name, folder, directory, describe(folder, request)});
  }
  return tasks;
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

po::options_description surveyOptions() {
  const core::NavigationSigmas sigmas;
  po::options_description options("General", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add = options.add_options();
  add("output,o", po::value<std::string>()->value_name("DIR"),
      "directory for the results; other files in it stay");
  add("methods", po::value<std::string>()->value_name("NAMES"),
      ("methods, parted by commas; the last one but dense-icp makes the map (" +
       joined(defaultMethods(), ",") + ")")
          .c_str());
  add("navigation-sigma", po::value<double>()->default_value(sigmas.horizontal, "0.1")->value_name("M"),
      "standard deviation of the places by navigation [m], 0.0001 to 10000");
  add("heading-sigma", po::value<double>()->default_value(sigmas.heading, "2")->value_name("DEG"),
      "standard deviation of the headings by navigation [degrees], 0.001 to 180");
  add("shard", po::value<std::string>()->value_name("I/N"),
      "align only the I-th of N shares of the pairs, I from 1 to N: other runs do the rest");
  addThreadsOption(options);
  addReportOption(options);
  add("json", po::bool_switch(), "print survey.json");
  add("quiet", po::bool_switch(), "print nothing but errors");
  add("help,h", po::bool_switch(), "show this text");
  return options;
}

/// \throws UsageError unless it is I/N with I from 1 to N
std::optional<Shard> shardOf(const po::variables_map& values) {
  if (values.count("shard") == 0) return std::nullopt;
  const auto text = values["shard"].as<std::string>();
  std::istringstream stream(text);
  Shard shard;
  char slash = 0;
  const bool is_read = text.find('-') == std::string::npos &&
                       static_cast<bool>(stream >> shard.number >> slash >> shard.count) && stream.eof();
  if (!is_read || slash != '/' || shard.number < 1 || shard.number > shard.count)
    throw UsageError("--shard " + text + ": allowed is I/N, I from 1 to N");
  return shard;
}

SurveyRequest parseSurveyRequest(const po::variables_map& values) {
  SurveyRequest request;
  if (values.count("folder") == 0) throw UsageError("survey: no folder of sub-maps given");
  if (values.count("output") == 0 || values["output"].as<std::string>().empty())
    throw UsageError("survey: no output given: name a folder by -o DIR");
  request.directory = values["output"].as<std::string>();
  request.methods = chosenMethods(values);
  request.settings = alignmentSettings(values);
  request.sigmas.horizontal = within(values, "navigation-sigma", 1e-4, 1e4);
  request.sigmas.heading = within(values, "heading-sigma", 1e-3, 180);
  request.mapping = request.methods.front();
  for (const std::string& method : request.methods)
    if (method != DENSE_ICP) request.mapping = method;
  request.segmenters = makeSegmenters(request.methods, values, request.settings.version);
  request.shard = shardOf(values);
  request.surveys = tasksOf(values["folder"].as<std::vector<std::string>>(), request);
  return request;
}

/// The report of a survey, written beside its other results.
ordered_json report(const SurveyTask& task, const SurveyOutcome& outcome, const SurveyRequest& request) {
  ordered_json content = makeSurveyReport(outcome, request.mapping);
  if (!outcome.origins.is_null()) content["origins"] = outcome.origins;
  content["parameters"] = task.parameters;
  content["parameters"]["navigation-sigma"] = request.sigmas.horizontal;
  content["parameters"]["heading-sigma"] = request.sigmas.heading;
  writeText(task.directory + "/survey.json", asText(content));
  return content;
}

/// The report of several surveys together, with that of each under its name.
ordered_json reportTogether(const SurveyRequest& request, const SurveyOutcome& together,
                            const std::vector<ordered_json>& reports) {
  ordered_json content = makeSurveyReport(together, request.mapping);
  for (std::size_t n = 0; n < reports.size(); ++n) content["surveys"][request.surveys[n].name] = reports[n];
  writeText(request.directory + "/survey.json", asText(content));
  return content;
}

/// The shard's share of every survey.
void alignShards(SurveyRequest& request, Progress& progress, bool quiet) {
  for (const SurveyTask& task : request.surveys) {
    makeDirectory(task.directory);
    const std::size_t pairs = processShard(task, request, progress);
    progress.end();
    if (!quiet)
      std::cout << printable(task.name) << ": " << pairs << " pairs, shard " << request.shard->number
                << " of " << request.shard->count << '\n';
  }
}

void surveyFolders(const po::variables_map& values) {
  SurveyRequest request = parseSurveyRequest(values);
  const core::Threads threads(threadsOf(values));
  const bool quiet = values["quiet"].as<bool>();
  const std::string page = reportPath(values, request.directory);
  const OutputFolder folder(request.directory, request.shard ? FolderUse::TOGETHER : FolderUse::ALONE);
  Progress progress(quiet);
  if (request.shard) return alignShards(request, progress, quiet);
  std::vector<SurveyOutcome> outcomes;
  std::vector<ordered_json> reports;
  for (const SurveyTask& task : request.surveys) {
    std::optional<OutputFolder> own_folder;
    if (task.directory != request.directory) own_folder.emplace(task.directory);
    outcomes.push_back(processSurvey(task, request, progress));
    reports.push_back(report(task, outcomes.back(), request));
    progress.end();
    for (const LeftOut& file : outcomes.back().left_out) printWarning("left out: " + file.reason);
    if (!quiet)
      for (const FileRemark& file : outcomes.back().remarks) printWarning(file.path + ": " + file.remark);
  }
  if (outcomes.size() > 1) {
    outcomes.push_back(pooled(outcomes));
    reports.push_back(reportTogether(request, outcomes.back(), reports));
  }
  if (!page.empty()) writeText(page, surveyPage(request, outcomes, reports));
  if (values["json"].as<bool>())
    std::cout << asText(reports.back());
  else if (!quiet)
    for (const SurveyOutcome& outcome : outcomes) printSurvey(std::cout, outcome, request.mapping);
}

}  // namespace

void runSurvey(const std::vector<std::string>& arguments) {
  po::options_description shown;
  shown.add(surveyOptions()).add(alignmentOptions("none")).add(segmenterOptions());
  po::options_description all;
  all.add(shown).add_options()("folder", po::value<std::vector<std::string>>());
  po::positional_options_description positional;
  positional.add("folder", -1);
  const po::variables_map values = parseArguments("survey", arguments, all, positional);
  if (values["help"].as<bool>())
    std::cout << HELP_BEFORE << shown << HELP_AFTER;
  else
    surveyFolders(values);
}

}  // namespace pcl_fft_ground::cli
