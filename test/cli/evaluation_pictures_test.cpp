#include "commands/evaluate/evaluation_pictures.h"

#include <algorithm>
#include <map>

#include "evaluate_fixture.h"
#include "png.h"

namespace pcl_fft_ground::cli {
namespace {

class EvaluationPictures : public EvaluateFixture {
 protected:
  /// A level scan without relief, so that colours are pure: its first quarter is object, the rest ground.
  LabelledCloud levelScan(std::uint32_t object = 1, std::uint32_t ground = 0) const {
    pcl::PointCloud<pcl::PointXYZL> scan = boxScan();
    for (std::size_t n = 0; n < scan.size(); ++n) {
      scan[n].z = 0;
      scan[n].label = n < scan.size() / 4 ? object : ground;
    }
    LabelledCloud result;
    result.path = makeCloud("level.pcd", scan);
    result.cloud = readCloud(result.path);
    return result;
  }

  static Evaluation evaluationOf(const LabelledCloud& cloud, core::Label first, core::Label rest) {
    Evaluation evaluation;
    evaluation.labels.assign(cloud.cloud.labels.size(), rest);
    std::fill_n(evaluation.labels.begin(), cloud.cloud.labels.size() / 4, first);
    return evaluation;
  }

  /// How many pixels have which colour, for those that fill more than lines and letters do.
  std::map<std::uint32_t, int> coloursOf(const LabelledCloud& cloud,
                                         const std::vector<Evaluation>& evaluations) const {
    drawEvaluations(pathOf("picture.png"), cloud, Eigen::Vector3d::UnitZ(), evaluations);
    const Png png(pathOf("picture.png"));
    std::map<std::uint32_t, int> counts;
    for (int y = 0; y < png.height(); ++y)
      for (int x = 0; x < png.width(); ++x) ++counts[png.at({x, y})];
    for (auto entry = counts.begin(); entry != counts.end();)
      entry = entry->second < 5000 || entry->first == kWhite ? counts.erase(entry) : std::next(entry);
    return counts;
  }
};

TEST_F(EvaluationPictures, RightLabelsHaveTheColoursOfTheTruth) {
  const LabelledCloud cloud = levelScan();
  const auto truth = coloursOf(cloud, {});
  ASSERT_EQ(truth.size(), 2u);
  const auto both = coloursOf(cloud, {evaluationOf(cloud, core::Label::OBJECT, core::Label::GROUND)});
  ASSERT_EQ(both.size(), 2u);
  for (const auto& [colour, count] : truth) EXPECT_NEAR(both.at(colour), 2 * count, 0.03 * count);
}

TEST_F(EvaluationPictures, EachKindOfErrorHasAColourOfItsOwn) {
  const LabelledCloud cloud = levelScan();
  const auto truth = coloursOf(cloud, {});
  const auto all = coloursOf(cloud, {evaluationOf(cloud, core::Label::GROUND, core::Label::OBJECT)});
  ASSERT_EQ(all.size(), 4u);
  std::vector<int> right, wrong;
  for (const auto& [colour, count] : all) (truth.count(colour) != 0 ? right : wrong).push_back(count);
  ASSERT_EQ(right.size(), 2u);
  std::sort(right.begin(), right.end());
  std::sort(wrong.begin(), wrong.end());
  for (const std::size_t n : {0u, 1u}) EXPECT_NEAR(wrong[n], right[n], 0.03 * right[n]);
  EXPECT_NEAR(wrong[1], 3 * wrong[0], 0.1 * wrong[1]);  // ground called object; missed object
}

TEST_F(EvaluationPictures, WhatIsNotScoredHasOneColourWhateverTheMethodSays) {
  const LabelledCloud cloud = levelScan(2, 2);
  EXPECT_EQ(coloursOf(cloud, {evaluationOf(cloud, core::Label::OBJECT, core::Label::GROUND)}).size(), 1u);
}

TEST_F(EvaluationPictures, AMethodThatFailedLeavesItsMapEmpty) {
  const LabelledCloud cloud = levelScan();
  Evaluation failed;
  failed.row.failure = "too many cells";
  const auto truth = coloursOf(cloud, {});
  const auto colours = coloursOf(cloud, {failed});
  ASSERT_EQ(colours.size(), truth.size());
  for (const auto& [colour, count] : truth) EXPECT_NEAR(colours.at(colour), count, 0.03 * count);
}

TEST_F(EvaluationPictures, NamesDifferEvenWhereTheFilesHaveOneName) {
  EXPECT_EQ(pictureNames({"a/scan.pcd", "b/scan.pcd", "scan.ply", "scan_2.pcd", "dive.1.txt"}),
            (Words{"scan.png", "scan_2.png", "scan_3.png", "scan_2_2.png", "dive.1.png"}));
}

TEST_F(EvaluationPictures, TheCommandDrawsOneForEachCloud) {
  evaluate({makeLabelledScan(), simulatePipes(), "--methods", "naive,grid", "--pictures", output()});
  for (const char* name : {"box.png", "pipes.png"}) EXPECT_GT(Png(outputOf(name)).width(), 600) << name;
}

}  // namespace
}  // namespace pcl_fft_ground::cli
