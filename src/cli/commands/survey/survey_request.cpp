#include "commands/survey/survey_request.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <system_error>

#include "command_line.h"
#include "commands/survey/survey_folder.h"
#include "commands/survey/survey_pair.h"
#include "errors.h"

namespace pcl_fft_ground::cli {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using nlohmann::ordered_json;

void requireMethod(const std::string& name) {
  const std::vector<std::string> segmenters = methodNames();
  std::string allowed;
  for (const std::string& segmenter : segmenters) {
    if (segmenterOf(name) == segmenter) return;
    allowed += segmenter + ", ";
  }
  if (name != DENSE_ICP)
    throw UsageError("--methods " + name + ": allowed are " + allowed + DENSE_ICP +
                     ", all but the last with or without " + WITH_FALLBACK);
}

std::vector<std::string> chosenMethods(const po::variables_map& values) {
  std::vector<std::string> names = methodNames();
  names.push_back(DENSE_ICP);
  names.push_back(std::string("fft") + WITH_FALLBACK);
  if (values.count("methods") == 0) return names;
  names.clear();
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
  ordered_json parameters{{"folder", absolutePath(folder).string()},
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

}  // namespace

po::options_description surveyOptions() {
  const NavigationTrust trust;
  po::options_description options("General", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add = options.add_options();
  add("output,o", po::value<std::string>()->value_name("DIR"),
      "directory for the results; other files in it stay");
  add("methods", po::value<std::string>()->value_name("NAMES"),
      "methods, parted by commas; the last one but dense-icp makes the map "
      "(naive,planar,grid,graph-cut,fft-lowpass,fft,dense-icp,fft+dense)");
  add("navigation-sigma", po::value<double>()->default_value(trust.horizontal, "0.1")->value_name("M"),
      "standard deviation of the places by navigation [m], 0.0001 to 10000");
  add("heading-sigma", po::value<double>()->default_value(trust.heading, "2")->value_name("DEG"),
      "standard deviation of the headings by navigation [degrees], 0.001 to 180");
  add("json", po::bool_switch(), "print survey.json");
  add("quiet", po::bool_switch(), "print nothing but errors");
  add("help,h", po::bool_switch(), "show this text");
  return options;
}

SurveyRequest parseSurveyRequest(const po::variables_map& values) {
  SurveyRequest request;
  if (values.count("folder") == 0) throw UsageError("survey: no folder of sub-maps given");
  if (values.count("output") == 0 || values["output"].as<std::string>().empty())
    throw UsageError("survey: no output given: name a folder by -o DIR");
  request.directory = values["output"].as<std::string>();
  request.methods = chosenMethods(values);
  request.settings = alignmentSettings(values);
  request.trust = {within(values, "navigation-sigma", 1e-4, 1e4), within(values, "heading-sigma", 1e-3, 180)};
  request.mapping = request.methods.front();
  for (const std::string& method : request.methods)
    if (method != DENSE_ICP) request.mapping = method;
  request.segmenters = makeSegmenters(request.methods, values, request.settings.version);
  request.surveys = tasksOf(values["folder"].as<std::vector<std::string>>(), request);
  return request;
}

}  // namespace pcl_fft_ground::cli
