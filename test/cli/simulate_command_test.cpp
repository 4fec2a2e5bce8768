#include "commands/commands.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "command_fixture.h"
#include "errors.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::json;

class SimulateCommand : public CommandFixture {
 protected:
  /// `simulate SCENE -o scan.pcd` of a size that takes no time.
  Printed simulate(const std::string& scene, const Words& more = {}) const {
    Words words{scene, "-o", pathOf("scan.pcd"), "--points", "5000"};
    words.insert(words.end(), more.begin(), more.end());
    return run(runSimulate, words);
  }

  /// The one-line message of the error that the command must end in, having written nothing.
  template <typename Error>
  std::string errorOf(const Words& words) const {
    const StreamText out(std::cout);
    std::string message;
    try {
      runSimulate(words);
      ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
      message = error.what();
    }
    EXPECT_EQ(out.str(), "");
    EXPECT_TRUE(names().empty());
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
};

TEST_F(SimulateCommand, MakesALabelledScanOfEachScene) {
  for (const char* scene : {"wreck", "pipes", "reef"}) {
    SCOPED_TRACE(scene);
    simulate(scene);
    const pcl::PCLPointCloud2 cloud = readByPcl(pathOf("scan.pcd"));
    EXPECT_EQ(pointCount(cloud), 5000u);
    ASSERT_NE(findField(cloud, "label"), nullptr);
    EXPECT_EQ(findField(cloud, "label")->datatype, pcl::PCLPointField::INT32);
    const std::vector<double> label = valuesOf(cloud, "label"), segment = valuesOf(cloud, "segment");
    EXPECT_EQ(std::set<double>(label.begin(), label.end()).count(0), 1u);
    for (std::size_t n = 0; n < label.size(); ++n)
      ASSERT_TRUE(label[n] == 0 ? segment[n] == 0 : label[n] == 2 || (label[n] == 1 && segment[n] > 0)) << n;
    for (const char* axis : {"x", "y", "z"})
      for (const double value : valuesOf(cloud, axis)) ASSERT_TRUE(std::isfinite(value));
  }
}

TEST_F(SimulateCommand, EqualSeedsGiveEqualFilesAndOtherSeedsDoNot) {
  simulate("wreck", {"--seed", "3"});
  const std::string first = contentOf(pathOf("scan.pcd"));
  simulate("wreck", {"--seed", "3"});
  EXPECT_EQ(contentOf(pathOf("scan.pcd")), first);
  simulate("wreck", {"--seed", "4"});
  EXPECT_NE(contentOf(pathOf("scan.pcd")), first);
}

TEST_F(SimulateCommand, TheViewpointIsTheTruePose) {
  simulate("reef", {"--tilt", "20"});
  pcl::PCLPointCloud2 cloud;
  Eigen::Vector4f origin;
  Eigen::Quaternionf orientation;
  int version = 0;
  ASSERT_EQ(pcl::PCDReader().read(pathOf("scan.pcd"), cloud, origin, orientation, version), 0);
  const Eigen::Vector3f up = orientation * Eigen::Vector3f::UnitZ();
  EXPECT_NEAR(std::acos(std::min(up.z(), 1.0f)) * 180 / M_PI, 20, 0.1);
}

TEST_F(SimulateCommand, JsonSummarisesTheFile) {
  const json summary = json::parse(simulate("wreck", {"--json", "--seed", "9"}).out);
  EXPECT_EQ(summary["file"], pathOf("scan.pcd"));
  EXPECT_EQ(summary["scene"], "wreck");
  EXPECT_EQ(summary["seed"], 9);
  EXPECT_EQ(summary["points"], 5000);
  const pcl::PCLPointCloud2 cloud = readByPcl(pathOf("scan.pcd"));
  const std::vector<double> label = valuesOf(cloud, "label"), segment = valuesOf(cloud, "segment");
  const auto objects = static_cast<double>(std::count(label.begin(), label.end(), 1));
  const auto ground = static_cast<double>(std::count(label.begin(), label.end(), 0));
  EXPECT_DOUBLE_EQ(summary["object_share"].get<double>(), objects / (objects + ground));
  std::set<double> numbers(segment.begin(), segment.end());
  numbers.erase(0);
  EXPECT_EQ(summary["objects"], numbers.size());
}

TEST_F(SimulateCommand, WritesTheTrueGroundHeightsOnlyWhenAsked) {
  const auto fields = [&] {
    Words found;
    for (const pcl::PCLPointField& field : readByPcl(pathOf("scan.pcd")).fields) found.push_back(field.name);
    return found;
  };
  simulate("wreck");
  EXPECT_EQ(fields(), (Words{"x", "y", "z", "label", "segment"}));
  simulate("wreck", {"--ground-heights"});
  EXPECT_EQ(fields(), (Words{"x", "y", "z", "label", "segment", "ground"}));
}

TEST_F(SimulateCommand, QuietPrintsNothing) {
  const Printed printed = simulate("pipes", {"--quiet"});
  EXPECT_EQ(printed.out + printed.err, "");
  EXPECT_EQ(names(), Words{"scan.pcd"});
}

TEST_F(SimulateCommand, ItsScanCanBeSegmented) {
  run(runSimulate, {"wreck", "-o", pathOf("scan.pcd"), "--points", "50000"});
  segment(pathOf("scan.pcd"));
  const json scores = json::parse(contentOf(outputOf("report.json")))["scores"];
  EXPECT_GT(scores["f1"], 0.5);
  EXPECT_NE(findField(readByPcl(outputOf("labelled.pcd")), "truth_segment"), nullptr);
}

TEST_F(SimulateCommand, RefusesUnusableOutputs) {
  for (const std::string& path : {pathOf("missing/scan.pcd"), folder_.string(), std::string("/dev/null")})
    EXPECT_NE(errorOf<WorkError>({"wreck", "-o", path, "--points", "10"}).find("'" + path + "'"),
              std::string::npos);
}

/// Words that are refused, and what the message has to name.
struct Refused {
  Words words;
  Words named;
};

class SimulateRefuses : public SimulateCommand, public ::testing::WithParamInterface<Refused> {};

TEST_P(SimulateRefuses, NamingTheOptionTheValueAndWhatIsAllowed) {
  Words words = GetParam().words;
  words.insert(words.end(), {"-o", pathOf("scan.pcd")});
  const auto message = errorOf<UsageError>(words);
  for (const std::string& name : GetParam().named)
    EXPECT_NE(message.find(name), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Simulate, SimulateRefuses,
    ::testing::Values(Refused{{}, {"no scene", "wreck, pipes or reef"}},
                      Refused{{"moon"}, {"moon", "wreck, pipes or reef"}},
                      Refused{{"wreck", "reef"}, {"too many"}},
                      Refused{{"wreck", "--points", "0"}, {"--points", "0"}},
                      Refused{{"wreck", "--points", "-5"}, {"--points", "-5"}},
                      Refused{{"wreck", "--points", "1e6"}, {"--points", "1e6", "whole number"}},
                      Refused{{"wreck", "--points", "100000001"}, {"--points", "100000000"}},
                      Refused{{"wreck", "--seed", "-1"}, {"--seed", "-1", "4294967295"}},
                      Refused{{"wreck", "--seed", "4294967296"}, {"--seed", "4294967295"}},
                      Refused{{"wreck", "--object-share", "0.9"}, {"--object-share", "0.9", "0.8"}},
                      Refused{{"wreck", "--object-share", "nan"}, {"--object-share", "nan"}},
                      Refused{{"wreck", "--noise", "-0.1"}, {"--noise", "-0.1"}},
                      Refused{{"wreck", "--gap-share", "1"}, {"--gap-share", "1", "0.9"}},
                      Refused{{"wreck", "--outlier-share", "2"}, {"--outlier-share", "2", "0.5"}},
                      Refused{{"wreck", "--tilt", "90"}, {"--tilt", "90", "45"}},
                      Refused{{"wreck", "--poinst", "5"}, {"--poinst"}}));

TEST_F(SimulateCommand, RefusesACallWithoutAnOutput) {
  EXPECT_NE(errorOf<UsageError>({"wreck"}).find("-o FILE"), std::string::npos);
}

}  // namespace
}  // namespace pcl_fft_ground::cli
