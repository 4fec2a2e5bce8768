#include "commands/commands.h"

#include <Eigen/Geometry>
#include <fstream>
#include <nlohmann/json.hpp>

#include "errors.h"
#include "io/cloud_file.h"
#include "survey_fixture.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::json;

class AlignCommand : public SurveyFixture {
 protected:
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
};

TEST_F(AlignCommand, FindsTheTruth) {
  const Printed printed = align();
  EXPECT_EQ(printed.out.rfind("aligned by", 0), 0u) << printed.out;
  const Eigen::Isometry3d found = readTransform(outputOf("transform.txt"));
  EXPECT_LT((found.translation() - truth().translation()).norm(), 0.02);
  const json report = json::parse(contentOf(outputOf("alignment.json")));
  EXPECT_EQ(report["accepted"], true);
  EXPECT_NEAR(report["reference_from_moving"][0][3].get<double>(), found.translation().x(), 1e-9);
  EXPECT_LT(report["crispness"]["delta_nx_percent"], 0);
  EXPECT_NE(report["version"], "");
  EXPECT_GE(report["voxel_size"], 0.02);
  EXPECT_EQ(report["parameters"]["max-tilt"], 4);
  EXPECT_TRUE(std::filesystem::exists(outputOf("alignment.png")));
}

TEST_F(AlignCommand, TheAlignedCloudIsTheMovingOneMoved) {
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

TEST_F(AlignCommand, ARefusalIsAResultAndLeavesNoTransform) {
  align();
  const Printed printed = align({"--guess", "40,0,0,0"});
  EXPECT_EQ(printed.out.rfind("not aligned: ", 0), 0u) << printed.out;
  EXPECT_FALSE(std::filesystem::exists(outputOf("transform.txt")));
  EXPECT_FALSE(std::filesystem::exists(outputOf("aligned.pcd")));
  const json report = json::parse(contentOf(outputOf("alignment.json")));
  EXPECT_EQ(report["accepted"], false);
  EXPECT_NE(report["refusal"], "");
}

TEST_F(AlignCommand, TellsWhatThereIsToSayOfTheFiles) {
  makeFile("moving.pcd", withEmptyField(contentOf(submap(1))));
  const Words words{submap(0), pathOf("moving.pcd"), "-o", output(), "--max-object-size", "1"};
  const std::string remark = pathOf("moving.pcd") + ": its field 'empty' has COUNT 0 and is left out";
  EXPECT_NE(run(runAlign, words).err.find("warning: " + remark), std::string::npos);
  const json report = json::parse(contentOf(outputOf("alignment.json")));
  EXPECT_EQ(report["accepted"], true);
  EXPECT_EQ(report["warnings"], json::array({remark}));
  EXPECT_EQ(run(runAlign, with(words, {"--quiet"})).err, "");
}

TEST_F(AlignCommand, SensorsAreToldForBothScansOrForEach) {
  align({"--sensor", "0", "-0.5", "9"});
  const json both = json::parse(contentOf(outputOf("alignment.json")))["parameters"]["sensor"];
  EXPECT_EQ(both, (json{{"reference", {0, -0.5, 9}}, {"moving", {0, -0.5, 9}}}));
  align({"--sensor", "0", "-0.5", "9", "1", "2", "-8"});
  const json each = json::parse(contentOf(outputOf("alignment.json")))["parameters"]["sensor"];
  EXPECT_EQ(each, (json{{"reference", {0, -0.5, 9}}, {"moving", {1, 2, -8}}}));
  for (const char* wrong : {"1 2", "1 2 3 4", "1 2 3 4 5 6 7", "1 2 x", "1 2 nan"})
    EXPECT_THROW(align({std::string("--sensor=") + wrong}), UsageError) << wrong;
}

TEST_F(AlignCommand, LargeCoordinatesAreThoseOfTheFiles) {
  const Cloud reference = readCloud(submap(0)), moving = readCloud(submap(1));
  const Eigen::Translation3d far_away(500000, 6000000, 0);
  const Eigen::Isometry3d reference_file = far_away * reference.viewpoint.asTransform();
  const Eigen::Isometry3d moving_file = far_away * moving.viewpoint.asTransform();
  makeMoved("reference.pcd", reference, reference_file);
  makeMoved("moving.pcd", moving, moving_file);
  const json report = json::parse(run(runAlign, {pathOf("reference.pcd"), pathOf("moving.pcd"), "-o",
                                                 output(), "--max-object-size", "1", "--json"})
                                      .out);
  ASSERT_EQ(report["accepted"], true);
  const Eigen::Isometry3d found = readTransform(outputOf("transform.txt"));
  const Eigen::Vector3d place = moving_file.translation();
  EXPECT_LT((found * place - reference_file * truth() * moving_file.inverse() * place).norm(), 0.02);

  const Cloud read = readCloud(pathOf("moving.pcd")), aligned = readCloud(outputOf("aligned.pcd"));
  const Eigen::Vector3d first = (*read.points)[0].getVector3fMap().cast<double>() + read.origin;
  const Eigen::Vector3d moved = (*aligned.points)[0].getVector3fMap().cast<double>();
  EXPECT_LT((aligned.viewpoint.asTransform() * moved - found * first).norm(), 1e-3);
  EXPECT_EQ(aligned.viewpoint.position.y(), report["origin"][1].get<double>());
  const json& match = report["matches"][0];
  EXPECT_NEAR(match["moving"][1].get<double>(), 6000000, 20);
}

TEST_F(AlignCommand, AFarOutlierIsLeftOut) {
  pcl::PointCloud<pcl::PointXYZ> cloud = *readCloud(submap(1)).points;
  cloud.push_back({1e6F, -1e6F, 3e5F});
  const Printed printed = run(runAlign, {submap(0), makeCloud("stray.pcd", cloud), "-o", output(),
                                         "--max-object-size", "1", "--json"});
  const json report = json::parse(printed.out);
  EXPECT_EQ(report["accepted"], true);
  EXPECT_LT((readTransform(outputOf("transform.txt")).translation() - truth().translation()).norm(), 0.02);
}

TEST_F(AlignCommand, ScansFarApartAreRefusedAndDrawn) {
  align();
  for (const char* guess : {"3000,-3000,0,0", "1e7,0,0,0"}) {
    SCOPED_TRACE(guess);
    EXPECT_EQ(align({"--guess", guess}).out.rfind("not aligned: ", 0), 0u);
    EXPECT_FALSE(std::filesystem::exists(outputOf("aligned.pcd")));
    EXPECT_TRUE(std::filesystem::exists(outputOf("alignment.png")));
  }
}

}  // namespace
}  // namespace pcl_fft_ground::cli
