#include "commands/commands.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "errors.h"
#include "survey_fixture.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::json;

class SurveyCommand : public SurveyFixture {
 protected:
  Printed survey(const Words& more = {}) const {
    return run(runSurvey, with({site_, "-o", output(), "--max-object-size", "1"}, more));
  }
};

TEST_F(SurveyCommand, TheSimulatedSurveyHasPosesByNavigationAndByTruth) {
  EXPECT_EQ(readPoses(site_ + "/truth.csv").size(), 26u);
  pcl::PCLPointCloud2 cloud;
  Eigen::Vector4f origin;
  Eigen::Quaternionf orientation;
  int version = 0;
  ASSERT_EQ(pcl::PCDReader().read(submap(1), cloud, origin, orientation, version), 0);
  EXPECT_EQ(pointCount(cloud), 60000u);
  const NamedPose pose = readPoses(site_ + "/truth.csv")[1];
  const double error =
      (pose.world_from_submap.translation() - origin.head<3>().cast<double>()).head<2>().norm();
  EXPECT_GT(error, 0.01);
  EXPECT_LT(error, 0.21);
}

TEST_F(SurveyCommand, SurveyWritesItsResults) {
  const Printed printed = survey({"--methods", "fft,dense-icp,fft+dense"});
  EXPECT_NE(printed.out.find("Table II"), std::string::npos);
  const json report = json::parse(contentOf(outputOf("survey.json")));
  EXPECT_EQ(report["submaps"], 4);
  ASSERT_EQ(report["crispness"].size(), 3u);
  const json& row = report["crispness"][2];
  EXPECT_EQ(row["method"], "fft+dense");
  EXPECT_EQ(row["rose"].get<int>() + row["fell"].get<int>() + row["not_computed"].get<int>() +
                row["unprocessed"].get<int>(),
            4);
  EXPECT_EQ(report["accuracy"][2]["wrong_by_more_than_5_cm"], 0);
  EXPECT_EQ(report["global"]["method"], "fft+dense");
  const json& placements = report["global"]["placements"];
  EXPECT_LT(placements["global"]["occupied_voxels"], placements["navigation"]["occupied_voxels"]);
  EXPECT_LT(placements["global"]["errors"]["translation_rms"],
            placements["navigation"]["errors"]["translation_rms"]);

  EXPECT_EQ(readPoses(outputOf("poses.csv")).size(), 4u);
  const std::vector<double> numbers = valuesOf(readByPcl(outputOf("merged.pcd")), "submap");
  EXPECT_EQ(std::set<double>(numbers.begin(), numbers.end()), (std::set<double>{0, 1, 2, 3}));
  for (const char* name : {"site_before.png", "site_after.png", "parameters.json"})
    EXPECT_TRUE(std::filesystem::exists(outputOf(name))) << name;
}

TEST_F(SurveyCommand, GoesOnWhereItWasBrokenOff) {
  survey({"--methods", "fft", "--quiet"});
  const std::string whole = contentOf(outputOf("pairs.csv"));
  // As after two pairs, with a mark that a new result would not have.
  std::istringstream lines(whole);
  std::string line, broken_off;
  for (int n = 0; n < 3 && std::getline(lines, line); ++n) broken_off += line + "\n";
  const std::string marked = broken_off.substr(0, broken_off.size() - 2) + "MARK\"\n";
  makeFile("out/pairs.csv", marked);
  survey({"--methods", "fft", "--quiet"});
  const std::string resumed = contentOf(outputOf("pairs.csv"));
  EXPECT_EQ(resumed.rfind(marked, 0), 0u);
  EXPECT_EQ(std::count(resumed.begin(), resumed.end(), '\n'), std::count(whole.begin(), whole.end(), '\n'));

  std::string parameters = contentOf(outputOf("parameters.json"));
  const std::string version = json::parse(parameters)["version"];
  parameters.replace(parameters.find(version), version.size(), version + "1");
  makeFile("out/parameters.json", parameters);
  survey({"--methods", "fft", "--quiet"});
  EXPECT_EQ(contentOf(outputOf("pairs.csv")).find("MARK"), std::string::npos) << "pairs of another version";

  makeFile("out/pairs.csv", marked);
  survey({"--methods", "fft", "--quiet", "--min-matches", "4"});
  EXPECT_EQ(contentOf(outputOf("pairs.csv")).find("MARK"), std::string::npos);
}

/// pairs.csv without the seconds.
std::string withoutSeconds(const std::string& csv) {
  constexpr int SECONDS = 15;  // column
  std::istringstream lines(csv);
  std::string result;
  for (std::string line; std::getline(lines, line); result += '\n') {
    std::istringstream fields(line);
    std::string field;
    for (int n = 0; std::getline(fields, field, ','); ++n) result += (n == SECONDS ? "" : field) + ",";
  }
  return result;
}

