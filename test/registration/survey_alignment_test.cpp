#include "pcl_fft_ground/survey_alignment.h"

#include <gtest/gtest.h>
#include <pcl/exceptions.h>
#include <pcl/point_types.h>

#include <limits>

#include "pcl_fft_ground/segment_icp.h"
#include "stone_site.h"

namespace pcl_fft_ground {
namespace {

using test::poseAt;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Survey = SurveyAlignment<pcl::PointXYZ>;

/// A site of stones scanned from four places, navigation off by up to 12 cm and 2 degrees.
class SurveyAlignmentTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const test::StoneSite site = test::randomStones(1);
    truth_ = {poseAt(-0.7, 0, 10), poseAt(0.8, 0.3, -20), poseAt(0.2, 1.0, 40), poseAt(-0.6, 0.9, 0)};
    for (std::size_t n = 0; n < truth_.size(); ++n)
      clouds_.push_back(cloudOf(test::scanStones(site, truth_[n], static_cast<unsigned>(n + 1))));
  }
  static void TearDownTestSuite() {
    truth_.clear();
    clouds_.clear();
  }

  static Cloud::Ptr cloudOf(const test::StoneScan& scan) {
    const Cloud::Ptr cloud(new Cloud);
    for (Eigen::Index n = 0; n < scan.points.cols(); ++n)
      cloud->emplace_back(scan.points(0, n), scan.points(1, n), scan.points(2, n));
    return cloud;
  }

  static Eigen::Isometry3d navigation(std::size_t n) {
    const double side = n % 2 == 0 ? 1 : -1;
    return Eigen::Translation3d(0.06 * side, 0.04 * static_cast<double>(n), 0) * truth_[n] *
           Eigen::AngleAxisd(0.035 * side, Eigen::Vector3d::UnitZ());
  }

  static double errorOf(const Survey& survey) {
    return core::poseErrors(survey.getScans(), truth_, survey.getPoses().global).rms_translation;
  }

  static inline std::vector<Eigen::Isometry3d> truth_;
  static inline std::vector<Cloud::Ptr> clouds_;
};

TEST_F(SurveyAlignmentTest, PosesComeNearTheTruth) {
  Survey survey;
  for (std::size_t n = 0; n < clouds_.size(); ++n) EXPECT_EQ(survey.addScan(clouds_[n], navigation(n)), n);
  EXPECT_TRUE(survey.getPose(2).isApprox(navigation(2)));
  EXPECT_GT(errorOf(survey), 0.05);
  survey.align();
  EXPECT_LT(errorOf(survey), 0.005);
  EXPECT_GE(survey.getPoses().edges, 3u);
  EXPECT_EQ(survey.getPoses().rejected_edges, 0u);
}

TEST_F(SurveyAlignmentTest, APairIsAlignedAsSegmentIcpDoesIt) {
  Survey survey;
  survey.addScan(clouds_[0], navigation(0));
  survey.addScan(clouds_[1], navigation(1));
  survey.align();
  ASSERT_EQ(survey.getPairs().size(), 1u);
  SegmentICP<pcl::PointXYZ, pcl::PointXYZ> icp;
  icp.setInputTarget(clouds_[0]);
  icp.setInputSource(clouds_[1]);
  const core::Alignment& pair = icp.computeAlignment(navigation(0).inverse() * navigation(1));
  EXPECT_EQ(survey.getPairs()[0].status, core::PairStatus::ALIGNED);
  EXPECT_EQ(survey.getPairs()[0].reference_from_moving.matrix(), pair.reference_from_moving.matrix());
  EXPECT_EQ(survey.getPairs()[0].covariance, pair.covariance);
}

