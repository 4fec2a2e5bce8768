#include "survey/survey_command.h"

#include <iostream>

#include "command_line.h"
#include "io/output_file.h"
#include "io/pose_table.h"
#include "progress.h"
#include "segment/segment_report.h"
#include "survey/survey_record.h"
#include "survey/survey_report.h"
#include "survey/survey_request.h"

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

/// Aligns what the record does not have yet.
std::vector<PairResult> alignPairs(SurveyRequest& request, const SurveyFolder& survey, Progress& progress) {
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
  SurveyRequest request = parseSurveyRequest(values);
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
  shown.add(surveyOptions()).add(alignmentOptions("none")).add(segmenterOptions());
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
