#pragma once

// FILTER_CONTRACT, lines 8 to 17: indices out.

#include "contract_fixture.h"

namespace pcl_fft_ground::test {

TYPED_TEST_P(FilterContract, Line08OldContentIsDiscardedOrderAndMultiplicityKept) {
  auto segmenter = this->recording(this->spoilt_);
  const pcl::IndicesPtr shuffled = shuffledIndices(this->spoilt_->size());
  segmenter.setIndices(shuffled);
  pcl::PointIndices ground, objects;
  segmenter.segment(ground, objects);
  pcl::Indices kept = {123456, 1, 1};
  segmenter.filter(kept);
  EXPECT_EQ(kept, objects.indices);
  EXPECT_FALSE(kept.empty());
  auto next = kept.begin();  // the result is a subsequence of the list, each of its points in full number
  for (const pcl::index_t i : *shuffled)
    if (next != kept.end() && *next == i) ++next;
  EXPECT_EQ(next, kept.end());
  for (const pcl::index_t i : kept)
    ASSERT_EQ(std::count(kept.begin(), kept.end(), i), std::count(shuffled->begin(), shuffled->end(), i));
}

TYPED_TEST_P(FilterContract, Line09ResultAndRemovedTogetherAreTheInputIndices) {
  auto segmenter = this->recording(this->spoilt_);
  for (const pcl::IndicesPtr& indices : {pcl::IndicesPtr(), shuffledIndices(this->spoilt_->size()),
                                         pcl::IndicesPtr(new pcl::Indices{5, 9, 9})}) {
    segmenter.setIndices(indices);
    const pcl::Indices expected = indices ? sorted(*indices) : allIndices(this->spoilt_->size());
    for (const bool negative : {false, true}) {
      segmenter.setNegative(negative);
      const pcl::Indices kept = this->filterIndices(segmenter);
      EXPECT_EQ(joined(kept, *segmenter.getRemovedIndices()), expected);
      const pcl::Indices removed = *segmenter.getRemovedIndices();
      this->filterCloud(segmenter);
      EXPECT_EQ(*segmenter.getRemovedIndices(), removed);
    }
  }
}

TYPED_TEST_P(FilterContract, Line10NonFinitePointsAreAlwaysRemoved) {
  for (const bool claims_to_be_dense : {false, true}) {
    this->spoilt_->is_dense = claims_to_be_dense;
    auto segmenter = this->recording(this->spoilt_);
    for (const bool negative : {false, true}) {
      segmenter.setNegative(negative);
      const pcl::Indices kept = this->filterIndices(segmenter);
      EXPECT_FALSE(kept.empty());
      EXPECT_EQ(this->finiteOf(*this->spoilt_, kept), kept);
      const pcl::Indices removed = sorted(*segmenter.getRemovedIndices());
      for (std::size_t n = 0; n < this->spoilt_->size(); ++n)
        ASSERT_TRUE(isFinitePoint((*this->spoilt_)[n]) ||
                    std::binary_search(removed.begin(), removed.end(), static_cast<pcl::index_t>(n)));
    }
  }
}

TYPED_TEST_P(FilterContract, Line10NanInOtherFieldsIsIrrelevant) {
  auto segmenter = this->recording(this->scan_);
  const std::vector<int> expected = this->labels(segmenter);
  for (auto& point : *this->scan_) setOtherFields(point, 0xFF);
  EXPECT_EQ(this->labels(segmenter), expected);
}

TYPED_TEST_P(FilterContract, Line11ModesAreDisjointAndTogetherAllFinitePoints) {
  auto segmenter = this->recording(this->spoilt_);
  for (const pcl::IndicesPtr& indices : {pcl::IndicesPtr(), shuffledIndices(this->spoilt_->size())}) {
    segmenter.setIndices(indices);
    segmenter.setNegative(false);
    const pcl::Indices positive = this->filterIndices(segmenter);
    segmenter.setNegative(true);
    const pcl::Indices negative = this->filterIndices(segmenter);
    const pcl::Indices all = indices ? sorted(*indices) : allIndices(this->spoilt_->size());
    EXPECT_FALSE(positive.empty());
    EXPECT_FALSE(negative.empty());
    EXPECT_EQ(joined(positive, negative), this->finiteOf(*this->spoilt_, all));
    pcl::Indices common;
    const pcl::Indices a = sorted(positive), b = sorted(negative);
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
    EXPECT_TRUE(common.empty());
  }
}

TYPED_TEST_P(FilterContract, Line12RemovedIndicesAreEmptyByDefault) {
  ASSERT_NE(this->segmenter_.getRemovedIndices(), nullptr);
  EXPECT_TRUE(this->segmenter_.getRemovedIndices()->empty());
  this->segmenter_.setInputCloud(this->spoilt_);
  for (const bool keep_organized : {false, true}) {
    this->segmenter_.setKeepOrganized(keep_organized);
    this->filterIndices(this->segmenter_);
    this->filterCloud(this->segmenter_);
    ASSERT_NE(this->segmenter_.getRemovedIndices(), nullptr);
    EXPECT_TRUE(this->segmenter_.getRemovedIndices()->empty());
  }
}

TYPED_TEST_P(FilterContract, Line13RemovedIndicesLeaveTheHeaderAlone) {
  auto segmenter = this->recording(this->scan_);
  this->filterIndices(segmenter);
  pcl::PointIndices removed;
  removed.header.frame_id = "mine";
  removed.header.stamp = 5;
  removed.indices = {1};
  segmenter.getRemovedIndices(removed);
  EXPECT_EQ(removed.indices, *segmenter.getRemovedIndices());
  EXPECT_GT(removed.indices.size(), 1U);
  EXPECT_EQ(removed.header.frame_id, "mine");
  EXPECT_EQ(removed.header.stamp, 5U);
}

TYPED_TEST_P(FilterContract, Line14EveryRunMakesAFreshRemovedList) {
  auto segmenter = this->recording(this->scan_);
  this->filterIndices(segmenter);
  const pcl::IndicesConstPtr held = segmenter.getRemovedIndices();
  const pcl::Indices content = *held;
  const auto copy = segmenter;
  segmenter.setNegative(true);
  this->filterIndices(segmenter);
  EXPECT_NE(*segmenter.getRemovedIndices(), content);
  EXPECT_EQ(*held, content);
  EXPECT_EQ(*copy.getRemovedIndices(), content);
  this->filterCloud(segmenter);
  EXPECT_EQ(*held, content);
}

TYPED_TEST_P(FilterContract, Line15OutputMayBeTheInputIndices) {
  const pcl::IndicesPtr indices = shuffledIndices(this->spoilt_->size());
  auto separate = this->recording(this->spoilt_);
  separate.setIndices(pcl::IndicesPtr(new pcl::Indices(*indices)));
  for (const bool negative : {false, true}) {
    separate.setNegative(negative);
    const pcl::Indices expected = this->filterIndices(separate);
    const pcl::IndicesPtr both(new pcl::Indices(*indices));
    auto segmenter = this->recording(this->spoilt_);
    segmenter.setNegative(negative);
    segmenter.setIndices(both);
    segmenter.filter(*both);
    EXPECT_EQ(*both, expected);
    EXPECT_EQ(*segmenter.getRemovedIndices(), *separate.getRemovedIndices());
  }
}

TYPED_TEST_P(FilterContract, Line16BothOverloadsAgree) {
  auto segmenter = this->recording(this->spoilt_);
  for (const pcl::IndicesPtr& list : {pcl::IndicesPtr(), shuffledIndices(this->spoilt_->size())}) {
    segmenter.setIndices(list);
    for (const bool negative : {false, true}) {
      segmenter.setNegative(negative);
      const pcl::Indices indices = this->filterIndices(segmenter);
      const auto cloud = this->filterCloud(segmenter);
      ASSERT_EQ(cloud.size(), indices.size());
      for (std::size_t n = 0; n < cloud.size(); ++n)
        ASSERT_TRUE(sameFields(cloud[n], (*this->spoilt_)[static_cast<std::size_t>(indices[n])]));
    }
  }
}

TYPED_TEST_P(FilterContract, Line17RepeatedCallsAreIdenticalAndSettersActOnTheNext) {
  auto segmenter = this->recording(this->scan_);
  const pcl::Indices objects = this->filterIndices(segmenter);
  const auto cloud = this->filterCloud(segmenter);
  EXPECT_EQ(this->filterIndices(segmenter), objects);
  EXPECT_TRUE(sameClouds(this->filterCloud(segmenter), cloud));
  segmenter.setNegative(true);
  EXPECT_NE(this->filterIndices(segmenter), objects);
  segmenter.setNegative(false);
  EXPECT_EQ(this->filterIndices(segmenter), objects);
  EXPECT_TRUE(sameClouds(this->filterCloud(segmenter), cloud));
}

}  // namespace pcl_fft_ground::test
