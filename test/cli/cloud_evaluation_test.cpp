#include "commands/evaluate/cloud_evaluation.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "evaluate_fixture.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::json;

class CloudEvaluation : public EvaluateFixture {
 protected:
  /// What the command says of a method on a cloud.
  static json rowOf(const std::string& cloud, const std::string& method) {
    return json::parse(evaluate({cloud, "--methods", method}, {"--json"}).out)["results"][0];
  }

  /// A level scan, 0.5 m above its true ground, in a file with a field `ground`.
  template <typename Setter, typename Value>
  std::string makeLevelScan(float level, const Setter& set, Value ground) const {
    pcl::PointCloud<pcl::PointXYZL> scan = boxScan();
    for (auto& point : scan) point.z = level;
    pcl::PCLPointCloud2 fields;
    pcl::toPCLPointCloud2(scan, fields);
    set(fields, "ground", std::vector<Value>(scan.size(), ground));
    writePcd(pathOf("level.pcd"), fields);
    return pathOf("level.pcd");
  }
};

TEST_F(CloudEvaluation, SurfaceErrorIsThatAtTheGroundPoints) {
  // The naive surface is the mean height: its error is the spread of the ground about that.
  const pcl::PointCloud<pcl::PointXYZL> cloud = boxScan();
  double mean = 0, sum = 0, count = 0;
  for (const auto& p : cloud) mean += static_cast<double>(p.z) / static_cast<double>(cloud.size());
  for (const auto& p : cloud) {
    if (p.label != 0) continue;
    sum += std::pow(static_cast<double>(p.z) - mean, 2);
    ++count;
  }
  const json row = rowOf(makeLabelledScan(), "naive");
  EXPECT_NEAR(row["surface_rmse"].get<double>(), std::sqrt(sum / count), 1e-5);
}

TEST_F(CloudEvaluation, SurfaceErrorIsThatAgainstTheTrueHeightsWhereTheyAreKnown) {
  EXPECT_NEAR(rowOf(makeLevelScan(2.0f, setFloatField, 1.5f), "naive")["surface_rmse"].get<double>(), 0.5,
              1e-6);
}

TEST_F(CloudEvaluation, TrueHeightsAreRelativeToTheOriginThatWasSubtracted) {
  const std::string cloud = makeLevelScan(20000.0f, setFloatField, 19999.5f);
  EXPECT_NEAR(rowOf(cloud, "naive")["surface_rmse"].get<double>(), 0.5, 1e-6);
}

TEST_F(CloudEvaluation, AFieldOfWholeNumbersIsNoHeight) {
  const std::string cloud = makeLevelScan(2.0f, setInt32Field, std::int32_t{1});
  EXPECT_NEAR(rowOf(cloud, "naive")["surface_rmse"].get<double>(), 0, 1e-6);
}

TEST_F(CloudEvaluation, SimulatedHeightsLieUnderTheObjectsToo) {
  const LabelledCloud points_only = readLabelledCloud(simulatePipes());
  const LabelledCloud heights = readLabelledCloud(simulatePipes({"--ground-heights"}));
  EXPECT_EQ(heights.true_ground.size(), heights.cloud.points->size());
  EXPECT_LT(points_only.true_ground.size(), heights.true_ground.size());
  double sum = 0, count = 0;
  for (std::size_t n = 0; n < heights.true_ground.size(); ++n) {
    if (heights.cloud.labels[n] != 0) continue;
    sum += std::pow(static_cast<double>((*heights.cloud.points)[n].z) - heights.true_ground[n].z(), 2);
    ++count;
  }
  EXPECT_NEAR(std::sqrt(sum / count), 0.003, 0.0003);  // the noise of the range
}

}  // namespace
}  // namespace pcl_fft_ground::cli
