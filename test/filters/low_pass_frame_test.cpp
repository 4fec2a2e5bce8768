// The frame of the published estimator: its labels do not depend on how the scene lies.

#include "low_pass_fixture.h"

namespace pcl_fft_ground::test {
namespace {

/// The points turned, computed in double.
Eigen::Matrix3Xf turned(const Eigen::Matrix3Xf& points, double degrees, const Eigen::Vector3d& axis) {
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(degrees * M_PI / 180, axis).toRotationMatrix();
  return (rotation * points.cast<double>()).cast<float>();
}

TEST(LowPassSegmentation, FrameBringsTheCentroidToTheOrigin) {
  const Scene scene = boxScene();
  Segmenter segmenter = segmenterOn(scene.points);
  segment(segmenter);
  const Eigen::Vector3d centroid = scene.points.cast<double>().rowwise().mean();
  EXPECT_LT((segmenter.getFrame() * centroid).norm(), 1e-5);
  const Eigen::Matrix3d rotation = segmenter.getFrame().linear();
  EXPECT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_GT(rotation(2, 2), 0.99);
}

TEST(LowPassSegmentation, UpDirectionChoosesTheSideThatIsUp) {
  Segmenter segmenter = segmenterOn(boxScene().points);
  segmenter.setUpDirection(-Eigen::Vector3d::UnitZ());
  segment(segmenter);
  EXPECT_LT(segmenter.getFrame().linear()(2, 2), -0.99);
  segmenter.setUpEstimation(UpEstimation::GIVEN);
  segmenter.setUpDirection(Eigen::Vector3d(0, 1e-3, 1e-3));
  segment(segmenter);
  EXPECT_TRUE((segmenter.getFrame().linear() * Eigen::Vector3d(0, M_SQRT1_2, M_SQRT1_2))
                  .isApprox(Eigen::Vector3d::UnitZ(), 1e-9));
}

TEST(LowPassSegmentation, LabelsDoNotDependOnWhereTheSceneLies) {
  const Eigen::Matrix3Xf points = boxScene().points;
  const Eigen::Matrix3Xf moved = points.colwise() + Eigen::Vector3f(16, -8, 4);  // exact in float
  Segmenter here = segmenterOn(points), there = segmenterOn(moved);
  expectSameLabels(here, there);
}

TEST(LowPassSegmentation, LabelsDoNotDependOnAQuarterTurnAboutUp) {
  const Eigen::Matrix3Xf points = boxScene().points;
  Eigen::Matrix3Xf quarter = points;
  quarter.row(0) = -points.row(1);
  quarter.row(1) = points.row(0);
  // The grid starts at another corner after the turn. It is the same grid, to 0.7 micrometres, if the cells
  // fill the rectangle of 4 m x 2.5 m.
  Segmenter straight = segmenterOn(points), turned_scene = segmenterOn(quarter);
  for (Segmenter* segmenter : {&straight, &turned_scene}) {
    segmenter->setCellSize(CELL * (1 + 1.8e-7));
    segmenter->setUpEstimation(UpEstimation::GIVEN);
  }
  segment(straight);
  segment(turned_scene);
  ASSERT_EQ(straight.getElevationGrid().elevation.size(), 80 * 50);
  ASSERT_EQ(turned_scene.getElevationGrid().elevation.size(), 80 * 50);
  expectSameLabels(straight, turned_scene);
}

TEST(LowPassSegmentation, LabelsDoNotDependOnPointOrder) {
  const Eigen::Matrix3Xf points = boxScene().points;
  const Eigen::Matrix3Xf reversed = points.rowwise().reverse();
  Segmenter forward = segmenterOn(points), backward = segmenterOn(reversed);
  std::vector<bool> backward_flags = objectFlags(backward);
  std::reverse(backward_flags.begin(), backward_flags.end());
  EXPECT_EQ(objectFlags(forward), backward_flags);
}

TEST(LowPassSegmentation, ATiltedSceneGivesTheLabelsOfTheLevelOne) {
  // Turned off the axes, so that the yaw of the grid does not stand where it may jump by a quarter turn.
  const Eigen::Matrix3Xf level = turned(boxScene().points, 20, Eigen::Vector3d::UnitZ());
  const Eigen::Matrix3Xf tilted = turned(level, 30, Eigen::Vector3d(1, 0, 0));
  Segmenter on_level = segmenterOn(level), on_tilted = segmenterOn(tilted);
  expectSameLabels(on_level, on_tilted);
}

}  // namespace
}  // namespace pcl_fft_ground::test