TEST_F(SurveyCommand, ShardsAndThreadsGiveTheSamePairs) {
  survey({"--methods", "fft", "--quiet", "--threads", "1"});
  const std::string expected = withoutSeconds(contentOf(outputOf("pairs.csv"))),
                    poses = contentOf(outputOf("poses.csv"));
  std::filesystem::remove_all(output());
  survey({"--methods", "fft", "--quiet", "--threads", "3"});
  EXPECT_EQ(withoutSeconds(contentOf(outputOf("pairs.csv"))), expected);
  EXPECT_EQ(contentOf(outputOf("poses.csv")), poses);
  std::filesystem::remove_all(output());
  survey({"--methods", "fft", "--quiet", "--shard", "2/3"});
  survey({"--methods", "fft", "--quiet", "--shard", "1/3"});
  EXPECT_FALSE(std::filesystem::exists(outputOf("pairs.csv")));
  survey({"--methods", "fft", "--quiet"});
  EXPECT_EQ(withoutSeconds(contentOf(outputOf("pairs.csv"))), expected);
  EXPECT_EQ(contentOf(outputOf("poses.csv")), poses);
  for (const char* shard : {"0/3", "4/3", "1", "1/", "a/b", "-1/3"})
    EXPECT_THROW(survey({"--shard", shard}), UsageError) << shard;
}

TEST_F(SurveyCommand, WhatIsNoSubmapIsLeftOutAndCounted) {
  const std::string folder = copyOfTwo("other");
  std::filesystem::remove(folder + "/truth.csv");
  std::filesystem::copy_file(submap(2), folder + "/SUBMAP_02.PCD");
  makeFile("other/broken.pcd", "VERSION 0.7\nnothing of the kind\n");
  makeFile("other/nowhere.pcd",
           "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 1\nDATA ascii\nnan nan nan\nnan 1 2\n");
  const Printed printed =
      run(runSurvey, {folder, "-o", output(), "--max-object-size", "1", "--methods", "fft", "--json"});
  const json report = json::parse(printed.out);
  EXPECT_EQ(report["submaps"], 3);
  EXPECT_EQ(report["left_out"], 2);
  EXPECT_EQ(report["left_out_files"][0]["submap"], "broken.pcd");
  for (const char* name : {"broken.pcd", "nowhere.pcd"})
    EXPECT_NE(printed.err.find(name), std::string::npos) << printed.err;
  EXPECT_EQ(std::count(printed.err.begin(), printed.err.end(), '\n'), 2);
  EXPECT_EQ(readPoses(outputOf("poses.csv")).size(), 3u);
  std::filesystem::remove(folder + "/submap_01.pcd");
  std::filesystem::remove(folder + "/SUBMAP_02.PCD");
  EXPECT_THROW(run(runSurvey, {folder, "-o", output()}), WorkError);
}

TEST_F(SurveyCommand, TellsWhatThereIsToSayOfTheFiles) {
  const std::string folder = copyOfTwo("remarks");
  makeFile("remarks/submap_00.pcd", withEmptyField(contentOf(submap(0))));
  const Words words{folder, "-o", output(), "--max-object-size", "1", "--methods", "fft"};
  const std::string remark = folder + "/submap_00.pcd: its field 'empty' has COUNT 0 and is left out";
  EXPECT_NE(run(runSurvey, words).err.find("warning: " + remark), std::string::npos);
  const json report = json::parse(contentOf(outputOf("survey.json")));
  EXPECT_EQ(report["warnings"], json::array({remark}));
  EXPECT_EQ(run(runSurvey, with(words, {"--quiet"})).err, "");
}

TEST_F(SurveyCommand, AMethodThatCannotRunSaysWhyAndTheOthersGoOn) {
  const Printed printed = survey({"--methods", "graph-cut,planar", "--cell-size", "0.002"});
  EXPECT_NE(printed.out.find("not run: "), std::string::npos) << printed.out;
  const json report = json::parse(contentOf(outputOf("survey.json")));
  const json &graph_cut = report["crispness"][0], &planar = report["crispness"][1];
  EXPECT_EQ(graph_cut["not_run"].get<std::string>().rfind("not run: ", 0), 0u);
  EXPECT_EQ(graph_cut["unprocessed"], 4);
  EXPECT_FALSE(planar.contains("not_run"));
  EXPECT_GT(report["accuracy"][1]["aligned"], 0);
}

TEST_F(SurveyCommand, VersionVoxelsAndGatesAreReported) {
  const json report = json::parse(survey({"--methods", "planar", "--json"}).out);
  EXPECT_NE(report["version"], "");
  EXPECT_EQ(report["voxel_size"].size(), 4u);
  EXPECT_GE(report["voxel_size"]["submap_00.pcd"], 0.02);
  const json& gates = report["parameters"]["alignment"];
  for (const char* gate : {"max-shift", "max-rise", "max-turn", "max-tilt", "min-score", "max-sigma"})
    EXPECT_GT(gates[gate], 0) << gate;
}

