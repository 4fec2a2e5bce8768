#pragma once

// FILTER_CONTRACT, line 30: degenerate data.

#include "contract_fixture.h"

namespace pcl_fft_ground::test {

/// The scene shrunk, then moved; computed in double, as a driver would.
inline Eigen::Matrix3Xf placed(const Scene& scene, double scale, const Eigen::Vector3d& offset) {
  return ((scene.points.cast<double>() * scale).colwise() + offset).cast<float>();
}

TYPED_TEST_P(FilterContract, Line30OnePoint) {
  this->expectDefinedResult(cloudOf<typename TypeParam::Point>(Eigen::Matrix3Xf(Eigen::Vector3f(1, 2, 3))));
}

TYPED_TEST_P(FilterContract, Line30IdenticalPoints) {
  const Eigen::Matrix3Xf points = Eigen::Vector3f(1, 2, 3).replicate(1, 5000);
  this->expectDefinedResult(cloudOf<typename TypeParam::Point>(points));
}

TYPED_TEST_P(FilterContract, Line30CollinearPoints) {
  const Eigen::RowVectorXf along = Eigen::RowVectorXf::LinSpaced(5000, -2, 2);
  for (const Eigen::Vector3f& direction :
       {Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(0, 0, 1), Eigen::Vector3f(1, -2, 0.5f)})
    this->expectDefinedResult(cloudOf<typename TypeParam::Point>(Eigen::Matrix3Xf(direction * along)));
}

TYPED_TEST_P(FilterContract, Line30AllNan) {
  const Eigen::Matrix3Xf points = Eigen::Matrix3Xf::Constant(3, 100, NOT_A_NUMBER);
  const auto cloud = cloudOf<typename TypeParam::Point>(points);
  this->expectDefinedResult(cloud);
  auto segmenter = this->recording(cloud);
  EXPECT_TRUE(this->filterIndices(segmenter).empty());
}

TYPED_TEST_P(FilterContract, Line30OneCell) {
  // Four centimetres across: about one cell of any sensible size.
  this->expectDefinedResult(
      cloudOf<typename TypeParam::Point>(placed(this->scene_, 0.01, Eigen::Vector3d::Zero())));
}

TYPED_TEST_P(FilterContract, Line30CellLargerThanTheCloud) {
  this->expectDefinedResult(
      cloudOf<typename TypeParam::Point>(placed(this->scene_, 1e-4, Eigen::Vector3d(5, -5, 1))));
}

TYPED_TEST_P(FilterContract, Line30CoordinatesOf100Kilometres) {
  using Point = typename TypeParam::Point;
  auto near = this->recording(this->scan_);
  const std::vector<int> expected = this->labels(near);
  const auto far_away = cloudOf<Point>(placed(this->scene_, 1, Eigen::Vector3d(1e5, -1e5, 100)));
  this->expectDefinedResult(far_away);
  auto segmenter = this->recording(far_away);
  const std::vector<int> found = this->labels(segmenter);
  std::size_t wrong_on_boxes = 0;  // 8 mm is all that float keeps of a coordinate: not much beside a box
  for (std::size_t n = 0; n < found.size(); ++n)
    if (this->scene_.is_object[n] && expected[n] != found[n]) ++wrong_on_boxes;
  EXPECT_EQ(wrong_on_boxes, 0U);
}

TYPED_TEST_P(FilterContract, Line30CoordinatesBeyondTheDetailOfFloat) {
  this->expectDefinedResult(
      cloudOf<typename TypeParam::Point>(placed(this->scene_, 1, Eigen::Vector3d(5e6, 5e6, 0))));
}

TYPED_TEST_P(FilterContract, Line30LargestFiniteCoordinates) {
  Eigen::Matrix3Xf points = this->scene_.points.leftCols(100);
  const float largest = std::numeric_limits<float>::max();
  points.col(3) = Eigen::Vector3f(largest, -largest, largest);
  points.col(70) = Eigen::Vector3f(-largest, largest, -largest);
  this->expectDefinedResult(cloudOf<typename TypeParam::Point>(points));
}

TYPED_TEST_P(FilterContract, Line30OneFarOutlierIsReportedAndChangesNothingElse) {
  auto undisturbed = this->recording(this->scan_);
  std::vector<int> expected = this->labels(undisturbed);
  for (const Eigen::Vector3f& place : {Eigen::Vector3f(1e6f, 0, 0), Eigen::Vector3f(0, -1e6f, 0),
                                       Eigen::Vector3f(0, 0, 1e6f), Eigen::Vector3f(-6e5f, 6e5f, -6e5f)}) {
    const auto cloud = pcl::make_shared<typename TestFixture::CloudT>(*this->scan_);
    auto outlier = cloud->front();
    outlier.x = place.x();
    outlier.y = place.y();
    outlier.z = place.z();
    cloud->insert(cloud->begin() + 1000, outlier);
    auto segmenter = this->recording(cloud);
    const OutputCapture capture;
    std::vector<int> found = this->labels(segmenter);
    EXPECT_EQ(segmenter.getFarPoints(), pcl::Indices{1000});
    EXPECT_FALSE(segmenter.getWarnings().empty());
    EXPECT_FALSE(capture.standard_error.text().empty());
    EXPECT_EQ(found[1000], 1);
    found.erase(found.begin() + 1000);
    EXPECT_EQ(found, expected);
    EXPECT_TRUE(segmenter.getFrame().isApprox(undisturbed.getFrame(), 0.0));
  }
}

}  // namespace pcl_fft_ground::test
