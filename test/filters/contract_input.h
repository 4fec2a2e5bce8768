#pragma once

// FILTER_CONTRACT, lines 1 to 7: input.

#include "contract_fixture.h"

namespace pcl_fft_ground::test {

TYPED_TEST_P(FilterContract, Line01WithoutInputNothingHappens) {
  pcl::Indices indices = {7, 8};
  auto output = *this->scan_;
  pcl::PointIndices ground, objects;
  ground.indices = objects.indices = {1};
  const OutputCapture capture;
  EXPECT_NO_THROW(this->segmenter_.filter(indices));
  EXPECT_NO_THROW(this->segmenter_.filter(output));
  constexpr bool PCL_IS_SILENT = std::is_same_v<typename TypeParam::Filtered, pcl::PCLPointCloud2>;
  EXPECT_NE(capture.standard_error.text().find("[initCompute] No input set.") == std::string::npos,
            !PCL_IS_SILENT);
  EXPECT_EQ(indices, (pcl::Indices{7, 8}));
  EXPECT_TRUE(sameClouds(output, *this->scan_));
  EXPECT_NO_THROW(this->segmenter_.segment(ground, objects));
  EXPECT_TRUE(ground.indices.empty() && objects.indices.empty());
}

TYPED_TEST_P(FilterContract, Line02EmptyCloudGivesEmptyResults) {
  const auto empty = cloudOf<typename TypeParam::Point>(Eigen::Matrix3Xf(3, 0));
  auto segmenter = this->recording(empty);
  pcl::Indices indices = {1, 2};
  segmenter.filter(indices);
  EXPECT_TRUE(indices.empty());
  EXPECT_TRUE(segmenter.getRemovedIndices()->empty());
  auto output = *this->scan_;
  output.header.frame_id = "old";
  segmenter.filter(output);
  EXPECT_TRUE(output.empty());
  EXPECT_EQ(output.header.frame_id, empty->header.frame_id);
  EXPECT_EQ(output.header.stamp, empty->header.stamp);
  EXPECT_TRUE(segmenter.getRemovedIndices()->empty());
}

TYPED_TEST_P(FilterContract, Line03MutableIndicesAreAliasedOthersCopied) {
  auto segmenter = this->recording(this->scan_);
  const pcl::IndicesPtr aliased(new pcl::Indices(allIndices(3000)));
  segmenter.setIndices(aliased);
  EXPECT_EQ(segmenter.getIndices().get(), aliased.get());
  aliased->resize(2000);
  const pcl::Indices kept = this->filterIndices(segmenter);
  EXPECT_EQ(joined(kept, *segmenter.getRemovedIndices()), allIndices(2000));

  if constexpr (!std::is_same_v<typename TypeParam::Filtered, pcl::PCLPointCloud2>) {  // has no such overload
    const pcl::IndicesPtr later_changed(new pcl::Indices(allIndices(2000)));
    segmenter.setIndices(pcl::IndicesConstPtr(later_changed));
    later_changed->clear();
    EXPECT_EQ(this->filterIndices(segmenter), kept);
  }

  const pcl::PointIndices::Ptr point_indices(new pcl::PointIndices);
  point_indices->indices = allIndices(2000);
  segmenter.setIndices(pcl::PointIndices::ConstPtr(point_indices));
  point_indices->indices.clear();
  EXPECT_EQ(this->filterIndices(segmenter), kept);
}

TYPED_TEST_P(FilterContract, Line04ImplicitIndicesFollowTheCloudExplicitOnesPersist) {
  using Point = typename TypeParam::Point;
  const auto half = cloudOf<Point>(this->scene_.points.leftCols(3100));
  const auto size_of_both = [&](auto& segmenter) {
    const pcl::Indices kept = this->filterIndices(segmenter);
    return joined(kept, *segmenter.getRemovedIndices()).size();
  };
  auto segmenter = this->recording(half);
  EXPECT_EQ(size_of_both(segmenter), half->size());
  segmenter.setInputCloud(this->scan_);
  EXPECT_EQ(size_of_both(segmenter), this->scan_->size());
  segmenter.setInputCloud(half);
  EXPECT_EQ(size_of_both(segmenter), half->size());

  segmenter.setIndices(pcl::IndicesPtr(new pcl::Indices(allIndices(1000))));
  EXPECT_EQ(size_of_both(segmenter), 1000U);
  segmenter.setInputCloud(this->scan_);
  EXPECT_EQ(size_of_both(segmenter), 1000U);
  segmenter.setIndices(pcl::IndicesPtr());
  EXPECT_EQ(size_of_both(segmenter), this->scan_->size());
}

TYPED_TEST_P(FilterContract, Line05EmptyIndexListGivesAnEmptyResult) {
  auto segmenter = this->recording(this->scan_);
  segmenter.setIndices(pcl::IndicesPtr(new pcl::Indices));
  for (const bool negative : {false, true}) {
    segmenter.setNegative(negative);
    EXPECT_TRUE(this->filterIndices(segmenter).empty());
    EXPECT_TRUE(segmenter.getRemovedIndices()->empty());
    const auto output = this->filterCloud(segmenter);
    EXPECT_EQ(output.size(), 0U);
    EXPECT_EQ(output.width, 0U);
    EXPECT_EQ(output.height, 1U);
  }
}

TYPED_TEST_P(FilterContract, Line06InvalidIndexIsAnErrorWithAnEmptyResult) {
  const auto beyond = static_cast<pcl::index_t>(this->scan_->size());
  for (const pcl::index_t invalid : {pcl::index_t(-1), beyond, std::numeric_limits<pcl::index_t>::max()}) {
    auto segmenter = this->recording(this->scan_);
    this->filterIndices(segmenter);  // leaves a result behind
    segmenter.setIndices(pcl::IndicesPtr(new pcl::Indices{0, 1, invalid, 2}));
    for (const bool negative : {false, true}) {
      segmenter.setNegative(negative);
      const OutputCapture capture;
      pcl::Indices indices = {5};
      EXPECT_NO_THROW(segmenter.filter(indices));
      EXPECT_FALSE(capture.standard_error.text().empty());
      EXPECT_TRUE(indices.empty());
      EXPECT_TRUE(segmenter.getRemovedIndices()->empty());
      EXPECT_FALSE(segmenter.getError().empty());
      EXPECT_TRUE(this->filterCloud(segmenter).empty());
      EXPECT_TRUE(segmenter.getRemovedIndices()->empty());
      pcl::PointIndices ground, objects;
      EXPECT_NO_THROW(segmenter.segment(ground, objects));
      EXPECT_TRUE(ground.indices.empty() && objects.indices.empty());
    }
  }
}

TYPED_TEST_P(FilterContract, Line07InputIsNeverModified) {
  const auto before = *this->spoilt_;
  const pcl::IndicesPtr indices = shuffledIndices(before.size());
  const pcl::Indices indices_before = *indices;
  auto segmenter = this->recording(this->spoilt_);
  segmenter.setIndices(indices);
  for (const bool negative : {false, true})
    for (const bool keep_organized : {false, true}) {
      segmenter.setNegative(negative);
      segmenter.setKeepOrganized(keep_organized);
      segmenter.setUserFilterValue(-1.0f);
      this->filterIndices(segmenter);
      this->filterCloud(segmenter);
      this->labels(segmenter);
      EXPECT_TRUE(sameClouds(*this->spoilt_, before));
      EXPECT_EQ(*indices, indices_before);
    }
}

}  // namespace pcl_fft_ground::test