TEST_F(SurveyCommand, SeveralFoldersMakeOneTable) {
  const std::string other = copyOfTwo("other");
  survey({other, "--methods", "fft", "--quiet"});
  const std::string name = std::filesystem::path(site_).filename().string();
  const json together = json::parse(contentOf(outputOf("survey.json")));
  const json whole = json::parse(contentOf(outputOf(name + "/survey.json")));
  const json part = json::parse(contentOf(outputOf("other/survey.json")));
  EXPECT_EQ(together["submaps"], 6);
  EXPECT_EQ(together["surveys"][name], whole);
  EXPECT_EQ(together["surveys"]["other"], part);
  for (const char* count : {"overlapping", "aligned"})
    EXPECT_EQ(together["accuracy"][0][count].get<int>(),
              whole["accuracy"][0][count].get<int>() + part["accuracy"][0][count].get<int>());
  const auto largestError = [](const json& report) {
    return report["global"]["placements"]["global"]["errors"]["translation_max"].get<double>();
  };
  EXPECT_EQ(largestError(together), std::max(largestError(whole), largestError(part)));
  // Two middles alone would leave the turn about the line between them free.
  EXPECT_LT(part["global"]["placements"]["global"]["errors"]["rotation_median_degrees"], 0.5);
}

TEST_F(SurveyCommand, AnotherTruthMakesOtherErrors) {
  const std::string folder = copyOfTwo("other");
  const auto median = [&] {
    const json report = json::parse(
        run(runSurvey, {folder, "-o", output(), "--max-object-size", "1", "--methods", "fft", "--json"}).out);
    return report["accuracy"][0]["translation_median"];
  };
  EXPECT_LT(median().get<double>(), 0.02);
  std::vector<NamedPose> poses = readPoses(folder + "/truth.csv");
  poses[1].world_from_submap.translation().x() += 3;
  makeFile("other/truth.csv", asCsv(poses));
  EXPECT_GT(median().get<double>(), 1);
  std::filesystem::remove(folder + "/truth.csv");
  EXPECT_TRUE(median().is_null());
}

TEST_F(SurveyCommand, LargeCoordinatesKeepTheirMillimetres) {
  const Eigen::Translation3d far_away(500000, 6000000, 0);
  std::vector<NamedPose> truth;
  for (const int i : {0, 1}) {
    const Cloud cloud = readCloud(submap(i));
    const Eigen::Isometry3d file_from_points = far_away * cloud.viewpoint.asTransform();
    const NamedPose pose = readPoses(site_ + "/truth.csv").at(static_cast<std::size_t>(i));
    truth.push_back({pose.submap, far_away * pose.world_from_submap * file_from_points.inverse()});
    std::filesystem::create_directories(pathOf("far"));
    makeMoved("far/" + pose.submap, cloud, file_from_points);
  }
  makeFile("far/truth.csv", asCsv(truth));
  const json report = json::parse(
      run(runSurvey, {pathOf("far"), "-o", output(), "--max-object-size", "1", "--methods", "fft", "--json"})
          .out);
  EXPECT_EQ(report["accuracy"][0]["aligned"], 1);
  EXPECT_LT(report["accuracy"][0]["translation_median"], 0.02);
  EXPECT_LT(report["global"]["placements"]["global"]["errors"]["translation_rms"], 0.02);

  const std::vector<NamedPose> poses = readPoses(outputOf("poses.csv"));
  const Eigen::Vector3d place = truth[0].world_from_submap.inverse() * Eigen::Vector3d(500000, 6000000, 0);
  const auto relative = [](const std::vector<NamedPose>& p) {
    return p[1].world_from_submap.inverse() * p[0].world_from_submap;
  };
  EXPECT_LT((relative(poses) * place - relative(truth) * place).norm(), 0.02);
  const Cloud merged = readCloud(outputOf("merged.pcd"));
  EXPECT_NEAR(merged.viewpoint.position.y(), 6000000, 20);
  EXPECT_LT(merged.points->back().getVector3fMap().norm(), 20);
}

TEST_F(SurveyCommand, PaperTakesSmallSegmentsAndPlainMatching) {
  const json report = json::parse(survey({"--methods", "fft-lowpass", "--paper", "--json"}).out);
  const json& parameters = report["parameters"];
  EXPECT_EQ(parameters["alignment"]["min-extent"], 0.02);
  EXPECT_EQ(parameters["alignment"]["matching"], "plain");
  EXPECT_EQ(parameters["segmentation"]["fft-lowpass"]["height-tolerance"]["value"], 0.0);
}

TEST_F(SurveyCommand, QuietPrintsNothing) {
  const Printed printed = survey({"--methods", "dense-icp", "--quiet"});
  EXPECT_EQ(printed.out + printed.err, "");
}

}  // namespace
}  // namespace pcl_fft_ground::cli
