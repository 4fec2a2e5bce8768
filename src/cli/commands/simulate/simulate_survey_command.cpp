#include <boost/program_options.hpp>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <system_error>

#include <mutex>

#include "command_line.h"
#include "commands/simulate/simulated_scan.h"
#include "errors.h"
#include "io/output_file.h"
#include "io/pose_table.h"
#include "pcl_fft_ground/simulation/survey_simulation.h"
#include "printable.h"
#include "progress.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {

namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;

constexpr double HARD_DRIFT = 0.01;  // [m]

constexpr const char* HELP_BEFORE = R"(Usage: pcl_fft_ground simulate survey wreck|pipes|bare -o DIR [options]

Simulates a survey whose truth is known. A vehicle runs transects to and fro over a site and crosses them twice at the
end; wreck is 16 m x 10 m of amphorae on mounds in 32 sub-maps of 4 m x 4 m, pipes is 16 m x 6 m of pipes and stones
in 26 sub-maps of 6 m x 1.5 m; bare is 68 m x 44 m of sea floor without objects, a metre of relief in waves of 3 to
30 m, seen by a sonar in 21 sub-maps of 20 m x 20 m. Neighbours overlap by 30 to 60 %. DIR is made if need be and
receives submap_00.pcd, submap_01.pcd ... (x y z [m] in the sub-map's own frame, label, segment; the VIEWPOINT is the
pose by navigation, which is wrong by centimetres to --navigation-error and by up to --heading-error) and truth.csv,
the true poses. Equal seeds give equal surveys.

)";

constexpr const char* HELP_AFTER = R"(
Example: a survey, and what becomes of it:
  pcl_fft_ground simulate survey wreck -o wreck --seed 7 --points 200000
  pcl_fft_ground survey wreck -o wreck_result
)";

struct Request {
  core::SurveyParameters parameters;
  long long seed = parameters.seed;
  long long points = static_cast<long long>(parameters.points);
  std::string site;
  std::string output;
  bool hard = false;
  bool help = false;
  bool quiet = false;
  bool json = false;
};

