#include <limits>

#include "errors.h"
#include "evaluate_fixture.h"

namespace pcl_fft_ground::cli {
namespace {

class EvaluateRefusals : public EvaluateFixture {
 protected:
  /// The message of the error that the command must end in, having printed nothing.
  template <typename Error>
  static std::string errorOf(const Words& words) {
    const StreamText out(std::cout), err(std::cerr);
    std::string message;
    try {
      runEvaluate(words);
      ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
      message = error.what();
    }
    EXPECT_EQ(out.str() + err.str(), "");
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
};

TEST_F(EvaluateRefusals, RefusesACloudWithoutLabelsNamingIt) {
  const std::string path = makeScan();
  const std::string message = errorOf<WorkError>({path});
  EXPECT_NE(message.find(path), std::string::npos) << message;
  EXPECT_NE(message.find("'label'"), std::string::npos) << message;
  EXPECT_NE(errorOf<WorkError>({pathOf("missing.pcd")}).find("missing.pcd"), std::string::npos);
}

TEST_F(EvaluateRefusals, RefusesWrongUsageNamingIt) {
  const std::string cloud = makeLabelledScan();
  const auto expectNamed = [&](const Words& words, const std::string& name) {
    const std::string message = errorOf<UsageError>(words);
    EXPECT_NE(message.find(name), std::string::npos) << message;
  };
  expectNamed({cloud, "--methods", "naive,kriging"}, "kriging");
  expectNamed({cloud, "--methods", "naive,,grid"}, "graph-cut");
  expectNamed({cloud, "--methods", ""}, "--methods");
  expectNamed({cloud, "--cell-size", "0"}, "--cell-size");
  expectNamed({cloud, "--probability", "1"}, "--probability");
  expectNamed({cloud, "--no-such-option"}, "no-such-option");
  expectNamed({cloud, "--optimize-coefficients", "maybe"}, "on, off");
  expectNamed({cloud, "--voxel-height", "0"}, "--voxel-height");
  expectNamed({cloud, "--smoothness", "-1"}, "--smoothness");
  expectNamed({cloud, "--methods", "pcl-pmf", "--pmf-base", "1"}, "--pmf-base");
  expectNamed({cloud, "--methods", "pcl-pmf", "--pmf-exponential", "off", "--pmf-base", "0.5"}, "--pmf-base");
  expectNamed({cloud, "--methods", "pcl-approximate-pmf", "--pmf-cell-size", "0"}, "--pmf-cell-size");
  expectNamed({cloud, "--methods", "pcl-approximate-pmf", "--pmf-max-window-size", "0"},
              "--pmf-max-window-size");
  expectNamed({cloud, "--methods", "pcl-mlesac-plane", "--pcl-time-limit", "0"}, "--pcl-time-limit");
  expectNamed({cloud, "--methods", "pcl-mlesac-plane", "--distance-threshold", "0"}, "--distance-threshold");
  expectNamed({cloud, "--csv", ""}, "--csv");
  expectNamed({cloud, "--pictures", ""}, "--pictures");
  expectNamed({}, "cloud");
}

TEST_F(EvaluateRefusals, NeedsAFinitePointAndALabelThatCounts) {
  pcl::PointCloud<pcl::PointXYZL> cloud = boxScan();
  for (auto& point : cloud) point.label = 7;
  EXPECT_NE(errorOf<WorkError>({makeCloud("others.pcd", cloud)}).find("0 (ground)"), std::string::npos);
  cloud = boxScan();
  for (auto& point : cloud) point.z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(errorOf<WorkError>({makeCloud("nan.pcd", cloud)}).find("finite"), std::string::npos);
}

TEST_F(EvaluateRefusals, ABadCloudAtTheEndIsFoundBeforeAnythingIsWritten) {
  const Words words{makeLabelledScan(),  makeScan(),   "--methods", "naive", "--csv",
                    pathOf("table.csv"), "--pictures", output()};
  EXPECT_NE(errorOf<WorkError>(words).find("scan.pcd"), std::string::npos);
  EXPECT_FALSE(hasOutput());
  EXPECT_FALSE(std::filesystem::exists(pathOf("table.csv")));
}

TEST_F(EvaluateRefusals, UnusableOutputsAreNamed) {
  const std::string cloud = makeLabelledScan();
  EXPECT_NE(errorOf<WorkError>({cloud, "--methods", "naive", "--pictures", cloud}).find(cloud),
            std::string::npos);
  const Words words{cloud, "--methods", "naive", "--csv", pathOf("missing/table.csv")};
  EXPECT_THROW(run(runEvaluate, words), WorkError);
}

}  // namespace
}  // namespace pcl_fft_ground::cli
