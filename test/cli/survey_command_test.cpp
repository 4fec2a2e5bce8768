#include "survey/survey_command.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "align/align_command.h"
#include "command_fixture.h"
#include "errors.h"
#include "io/pose_table.h"
#include "simulate/simulate_command.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::json;

/// A survey of the first four sub-maps along a transect of a pipe field, made once.
class SurveyCommand : public CommandFixture {
 protected:
  static void SetUpTestSuite() {
    site_ = makeTemporaryFolder();
    ASSERT_FALSE(site_.empty());
    run(runSimulate, {"survey", "pipes", "-o", site_, "--points", "60000", "--seed", "1"});
    for (int i = 4; i < 26; ++i)
      std::filesystem::remove(site_ + (i < 10 ? "/submap_0" : "/submap_") + std::to_string(i) + ".pcd");
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(site_); }

  static std::string submap(int i) { return site_ + "/submap_0" + std::to_string(i) + ".pcd"; }
  static Words with(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  Printed survey(const Words& more = {}) const {
    return run(runSurvey, with({site_, "-o", output(), "--max-object-size", "1"}, more));
  }
  Printed align(const Words& more = {}) const {
    return run(runAlign, with({submap(0), submap(1), "-o", output(), "--max-object-size", "1"}, more));
  }
  /// reference_from_moving of the first two sub-maps.
  static Eigen::Isometry3d truth() {
    const std::vector<NamedPose> poses = readPoses(site_ + "/truth.csv");
    return poses[0].world_from_submap.inverse() * poses[1].world_from_submap;
  }
  static Eigen::Isometry3d readTransform(const std::string& path) {
    std::ifstream file(path);
    Eigen::Isometry3d transform;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) file >> transform.matrix()(i, j);
    EXPECT_TRUE(file) << path;
    return transform;
  }

  static std::string site_;
};
std::string SurveyCommand::site_;

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

TEST_F(SurveyCommand, AlignFindsTheTruth) {
  const Printed printed = align();
  EXPECT_EQ(printed.out.rfind("aligned by", 0), 0u) << printed.out;
  const Eigen::Isometry3d found = readTransform(outputOf("transform.txt"));
  EXPECT_LT((found.translation() - truth().translation()).norm(), 0.02);
  const json report = json::parse(contentOf(outputOf("alignment.json")));
  EXPECT_EQ(report["accepted"], true);
  EXPECT_NEAR(report["reference_from_moving"][0][3].get<double>(), found.translation().x(), 1e-9);
  EXPECT_LT(report["crispness"]["delta_nx_percent"], 0);
  EXPECT_TRUE(std::filesystem::exists(outputOf("alignment.png")));
}

TEST_F(SurveyCommand, TheAlignedCloudIsTheMovingOneMoved) {
  align();
  const Eigen::Isometry3d found = readTransform(outputOf("transform.txt"));
  const pcl::PCLPointCloud2 moving = readByPcl(submap(1)), aligned = readByPcl(outputOf("aligned.pcd"));
  EXPECT_EQ(valuesOf(moving, "label"), valuesOf(aligned, "label"));
  const std::vector<double> x = valuesOf(moving, "x"), y = valuesOf(moving, "y"), z = valuesOf(moving, "z");
  const std::vector<double> ax = valuesOf(aligned, "x"), az = valuesOf(aligned, "z");
  for (std::size_t n = 0; n < x.size(); n += 1000) {
    const Eigen::Vector3d expected = found * Eigen::Vector3d(x[n], y[n], z[n]);
    ASSERT_NEAR(ax[n], expected.x(), 1e-5);
    ASSERT_NEAR(az[n], expected.z(), 1e-5);
  }
}

TEST_F(SurveyCommand, ARefusalIsAResultAndLeavesNoTransform) {
  align();
  const Printed printed = align({"--guess", "40,0,0,0"});
  EXPECT_EQ(printed.out.rfind("not aligned: ", 0), 0u) << printed.out;
  EXPECT_FALSE(std::filesystem::exists(outputOf("transform.txt")));
  EXPECT_FALSE(std::filesystem::exists(outputOf("aligned.pcd")));
  const json report = json::parse(contentOf(outputOf("alignment.json")));
  EXPECT_EQ(report["accepted"], false);
  EXPECT_NE(report["refusal"], "");
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

  survey({"--methods", "fft", "--quiet", "--min-matches", "4"});
  EXPECT_EQ(contentOf(outputOf("pairs.csv")).find("MARK"), std::string::npos);
}

TEST_F(SurveyCommand, SeveralFoldersMakeOneTable) {
  const std::string other = pathOf("other");
  std::filesystem::create_directory(other);
  for (const char* file : {"/submap_00.pcd", "/submap_01.pcd", "/truth.csv"})
    std::filesystem::copy_file(site_ + file, other + file);
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
}

TEST_F(SurveyCommand, RefusesFoldersOfTheSameName) {
  try {
    survey({site_ + "/."});
    ADD_FAILURE() << "not refused";
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("same name"), std::string::npos);
  }
  EXPECT_FALSE(hasOutput());
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

TEST_F(SurveyCommand, HelpTellsWhatThereIs) {
  EXPECT_NE(run(runSurvey, {"--help"}).out.find("Table II"), std::string::npos);
  EXPECT_NE(run(runAlign, {"--help"}).out.find("transform.txt"), std::string::npos);
  EXPECT_NE(run(runSimulate, {"survey", "--help"}).out.find("truth.csv"), std::string::npos);
}

TEST_F(SurveyCommand, RefusesFoldersWithoutASurvey) {
  makeFile("one.pcd", "");
  for (const std::string& folder : {pathOf("missing"), folder_.string()}) {
    try {
      run(runSurvey, {folder, "-o", output()});
      ADD_FAILURE() << "not refused";
    } catch (const WorkError& error) {
      EXPECT_NE(std::string(error.what()).find(folder), std::string::npos);
    }
  }
}

TEST_F(SurveyCommand, WrongUsageNamesTheOptionAndWhatIsAllowed) {
  const std::vector<std::pair<Words, std::string>> wrong = {
      {{"--methods", "fft,magic"}, "magic"},       {{"--min-matches", "0"}, "--min-matches"},
      {{"--min-score", "2"}, "--min-score"},       {{"--max-turn", "200"}, "180"},
      {{"--search", "far"}, "navigation or wide"}, {{"--matching", "best"}, "local or plain"},
      {{"--fallback", "yes"}, "dense or none"},    {{"--heading-sigma", "0"}, "--heading-sigma"},
      {{"--voxel-size", "nan"}, "--voxel-size"}};
  for (const auto& [words, named] : wrong) {
    SCOPED_TRACE(words[0]);
    try {
      survey(words);
      ADD_FAILURE() << "not refused";
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
    }
    EXPECT_FALSE(hasOutput());
  }
  EXPECT_THROW(align({"--guess", "1,2,3"}), UsageError);
  EXPECT_THROW(run(runAlign, {submap(0), "-o", output()}), UsageError);
  EXPECT_THROW(run(runAlign, {submap(0), submap(1)}), UsageError);
  EXPECT_THROW(run(runSurvey, {"-o", output()}), UsageError);
  EXPECT_THROW(run(runSimulate, {"survey", "reef", "-o", output()}), UsageError);
  EXPECT_THROW(run(runSimulate, {"survey", "wreck", "-o", output(), "--noise", "9"}), UsageError);
}

}  // namespace
}  // namespace pcl_fft_ground::cli
