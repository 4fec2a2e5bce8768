// How many overlapping scans of simulated surveys are aligned, how well, and in what time beside the k-d tree
// that pcl::Registration would build: the shares pooled over several sites, with their lower 90 % bounds.

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>

#include <boost/program_options.hpp>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/survey/survey_tables.h"
#include "pcl_fft_ground/simulation/simulation.h"
#include "survey_trials.h"
#include "trial_file.h"

namespace {

namespace core = pcl_fft_ground::core;
namespace po = boost::program_options;

struct Request {
  unsigned seeds = 10, first_seed = 101;
  std::size_t points = 200000;
  double least_overlap = 0.3;
  bool without_fallback = false;
  std::string sites = "wreck,pipes";
  std::string only;
  std::string csv;

  bool wants(const std::string& row) const { return row.find(only) != std::string::npos; }
  bool includes(const std::string& site) const { return sites.find(site) != std::string::npos; }
};

/// CPU time of building the tree of 600,000 points, time and again: the machine's speed may change.
class TreeBuild {
 public:
  TreeBuild() : cloud_(new pcl::PointCloud<pcl::PointXYZ>) {
    const core::SimulatedScan scan = core::simulateScan({});
    for (Eigen::Index n = 0; n < scan.points.cols(); ++n)
      cloud_->push_back({scan.points(0, n), scan.points(1, n), scan.points(2, n)});
  }

  double seconds() const {
    const std::clock_t begun = std::clock();
    pcl::KdTreeFLANN<pcl::PointXYZ> tree;
    tree.setInputCloud(cloud_);
    return static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  }

