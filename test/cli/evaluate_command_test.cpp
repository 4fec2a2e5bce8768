#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "errors.h"
#include "evaluate_fixture.h"
#include "methods/segmenter.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::json;

const Words METHODS{"naive", "planar", "grid", "graph-cut", "fft-lowpass"};
const std::string METHOD_LIST = "naive,planar,grid,graph-cut,fft-lowpass";

/// Objects and ground that were and were not found.
struct Count {
  double tp = 0, fp = 0, tn = 0, fn = 0;
};

class EvaluateCommand : public EvaluateFixture {
 protected:
  static json evaluateAsJson(const Words& words) { return json::parse(evaluate(words, {"--json"}).out); }

  /// Compares the labels that `segment` writes with those of the cloud, point by point.
  Count countBySegment(const std::string& cloud, const std::string& method) const {
    Words words{cloud, "-o", output(), "--method", method};
    words.insert(words.end(), SETTINGS.begin(), SETTINGS.end());
    run(runSegment, words);
    const std::vector<double> truth = valuesOf(readByPcl(cloud), "label");
    const std::vector<double> labels = valuesOf(readByPcl(outputOf("labelled.pcd")), "label");
    EXPECT_EQ(truth.size(), labels.size());
    std::map<std::pair<double, double>, double> counts;
    for (std::size_t n = 0; n < truth.size(); ++n) ++counts[{truth[n], labels[n]}];
    return {counts[{1, 1}], counts[{0, 1}], counts[{0, 0}], counts[{1, 0}]};
  }
};

/// The first line that has the word as its first one, split at blanks.
Words lineOf(const std::string& text, const std::string& word) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    Words found{std::istream_iterator<std::string>(words), {}};
    if (!found.empty() && found.front() == word) return found;
  }
  return {};
}

/// The lines of a table without quoted commas, as column name -> value.
std::vector<std::map<std::string, std::string>> readCsv(const std::string& text) {
  std::istringstream lines(text);
  Words names;
  std::vector<std::map<std::string, std::string>> rows;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    Words values;
    for (std::string value; std::getline(cells, value, ',');) values.push_back(value);
    if (names.empty()) {
      names = values;
      continue;
    }
    EXPECT_EQ(values.size(), names.size()) << line;
    rows.emplace_back();
    for (std::size_t n = 0; n < std::min(names.size(), values.size()); ++n) rows.back()[names[n]] = values[n];
  }
  return rows;
}

/// Checks the measures of a row against their definitions.
template <typename Row>
void expectScores(const Row& of, const Count& count) {
  const auto [tp, fp, tn, fn] = count;
  const double tolerance = 1e-8, all = tp + fp + tn + fn;
  EXPECT_EQ(of("tp"), tp);
  EXPECT_EQ(of("fp"), fp);
  EXPECT_EQ(of("tn"), tn);
  EXPECT_EQ(of("fn"), fn);
  EXPECT_NEAR(of("tpr"), tp / (tp + fn), tolerance);
  EXPECT_NEAR(of("tnr"), tn / (tn + fp), tolerance);
  EXPECT_NEAR(of("f1"), 2 * tp / (2 * tp + fp + fn), tolerance);
  EXPECT_NEAR(of("precision"), tp / (tp + fp), tolerance);
  EXPECT_NEAR(of("iou"), tp / (tp + fp + fn), tolerance);
  EXPECT_NEAR(of("total_error"), (fp + fn) / all, tolerance);
  const double chance = ((tp + fp) * (tp + fn) + (tn + fn) * (tn + fp)) / (all * all);
  EXPECT_NEAR(of("kappa"), ((tp + tn) / all - chance) / (1 - chance), tolerance);
  EXPECT_GE(of("seconds"), 0);
}