TEST_F(SurveyAlignmentTest, OnlyNewPairsAreAlignedAgain) {
  Survey survey;
  for (const std::size_t n : {0, 1, 2}) survey.addScan(clouds_[n], navigation(n));
  survey.align();
  const std::size_t tried = survey.getPairs().size();
  const double seconds = survey.getPairs()[0].seconds;
  survey.align();
  EXPECT_EQ(survey.getPairs().size(), tried);
  survey.addScan(clouds_[3], navigation(3));
  survey.align();
  EXPECT_GT(survey.getPairs().size(), tried);
  EXPECT_EQ(survey.getPairs()[0].seconds, seconds);
  EXPECT_LT(errorOf(survey), 0.005);
}

TEST_F(SurveyAlignmentTest, AnUpdateBringsEachNewcomerNearTheTruth) {
  Survey survey;
  for (std::size_t n = 0; n < clouds_.size(); ++n) {
    survey.addScan(clouds_[n], navigation(n));
    survey.update();
    if (n == 0) continue;
    const Eigen::Isometry3d found = survey.getPose(0).inverse() * survey.getPose(n);
    EXPECT_LT((found.translation() - (truth_[0].inverse() * truth_[n]).translation()).norm(), 0.01) << n;
  }
  EXPECT_LT(errorOf(survey), 0.005);
  const std::size_t tried = survey.getPairs().size();
  survey.update();
  EXPECT_EQ(survey.getPairs().size(), tried);
}

TEST_F(SurveyAlignmentTest, WhatIsTrustedMoreMovesLess) {
  core::NavigationSigmas sure;
  sure.horizontal = 1e-4;
  Survey survey;
  survey.addScan(clouds_[0], navigation(0), sure);
  survey.addScan(clouds_[1], navigation(1));
  survey.align();
  EXPECT_LT((survey.getPose(0).translation() - navigation(0).translation()).norm(), 1e-3);
  EXPECT_GT((survey.getPose(1).translation() - navigation(1).translation()).norm(), 0.03);
}

TEST_F(SurveyAlignmentTest, AScanWithoutObjectsStaysWhereNavigationHasIt) {
  Survey survey;
  core::AlignmentParameters parameters;
  parameters.fallback = core::Fallback::NONE;
  survey.setAlignmentParameters(parameters);
  const Cloud::Ptr bare(new Cloud);
  for (int i = 0; i < 100; ++i)
    for (int j = 0; j < 100; ++j)
      bare->emplace_back(0.02F * static_cast<float>(i), 0.02F * static_cast<float>(j), 0.0F);
  survey.addScan(clouds_[0], navigation(0));
  survey.addScan(bare, navigation(1));
  survey.align();
  ASSERT_EQ(survey.getPairs().size(), 1u);
  EXPECT_EQ(survey.getPairs()[0].status, core::PairStatus::UNPROCESSED);
  EXPECT_TRUE(survey.getPose(1).isApprox(navigation(1), 1e-9));
}

TEST_F(SurveyAlignmentTest, RefusesWhatIsNoScan) {
  Survey survey;
  const Cloud::Ptr empty(new Cloud), broken(new Cloud);
  broken->emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
  Eigen::Isometry3d nowhere = navigation(0);
  nowhere.translation().x() = std::numeric_limits<double>::infinity();
  core::NavigationSigmas certain;
  certain.heading = 0;
  EXPECT_THROW(survey.addScan(nullptr, navigation(0)), pcl::PCLException);
  EXPECT_THROW(survey.addScan(empty, navigation(0)), pcl::PCLException);
  EXPECT_THROW(survey.addScan(broken, navigation(0)), pcl::PCLException);
  EXPECT_THROW(survey.addScan(clouds_[0], nowhere), pcl::PCLException);
  EXPECT_THROW(survey.addScan(clouds_[0], navigation(0), certain), pcl::PCLException);
  EXPECT_THROW(survey.getPose(0), pcl::PCLException);
  core::AlignmentParameters never;
  never.min_score = 2;
  EXPECT_THROW(survey.setAlignmentParameters(never), pcl::PCLException);
  EXPECT_EQ(survey.size(), 0u);
  survey.align();
  EXPECT_TRUE(survey.getPairs().empty());
}

}  // namespace
}  // namespace pcl_fft_ground
