#pragma once

// FILTER_CONTRACT, lines 18 to 24: cloud out, keep organised.

#include "contract_fixture.h"

namespace pcl_fft_ground::test {

/// The input with x, y, z of every point that is listed but not kept replaced: what keep_organized owes.
template <typename CloudT>
CloudT organisedResult(const CloudT& input, const pcl::Indices& removed, float value) {
  CloudT expected = input;
  for (const pcl::index_t i : removed) {
    auto& p = expected[static_cast<std::size_t>(i)];
    p.x = p.y = p.z = value;
  }
  if (!std::isfinite(value)) expected.is_dense = false;
  return expected;
}

/// sameClouds(), but any NaN equals any other.
template <typename CloudT>
bool samePlaces(const CloudT& a, const CloudT& b) {
  const auto same = [](auto p, auto q) { return p == q || (std::isnan(p) && std::isnan(q)); };
  return a.size() == b.size() && a.width == b.width && a.height == b.height && a.is_dense == b.is_dense &&
         std::equal(a.begin(), a.end(), b.begin(), [&](const auto& p, const auto& q) {
           return same(p.x, q.x) && same(p.y, q.y) && same(p.z, q.z) && sameFields(p, q, false);
         });
}

TYPED_TEST_P(FilterContract, Line18ResultIsOneRowUnlessComplete) {
  auto segmenter = this->recording(this->scan_);
  const pcl::Indices kept = this->filterIndices(segmenter);
  const auto cloud = this->filterCloud(segmenter);
  EXPECT_EQ(cloud.size(), kept.size());
  EXPECT_EQ(cloud.width, kept.size());
  EXPECT_EQ(cloud.height, 1U);
}

TYPED_TEST_P(FilterContract, Line18AsManyPointsAsTheInputInAnotherOrder) {
  // Ground alone, as many indices as points: PCL's copyPointCloud would copy the input as it stands.
  using Cloud = typename TestFixture::CloudT;
  auto segmenter = this->recording(this->scan_);
  segmenter.setNegative(true);
  const Cloud ground = this->filterCloud(segmenter);
  const pcl::IndicesPtr reversed(new pcl::Indices(allIndices(ground.size())));
  std::reverse(reversed->begin(), reversed->end());
  reversed->back() = reversed->front();  // a double, and one point left out
  segmenter.setInputCloud(pcl::make_shared<Cloud>(ground));
  segmenter.setIndices(reversed);
  const pcl::Indices kept = this->filterIndices(segmenter);
  const auto output = this->filterCloud(segmenter);
  ASSERT_EQ(output.size(), kept.size());
  for (std::size_t n = 0; n < kept.size(); ++n)
    ASSERT_TRUE(sameFields(output[n], ground[static_cast<std::size_t>(kept[n])]));
}

TYPED_TEST_P(FilterContract, Line18CompleteResultKeepsWidthAndHeight) {
  // All in one place: no method can tell some of them from the others.
  const auto cloud = cloudOf<typename TypeParam::Point>(Eigen::Matrix3Xf::Constant(3, 12, 0.5f));
  cloud->width = 4;
  cloud->height = 3;
  auto segmenter = this->recording(cloud);
  segmenter.setNegative(true);
  pcl::Indices kept = this->filterIndices(segmenter);
  if (kept.size() != cloud->size()) {  // a method may as well call them all objects
    segmenter.setNegative(false);
    kept = this->filterIndices(segmenter);
  }
  ASSERT_EQ(kept, allIndices(12));
  EXPECT_TRUE(sameClouds(this->filterCloud(segmenter), *cloud));

  segmenter.setIndices(pcl::IndicesPtr(new pcl::Indices{11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 1}));
  const auto reordered = this->filterCloud(segmenter);
  EXPECT_EQ(reordered.width, 12U);
  EXPECT_EQ(reordered.height, 1U);
  ASSERT_EQ(reordered.size(), 12U);
  EXPECT_TRUE(sameFields(reordered[0], (*cloud)[11]));
  EXPECT_TRUE(sameFields(reordered[11], (*cloud)[1]));
}

TYPED_TEST_P(FilterContract, Line19FieldsHeaderAndSensorPoseAreCopied) {
  auto segmenter = this->recording(this->scan_);
  const pcl::Indices kept = this->filterIndices(segmenter);
  auto output = *this->spoilt_;  // old content
  output.header.frame_id = "old";
  output.sensor_origin_.setZero();
  output.sensor_orientation_.setIdentity();
  segmenter.filter(output);
  ASSERT_EQ(output.size(), kept.size());
  for (std::size_t n = 0; n < kept.size(); ++n)
    ASSERT_TRUE(sameFields(output[n], (*this->scan_)[static_cast<std::size_t>(kept[n])]));
  EXPECT_EQ(output.header.frame_id, this->scan_->header.frame_id);
  EXPECT_EQ(output.header.stamp, this->scan_->header.stamp);
  EXPECT_EQ(output.header.seq, this->scan_->header.seq);
  EXPECT_EQ(output.sensor_origin_, this->scan_->sensor_origin_);
  EXPECT_EQ(output.sensor_orientation_.coeffs(), this->scan_->sensor_orientation_.coeffs());
}

TYPED_TEST_P(FilterContract, Line20DensityIsThatOfTheInput) {
  for (const auto& input : {this->scan_, this->spoilt_}) {
    auto segmenter = this->recording(input);
    for (const bool negative : {false, true}) {
      segmenter.setNegative(negative);
      auto output = *input;
      output.is_dense = !input->is_dense;
      segmenter.filter(output);
      EXPECT_EQ(output.is_dense, input->is_dense);
    }
  }
}

TYPED_TEST_P(FilterContract, Line21KeepOrganizedReplacesRemovedCoordinatesOnly) {
  for (const auto& input : {this->scan_, this->spoilt_})
    for (const bool negative : {false, true}) {
      auto segmenter = this->recording(input);
      segmenter.setNegative(negative);
      this->filterIndices(segmenter);
      const pcl::Indices removed = *segmenter.getRemovedIndices();
      ASSERT_FALSE(removed.empty());
      segmenter.setKeepOrganized(true);
      EXPECT_TRUE(samePlaces(this->filterCloud(segmenter), organisedResult(*input, removed, NOT_A_NUMBER)));
      segmenter.setUserFilterValue(-7.5f);
      EXPECT_TRUE(samePlaces(this->filterCloud(segmenter), organisedResult(*input, removed, -7.5f)));
      EXPECT_EQ(*segmenter.getRemovedIndices(), removed);
    }
}

TYPED_TEST_P(FilterContract, Line22KeepOrganizedDensity) {
  for (const auto& input : {this->scan_, this->spoilt_}) {
    auto segmenter = this->recording(input);
    segmenter.setKeepOrganized(true);
    EXPECT_FALSE(this->filterCloud(segmenter).is_dense);
    segmenter.setUserFilterValue(std::numeric_limits<float>::infinity());
    EXPECT_FALSE(this->filterCloud(segmenter).is_dense);
    segmenter.setUserFilterValue(0.0f);
    EXPECT_EQ(this->filterCloud(segmenter).is_dense, input->is_dense);
  }
}

TYPED_TEST_P(FilterContract, Line23KeepOrganizedTouchesListedPointsOnly) {
  auto segmenter = this->recording(this->spoilt_);
  segmenter.setIndices(shuffledIndices(this->spoilt_->size()));
  const pcl::Indices kept = this->filterIndices(segmenter);
  const pcl::Indices removed = *segmenter.getRemovedIndices();
  segmenter.setKeepOrganized(true);
  EXPECT_EQ(this->filterIndices(segmenter), kept);
  EXPECT_TRUE(
      samePlaces(this->filterCloud(segmenter), organisedResult(*this->spoilt_, removed, NOT_A_NUMBER)));

  segmenter.setIndices(pcl::IndicesPtr(new pcl::Indices));
  EXPECT_TRUE(samePlaces(this->filterCloud(segmenter), *this->spoilt_));
  segmenter.setInputCloud(this->scan_);
  EXPECT_TRUE(samePlaces(this->filterCloud(segmenter), *this->scan_));
  segmenter.setIndices(pcl::IndicesPtr(new pcl::Indices{-1}));
  const OutputCapture capture;
  EXPECT_TRUE(this->filterCloud(segmenter).empty());
}

TYPED_TEST_P(FilterContract, Line23KeepOrganizedIsQuietAndLeavesTheRemovedFlagAlone) {
  auto& segmenter = this->segmenter_;
  segmenter.setInputCloud(this->scan_);
  const OutputCapture before;
  this->filterCloud(segmenter);
  const std::string logged = before.standard_error.text();
  segmenter.setKeepOrganized(true);
  const OutputCapture capture;
  this->filterCloud(segmenter);
  EXPECT_EQ(capture.standard_error.text(), logged);
  segmenter.setKeepOrganized(false);
  this->filterIndices(segmenter);
  EXPECT_TRUE(segmenter.getRemovedIndices()->empty());
}

TYPED_TEST_P(FilterContract, Line24WorksInPlace) {
  for (const bool negative : {false, true})
    for (const bool keep_organized : {false, true}) {
      const auto configure = [&](auto& segmenter) {
        segmenter.setNegative(negative);
        segmenter.setKeepOrganized(keep_organized);
      };
      auto separate = this->recording(this->spoilt_);
      configure(separate);
      const auto expected = this->filterCloud(separate);
      const auto cloud = cloudOf<typename TypeParam::Point>(this->scene_);
      spoilPoints(*cloud);
      auto in_place = this->recording(cloud);
      configure(in_place);
      in_place.filter(*cloud);
      EXPECT_TRUE(samePlaces(*cloud, expected));
      EXPECT_EQ(cloud->header.frame_id, expected.header.frame_id);
      EXPECT_EQ(cloud->sensor_origin_, expected.sensor_origin_);
      EXPECT_EQ(*in_place.getRemovedIndices(), *separate.getRemovedIndices());
    }
}

}  // namespace pcl_fft_ground::test