 private:
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud_;
};

/// A line of the table.
struct Row {
  std::string name;
  core::SearchMode mode = core::SearchMode::NAVIGATION;
  TrialResults results = {};
  std::vector<double> tree_seconds = {};
};

/// What the rows are made from and where their trials are listed.
struct Benchmark {
  Request request;
  TreeBuild tree = {};
  TrialFile file = TrialFile(request.csv);
};

void runAll(const std::vector<Trial>& trials, Benchmark& benchmark, Row& row) {
  constexpr std::size_t TRIALS_PER_TREE = 8;
  if (!benchmark.request.wants(row.name)) return;
  core::AlignmentParameters parameters;
  parameters.gates = core::gatesOf(row.mode);
  if (benchmark.request.without_fallback) parameters.fallback = core::Fallback::NONE;
  for (const Trial& trial : trials) {
    if (row.results.trials % TRIALS_PER_TREE == 0) row.tree_seconds.push_back(benchmark.tree.seconds());
    const TrialOutcome outcome = run(trial, parameters);
    row.results.add(outcome);
    benchmark.file.add(row.name, trial, outcome);
  }
}

void print(const Row& row) {
  const TrialResults& r = row.results;
  if (r.trials == 0) return;
  const auto millimetres = [&](double share) { return 1e3 * core::quantileOf(r.errors, share).value_or(0); };
  const double ratio =
      core::quantileOf(r.seconds, 0.5).value_or(0) / core::quantileOf(row.tree_seconds, 0.5).value_or(1);
  const double share = static_cast<double>(r.accepted) / static_cast<double>(r.trials);
  std::printf("%-32s %5zu %7zu %5zu %6.1f %6.1f %5zu %7.2f %7.2f %9.2f\n", row.name.c_str(), r.trials,
              r.accepted, r.dense, 100 * share, 100 * core::lowerBound(r.accepted, r.trials), r.wrong,
              millimetres(0.5), millimetres(0.9), ratio);
  std::fflush(stdout);
}

std::vector<TrialSurvey> makeSurveys(core::SceneKind site, double drift, const Request& request) {
  std::vector<TrialSurvey> surveys;
  for (unsigned n = 0; n < request.seeds; ++n) {
    core::SurveyParameters parameters;
    parameters.site = site;
    parameters.seed = request.first_seed + n;
    parameters.points = request.points;
    parameters.drift = drift;
    surveys.push_back(makeSurvey(parameters));
    std::cerr << "made survey " << n + 1 << " of " << request.seeds << "\n";
  }
  return surveys;
}

std::vector<Trial> thinned(std::vector<Trial> trials, const TrialSurvey& survey) {
  for (Trial& trial : trials)
    for (const TrialScan& scan : survey)
      if (trial.moving == &scan.segments) {
        trial.moving = &scan.thinned;
        break;
      }
  return trials;
}

/// All rows of one site.
void benchmarkSite(const std::string& name, const std::vector<TrialSurvey>& surveys, Benchmark& benchmark) {
  Row navigation{name}, thin{name + ", one thinned to 10 %"};
  Row shifted{name + ", 2 m off", core::SearchMode::WIDE};
  Row turned{name + ", 1 m and 20 deg off", core::SearchMode::WIDE};
  for (std::size_t n = 0; n < surveys.size(); ++n) {
    const std::vector<Trial> pairs = overlappingPairs(surveys[n], benchmark.request.least_overlap);
    const auto seed = static_cast<unsigned>(n + 1);
    runAll(pairs, benchmark, navigation);
    runAll(thinned(pairs, surveys[n]), benchmark, thin);
    runAll(misguided(pairs, {2, 0}, seed), benchmark, shifted);
    runAll(misguided(pairs, {1, 20}, seed), benchmark, turned);
  }
  for (const Row* row : {&navigation, &thin, &shifted, &turned}) print(*row);
}

void benchmarkHardSite(const std::string& name, core::SceneKind site, Benchmark& benchmark) {
  constexpr double DRIFT = 0.01;
  Row row{name + ", hard"};
  if (!benchmark.request.wants(row.name)) return;
  for (const TrialSurvey& survey : makeSurveys(site, DRIFT, benchmark.request))
    runAll(overlappingPairs(survey, benchmark.request.least_overlap), benchmark, row);
  print(row);
}

void benchmarkDifferentPlaces(const std::string& name, const std::vector<TrialSurvey>& moving,
                              const std::vector<TrialSurvey>& reference, Benchmark& benchmark) {
  Row row{name};
  for (std::size_t n = 0; n < moving.size(); ++n)
    runAll(differentPlaces(moving[n], reference[(n + 1) % reference.size()], static_cast<unsigned>(n + 1)),
           benchmark, row);
  print(row);
}

/// All conditions of one kind of site. \return its surveys without drift
std::vector<TrialSurvey> benchmarkKind(const std::string& name, core::SceneKind site, Benchmark& benchmark) {
  if (!benchmark.request.includes(name)) return {};
  std::vector<TrialSurvey> surveys = makeSurveys(site, 0, benchmark.request);
  benchmarkSite(name, surveys, benchmark);
  benchmarkDifferentPlaces("different " + name, surveys, surveys, benchmark);
  benchmarkHardSite(name, site, benchmark);
  return surveys;
}

void benchmarkAll(const Request& request) {
  Benchmark benchmark{request};
  std::printf("%-32s %5s %7s %5s %6s %6s %5s %7s %7s %9s\n", "", "pairs", "aligned", "dense", "%", ">= %",
              "wrong", "median", "90 %", "time/tree");
  const auto wreck = benchmarkKind("wreck", core::SceneKind::WRECK, benchmark);
  const auto pipes = benchmarkKind("pipes", core::SceneKind::PIPES, benchmark);
  if (!wreck.empty() && !pipes.empty()) benchmarkDifferentPlaces("pipes on wreck", pipes, wreck, benchmark);
}

}  // namespace

int main(int argc, char** argv) try {
  Request request;
  po::options_description options("alignment_benchmark: alignment of simulated surveys, pooled over sites");
  auto add = options.add_options();
  add("seeds", po::value(&request.seeds)->default_value(request.seeds), "sites of each kind, 2 or more");
  add("first-seed", po::value(&request.first_seed)->default_value(request.first_seed),
      "seed of the first site");
  add("points", po::value(&request.points)->default_value(request.points), "points of each sub-map");
  add("least-overlap", po::value(&request.least_overlap)->default_value(request.least_overlap, "0.3"),
      "pairs of which both see at least this share of the smaller sub-map, in (0, 1]");
  add("sites", po::value(&request.sites)->default_value(request.sites), "wreck, pipes or both");
  add("only", po::value(&request.only)->default_value(""), "only rows with this in their name, such as hard");
  add("csv", po::value(&request.csv)->value_name("FILE"), "writes a line for each pair");
  add("segments-only", po::bool_switch(&request.without_fallback), "without the dense fallback");
  add("help", "show this text");
  po::variables_map values;
  po::store(po::parse_command_line(argc, argv, options), values);
  po::notify(values);
  if (values.count("help") != 0) {
    std::cout << options
              << "Times are medians of CPU time, over that of building pcl::KdTreeFLANN of 600,000 points;\n"
                 "errors are in mm, of the aligned pairs, amid the overlap.\n";
    return 0;
  }
  benchmarkAll(request);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "alignment_benchmark: " << error.what() << "\n";
  return 2;
}