po::options_description describeOptions(Request& request) {
  core::SurveyParameters& p = request.parameters;
  const auto number = [](auto& value, const char* shown, const char* unit) {
    return po::value(&value)->default_value(value, shown)->value_name(unit);
  };
  po::options_description options("Options", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add = options.add_options();
  add("output,o", po::value(&request.output)->value_name("DIR"),
      "folder for the sub-maps; other files in it stay");
  add("seed", number(request.seed, "1", "N"), "equal seeds give equal surveys: 0 to 4294967295");
  add("points", number(request.points, "600000", "N"), "points of each sub-map: 1 to 100000000; bare: 6400");
  add("hard", po::bool_switch(&request.hard), "with 1 cm of drift inside each sub-map");
  add("object-share", number(p.object_share, "0.3", "SHARE"),
      "share of object points amid the site: 0 to 0.8; bare: 0");
  add("noise", number(p.noise, "0.003", "M"), "standard deviation of the range [m]: 0 to 0.1; bare: 0.02");
  add("navigation-error", number(p.navigation_error, "0.2", "M"),
      "largest horizontal error of a pose by navigation [m]: 0 to 5; bare: 1");
  add("heading-error", number(p.heading_error, "3", "DEG"),
      "largest error of its heading [degrees]: 0 to 45; bare: 2");
  add("quiet", po::bool_switch(&request.quiet), "print nothing");
  add("json", po::bool_switch(&request.json), "print the summary as JSON");
  addThreadsOption(options);
  add("help,h", po::bool_switch(&request.help), "show this text");
  return options;
}

po::variables_map parse(const std::vector<std::string>& arguments, const po::options_description& options,
                        Request& request) {
  po::options_description all;
  all.add(options).add_options()("site", po::value(&request.site));
  po::positional_options_description positional;
  positional.add("site", 1);
  return parseArguments("simulate survey", arguments, all, positional);
}

/// What was not asked for is as it suits a bare site.
void setBareDefaults(const po::variables_map& values, Request& request) {
  const core::SurveyParameters asked = request.parameters;
  core::SurveyParameters& p = request.parameters;
  p = core::surveyParametersFor(core::SceneKind::BARE);
  const auto given = [&](const char* option) { return !values[option].defaulted(); };
  if (given("object-share")) p.object_share = asked.object_share;
  if (given("noise")) p.noise = asked.noise;
  if (given("navigation-error")) p.navigation_error = asked.navigation_error;
  if (given("heading-error")) p.heading_error = asked.heading_error;
  if (!given("points")) request.points = static_cast<long long>(p.points);
}

void checkComplete(const po::variables_map& values, Request& request) {
  if (request.site != "wreck" && request.site != "pipes" && request.site != "bare")
    throw UsageError(
        "simulate survey: " + (request.site.empty() ? "no site given" : "site '" + request.site + "'") +
        ": allowed is wreck, pipes or bare");
  if (request.site == "pipes") request.parameters.site = core::SceneKind::PIPES;
  if (request.site == "bare") setBareDefaults(values, request);
  request.parameters.seed = toCount<std::uint32_t>("seed", request.seed, 4294967295);
  request.parameters.points = toCount<std::size_t>("points", request.points, 100000000);
  request.parameters.drift = request.hard ? HARD_DRIFT : 0.0;
  if (request.output.empty()) throw UsageError("simulate survey: no output given: name a folder by -o DIR");
}

core::SurveySimulation makeSurvey(const core::SurveyParameters& parameters) {
  std::optional<core::SurveySimulation> survey;
  withOptionNames([&] { survey.emplace(parameters); });
  return std::move(*survey);
}

std::string fileName(std::size_t index) {
  return std::string("submap_") + (index < 10 ? "0" : "") + std::to_string(index) + ".pcd";
}

/// Takes an earlier survey out of the folder, so that what is found there belongs together.
void removeEarlierSurvey(const std::string& folder) {
  const std::string truth = folder + "/truth.csv";
  std::error_code ignored;
  if (!fs::exists(truth, ignored)) return;
  for (const NamedPose& pose : readPoses(truth))
    fs::remove(fs::path(folder) / fs::path(pose.submap).filename(), ignored);
  fs::remove(truth, ignored);
}

void writeSurvey(const Request& request, const core::SurveySimulation& survey, Progress& progress) {
  const OutputFolder folder(request.output);
  removeEarlierSurvey(request.output);
  std::vector<NamedPose> truth(survey.size());
  std::mutex shown;
  core::forEachPart(static_cast<Eigen::Index>(survey.size()), [&](Eigen::Index part) {
    const auto i = static_cast<std::size_t>(part);
    {
      const std::lock_guard<std::mutex> lock(shown);
      progress.begin("scan", "sub-map " + std::to_string(i + 1) + " of " + std::to_string(survey.size()));
    }
    const core::SimulatedSubmap submap = survey.submap(i);
    writeSimulatedScan(request.output + "/" + fileName(i), submap.scan, submap.world_from_navigation);
    truth[i] = {fileName(i), submap.scan.world_from_scan};
  });
  progress.end();
  writeText(request.output + "/truth.csv", asCsv(truth));
}

void printSummary(const Request& request, std::size_t submaps) {
  if (request.json) {
    std::cout << asText({{"folder", request.output},
                         {"site", request.site},
                         {"seed", request.parameters.seed},
                         {"submaps", submaps},
                         {"points_per_submap", request.parameters.points},
                         {"drift", request.parameters.drift}});
  } else if (!request.quiet) {
    std::cout << request.site << ": " << submaps << " sub-maps of " << request.parameters.points
              << " points and truth.csv, written to " << printable(request.output) << "\n";
  }
}

}  // namespace

void runSimulateSurvey(const std::vector<std::string>& arguments) {
  Request request;
  const po::options_description options = describeOptions(request);
  const po::variables_map values = parse(arguments, options, request);
  if (request.help) {
    std::cout << HELP_BEFORE << options << HELP_AFTER;
    return;
  }
  const core::Threads threads(threadsOf(values));
  checkComplete(values, request);
  Progress progress(request.quiet || request.json);
  progress.begin("site", "building the site");
  const core::SurveySimulation survey = makeSurvey(request.parameters);
  writeSurvey(request, survey, progress);
  printSummary(request, survey.size());
}

}  // namespace pcl_fft_ground::cli
