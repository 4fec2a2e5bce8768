#include "commands/survey/survey_command.h"

#include <iostream>

#include "command_line.h"
#include "commands/segment/segment_report.h"
#include "commands/survey/survey_report.h"
#include "commands/survey/survey_run.h"
#include "io/output_file.h"
#include "progress.h"

namespace pcl_fft_ground::cli {
namespace {

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
  pairs.csv                         all results, a line per pair and method, written after each: a run that was broken
                                    off goes on where it stopped, if its parameters and sub-maps are the same.
                                    Transforms are between the points less their `origins` in survey.json, if any
  poses.csv                         pose of each sub-map by the global alignment: submap,x,y,z,qx,qy,qz,qw
  merged.pcd                        all sub-maps in one, a point per cubic centimetre, with the number of the sub-map;
                                    where coordinates are large the VIEWPOINT gives what is subtracted
  site_before.png site_after.png    the site as navigation has it and after global alignment
  survey.json parameters.json       both tables and the global alignment; the parameters. Of several folders DIR has a
                                    survey.json, too, of all of them

Examples:
  pcl_fft_ground simulate survey wreck -o wreck --points 200000
  pcl_fft_ground survey wreck -o result --max-object-size 1
  pcl_fft_ground survey site_1 site_2 site_3 -o results --max-object-size 1 --methods fft,fft+dense
  pcl_fft_ground survey wreck -o result_paper --paper --methods naive,planar,grid,fft-lowpass

Exit status: 0 done, 1 the work failed, 2 wrong usage.
)";

/// The report of a survey, written beside its other results.
ordered_json report(const SurveyTask& task, const SurveyOutcome& outcome, const SurveyRequest& request) {
  ordered_json content = makeSurveyReport(outcome, request.mapping);
  if (!outcome.origins.is_null()) content["origins"] = outcome.origins;
  content["parameters"] = task.parameters;
  content["parameters"]["navigation-sigma"] = request.trust.horizontal;
  content["parameters"]["heading-sigma"] = request.trust.heading;
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

void surveyFolders(const po::variables_map& values) {
  SurveyRequest request = parseSurveyRequest(values);
  const bool quiet = values["quiet"].as<bool>();
  makeDirectory(request.directory);
  Progress progress(quiet);
  std::vector<SurveyOutcome> outcomes;
  std::vector<ordered_json> reports;
  for (const SurveyTask& task : request.surveys) {
    makeDirectory(task.directory);
    outcomes.push_back(processSurvey(task, request, progress));
    reports.push_back(report(task, outcomes.back(), request));
  }
  progress.end();
  if (outcomes.size() > 1) {
    outcomes.push_back(pooled(outcomes));
    reports.push_back(reportTogether(request, outcomes.back(), reports));
  }
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
