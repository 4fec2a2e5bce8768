#include "pcl_fft_ground/core/scan/prepare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "pcl_fft_ground/core/scan/far_points.h"

namespace pcl_fft_ground::core {
namespace {

constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();
constexpr float INFINITE = std::numeric_limits<float>::infinity();

/// A level, noisy patch of 10 m x 5 m.
RawPoints patch(Eigen::Index count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> share(0, 1);
  std::normal_distribution<float> noise(0, 0.01F);
  RawPoints points(3, count);
  for (Eigen::Index n = 0; n < count; ++n)
    points.col(n) = Eigen::Vector3f(10 * share(random), 5 * share(random), noise(random));
  return points;
}

TEST(UsablePoints, AreAllOfAScanThatHasNoOthers) {
  const RawPoints scan = patch(2000);
  const UsablePoints usable = usablePoints(scan);
  EXPECT_EQ(usable.points, scan);
  EXPECT_TRUE(usable.columns.empty());
  EXPECT_TRUE(usable.far.empty());
  EXPECT_EQ(usable.column(7), 7);
  EXPECT_EQ(usable.statistics.mean, summarise(scan).mean);
}

TEST(UsablePoints, KeepTheirOrderAndTheirColumns) {
  RawPoints scan = patch(2000);
  scan(1, 0) = NOT_A_NUMBER;
  scan(2, 3) = INFINITE;
  scan.col(10) = Eigen::Vector3f(0, 0, 5000);  // a stray return
  scan.col(1999) = Eigen::Vector3f::Constant(NOT_A_NUMBER);
  const UsablePoints usable = usablePoints(scan);
  EXPECT_EQ(usable.far, std::vector<Eigen::Index>{10});
  ASSERT_EQ(usable.points.cols(), 1996);
  ASSERT_EQ(usable.columns.size(), 1996U);
  for (Eigen::Index n = 0; n < usable.points.cols(); ++n) {
    EXPECT_EQ(usable.points.col(n), scan.col(usable.column(n)));
  }
  EXPECT_TRUE(std::is_sorted(usable.columns.begin(), usable.columns.end()));
  EXPECT_EQ(usable.statistics.bounds.high.z(), usable.points.row(2).maxCoeff());
}

TEST(UsablePoints, FindTheFarPointsAsAmongTheFiniteOnes) {
  RawPoints scan = patch(3000);
  for (const Eigen::Index n : {5, 900, 2222}) scan(0, n) = -700;
  const RawPoints finite = scan.rightCols(2997);
  scan.leftCols(3).setConstant(NOT_A_NUMBER);
  const std::vector<Eigen::Index> far = findFarPoints(finite, summarise(finite));
  const UsablePoints usable = usablePoints(scan);
  ASSERT_EQ(usable.far.size(), far.size());
  for (std::size_t n = 0; n < far.size(); ++n) EXPECT_EQ(usable.far[n], far[n] + 3);
}

TEST(UsablePoints, CallWhatIsBeyondAllMeasureFar) {
  RawPoints scan = patch(500);
  scan(0, 3) = 3e38F;
  scan(2, 400) = -3e38F;
  scan(1, 20) = 4000;
  const UsablePoints usable = usablePoints(scan);
  EXPECT_EQ(usable.far, (std::vector<Eigen::Index>{3, 20, 400}));
  EXPECT_LT(usable.points.cwiseAbs().maxCoeff(), 11);
}

TEST(UsablePoints, AreNoneOfAScanWithoutFinitePoints) {
  for (const Eigen::Index count : {0, 1, 40}) {
    SCOPED_TRACE(count);
    const UsablePoints usable = usablePoints(RawPoints::Constant(3, count, NOT_A_NUMBER));
    EXPECT_EQ(usable.points.cols(), 0);
    EXPECT_TRUE(usable.columns.empty());
    EXPECT_TRUE(usable.far.empty());
  }
}

TEST(Prepare, LevelsTheUsablePoints) {
  RawPoints scan = patch(2000);
  scan.row(2) += 0.3F * scan.row(0);  // a slope
  scan(0, 100) = NOT_A_NUMBER;
  const UsablePoints usable = usablePoints(scan);
  const FrameParameters parameters;
  const PreparedScan prepared = prepare(scan, parameters);
  EXPECT_EQ(prepared.usable.columns, usable.columns);
  EXPECT_TRUE(
      prepared.frame_from_input.isApprox(estimateFrame(usable.points, usable.statistics, parameters)));
  EXPECT_EQ(prepared.usable.points, transformed(usable.points, prepared.frame_from_input));
  EXPECT_LT(prepared.usable.points.row(2).cwiseAbs().maxCoeff(), 0.1F);
}

}  // namespace
}  // namespace pcl_fft_ground::core