TEST_F(EvaluateCommand, JsonAndCsvAgreeWithTheLabelsThatSegmentWrites) {
  for (const std::string& cloud : {makeLabelledScan(), simulatePipes()}) {
    SCOPED_TRACE(cloud);
    const Words words{cloud, "--methods", METHOD_LIST, "--csv", pathOf("table.csv")};
    const json results = evaluateAsJson(words)["results"];
    const auto lines = readCsv(contentOf(pathOf("table.csv")));
    ASSERT_EQ(results.size(), METHODS.size());
    ASSERT_EQ(lines.size(), METHODS.size());
    for (std::size_t n = 0; n < METHODS.size(); ++n) {
      SCOPED_TRACE(METHODS[n]);
      const Count count = countBySegment(cloud, METHODS[n]);
      EXPECT_GT(count.tp, 0);
      EXPECT_GT(count.tn, 0);
      EXPECT_EQ(results[n]["method"], METHODS[n]);
      EXPECT_EQ(results[n]["cloud"], cloud);
      expectScores([&](const char* name) { return results[n][name].get<double>(); }, count);
      EXPECT_EQ(lines[n].at("method"), METHODS[n]);
      EXPECT_EQ(lines[n].at("cloud"), "\"" + cloud + "\"");
      expectScores([&](const char* name) { return std::stod(lines[n].at(name)); }, count);
      EXPECT_EQ(lines[n].at("failure"), "\"\"");
    }
  }
}

TEST_F(EvaluateCommand, PointsThatAreNeitherAreNotScored) {
  pcl::PointCloud<pcl::PointXYZL> cloud = boxScan();
  for (std::size_t n = 0; n < cloud.size(); n += 10) cloud[n].label = 2;
  cloud[1].z = std::numeric_limits<float>::quiet_NaN();
  const std::string path = makeCloud("some.pcd", cloud);
  const json row = evaluateAsJson({path, "--methods", "naive"})["results"][0];
  const double scored = static_cast<double>(row["tp"]) + static_cast<double>(row["fp"]) +
                        static_cast<double>(row["tn"]) + static_cast<double>(row["fn"]);
  EXPECT_EQ(scored, 10000 - 1000 - 1);
}

TEST_F(EvaluateCommand, PrintsATableWithALinePerMethod) {
  const Words words{makeLabelledScan(), "--methods", METHOD_LIST};
  const std::string table = evaluate(words, {"--quiet"}).out;
  const json results = evaluateAsJson(words)["results"];
  EXPECT_EQ(table.substr(0, table.find('\n')), "box.pcd");
  const Words head = lineOf(table, "tpr");
  ASSERT_GE(head.size(), 3u);
  EXPECT_EQ(head[1], "tnr");
  EXPECT_EQ(head[2], "f1");
  for (std::size_t n = 0; n < METHODS.size(); ++n) {
    SCOPED_TRACE(METHODS[n]);
    const Words line = lineOf(table, METHODS[n]);
    ASSERT_EQ(line.size(), head.size() + 1);
    for (const std::size_t column : {0u, 1u, 2u})
      EXPECT_NEAR(std::stod(line[column + 1]), results[n][head[column]].get<double>(), 0.0005001);
  }
  EXPECT_EQ(table.find("mean of"), std::string::npos);
}

TEST_F(EvaluateCommand, MeansAreTakenOverTheClouds) {
  const Words words{makeLabelledScan(), simulatePipes(), "--methods", "naive,grid"};
  const json all = evaluateAsJson(words);
  const json& results = all["results"];
  ASSERT_EQ(results.size(), 4u);
  for (const std::string measure : {"tpr", "tnr", "f1", "surface_rmse"}) {
    SCOPED_TRACE(measure);
    EXPECT_NEAR(all["means"]["naive"][measure].get<double>(),
                0.5 * (results[0][measure].get<double>() + results[2][measure].get<double>()), 1e-12);
    EXPECT_NEAR(all["means"]["grid"][measure].get<double>(),
                0.5 * (results[1][measure].get<double>() + results[3][measure].get<double>()), 1e-12);
  }
  const std::string table = evaluate(words).out;
  const std::string means = table.substr(table.find("mean of 2 clouds"));
  const Words line = lineOf(means, "naive");
  ASSERT_GE(line.size(), 2u);
  EXPECT_NEAR(std::stod(line[1]), all["means"]["naive"]["tpr"].get<double>(), 0.0005001);
}

TEST_F(EvaluateCommand, AMethodThatFailsHasItsReasonInTheTable) {
  const Words words{makeLabelledScan(), "--methods", "naive,grid,graph-cut,fft-lowpass",
                    "--cell-size",      "1e-9",      "--csv",
                    pathOf("table.csv")};
  const std::string table = run(runEvaluate, words).out;
  const auto lines = readCsv(contentOf(pathOf("table.csv")));
  Words for_json = words;
  for_json.push_back("--json");
  const json results = json::parse(run(runEvaluate, for_json).out)["results"];
  ASSERT_EQ(results.size(), 4u);
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_FALSE(results[0].contains("failure"));
  EXPECT_GT(results[0]["tpr"].get<double>(), 0.5);
  for (const std::size_t n : {1u, 2u, 3u}) {
    const std::string method = results[n]["method"];
    SCOPED_TRACE(method);
    const std::string reason = results[n].value("failure", "");
    EXPECT_NE(reason.find("use larger cells"), std::string::npos) << reason;
    EXPECT_TRUE(results[n]["tpr"].is_null());
    EXPECT_EQ(lines[n].at("failure"), "\"" + reason + "\"");
    EXPECT_EQ(lines[n].at("f1"), "");
    std::string line;
    for (const std::string& word : lineOf(table, method)) line += (line.empty() ? "" : " ") + word;
    EXPECT_EQ(line, method + " " + reason);
  }
}

const Words PCL_SETTINGS{"--pmf-cell-size",        "0.04", "--pmf-max-window-size", "12",
                         "--pmf-initial-distance", "0.06", "--pmf-slope",           "0.3"};

TEST_F(EvaluateCommand, PclsOwnFiltersAreComparedWith) {
  pcl::PointCloud<pcl::PointXYZL> cloud = boxScan();
  cloud[5].x = NAN;  // PCL's own crash on the one, and ask for a grid around the other
  cloud[7].z = 1e7f;
  Words words{makeCloud("box.pcd", cloud),
              "--methods",
              "pcl-approximate-pmf,pcl-pmf,pcl-mlesac-plane",
              "--json",
              "--quiet",
              "--distance-threshold",
              "0.05"};
  words.insert(words.end(), PCL_SETTINGS.begin(), PCL_SETTINGS.end());
  const json all = json::parse(run(runEvaluate, words).out);
  ASSERT_EQ(all["results"].size(), 3u);
  EXPECT_EQ(all["results"][0]["method"], "pcl-approximate-pmf");
  for (const json& row : all["results"]) {
    SCOPED_TRACE(row.dump());
    ASSERT_FALSE(row.contains("failure"));
    EXPECT_GT(row["tpr"].get<double>(), 0.95);
    EXPECT_GT(row["tnr"].get<double>(), 0.95);
    EXPECT_TRUE(row["surface_rmse"].is_null());
  }
}

TEST_F(EvaluateCommand, PclsFiltersThatCannotRunHaveTheReasonInTheTable) {
  const std::string cloud = makeLabelledScan();
  const auto failureOf = [&](const Words& more) {
    Words words{cloud, "--methods", "pcl-pmf", "--json", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return json::parse(run(runEvaluate, words).out)["results"][0].value("failure", "");
  };
  // All points in each window: 1e8 pairs for each of many windows.
  EXPECT_EQ(failureOf({"--pmf-max-window-size", "100000", "--pmf-base", "1.1", "--pcl-time-limit", "0.05"}),
            "not run: more than 0.05 s (--pcl-time-limit)");
  EXPECT_NE(failureOf({"--pmf-cell-size", "1e-6"}).find("use larger cells"), std::string::npos);
}

TEST_F(EvaluateCommand, PclsFiltersRunOnlyWhereAskedFor) {
  const json all = evaluateAsJson({makeLabelledScan()});
  EXPECT_EQ(all["results"].size(), methodNames().size());
  for (const json& row : all["results"]) EXPECT_NE(row["method"].get<std::string>().substr(0, 3), "pcl");
  EXPECT_THROW(segment(makeScan(), {"--method", "pcl-pmf"}), UsageError);
}

TEST_F(EvaluateCommand, WarningsGoToStandardErrorUnlessQuiet) {
  pcl::PointCloud<pcl::PointXYZL> cloud = boxScan();
  cloud[0].x = 1e6f;
  const std::string path = makeCloud("far.pcd", cloud);
  const Printed printed = evaluate({path, "--methods", "naive"});
  EXPECT_NE(printed.err.find("warning: " + path + ": naive: "), std::string::npos) << printed.err;
  EXPECT_EQ(evaluate({path, "--methods", "naive", "--quiet"}).err, "");
}

TEST_F(EvaluateCommand, ShowsItsHelp) {
  const std::string help = run(runEvaluate, {"--help"}).out;
  for (const char* word : {"evaluate CLOUD", "--methods", "--csv", "--json", "--cell-size", "Exit status"})
    EXPECT_NE(help.find(word), std::string::npos) << word;
}

}  // namespace
}  // namespace pcl_fft_ground::cli
