#pragma once

// FILTER_CONTRACT, lines 25 to 29 and 31 to 33: interface and pipeline.

#include <thread>
#include <type_traits>

#include <pcl/exceptions.h>

#include "contract_fixture.h"
#include "euclidean_clusters.h"

namespace pcl_fft_ground::test {

TYPED_TEST_P(FilterContract, Line25UsableThroughTheBasePointers) {
  using Point = typename TypeParam::Filtered;
  using Segmenter = typename TypeParam::Segmenter;
  static_assert(std::is_base_of_v<pcl::FilterIndices<Point>, Segmenter>);
  static_assert(std::is_base_of_v<GroundSegmentation<Point>, Segmenter>);
  static_assert(std::is_same_v<typename Segmenter::Ptr, pcl::shared_ptr<Segmenter>>);
  static_assert(std::is_same_v<typename Segmenter::ConstPtr, pcl::shared_ptr<const Segmenter>>);
  EXPECT_EQ(Opened<Segmenter>().getClassName(), TypeParam::Traits::NAME);

  auto reference = this->recording(this->scan_);
  const auto objects = this->filterCloud(reference);
  const typename Segmenter::Ptr segmenter(new Segmenter(true));
  TypeParam::Traits::setUp(*segmenter);
  const typename pcl::Filter<Point>::Ptr filter = segmenter;
  filter->setInputCloud(this->scan_);
  typename TestFixture::CloudT output;
  filter->filter(output);
  EXPECT_TRUE(sameClouds(output, objects));
  EXPECT_EQ(filter->getRemovedIndices()->size(), this->scan_->size() - objects.size());

  const pcl::shared_ptr<pcl::FilterIndices<Point>> indices_filter = segmenter;
  pcl::Indices indices;
  indices_filter->filter(indices);
  EXPECT_EQ(indices, this->filterIndices(reference));
  indices_filter->filter(output);
  EXPECT_TRUE(sameClouds(output, objects));
  const typename GroundSegmentation<Point>::Ptr ground_segmentation = segmenter;
  pcl::PointIndices ground, also_objects;
  ground_segmentation->segment(ground, also_objects);
  EXPECT_EQ(also_objects.indices, indices);
}

TYPED_TEST_P(FilterContract, Line26SettersReadBackAndRejectInvalidValues) {
  auto& segmenter = this->segmenter_;
  segmenter.setUpDirection(Eigen::Vector3d(0, 3, 4));
  EXPECT_TRUE(segmenter.getUpDirection().isApprox(Eigen::Vector3d(0, 0.6, 0.8)));
  for (const UpEstimation estimation :
       {UpEstimation::AUTO, UpEstimation::PRINCIPAL_AXIS, UpEstimation::GIVEN}) {
    segmenter.setUpEstimation(estimation);
    EXPECT_EQ(segmenter.getUpEstimation(), estimation);
  }
  for (const Yaw yaw : {Yaw::MIN_AREA_RECTANGLE, Yaw::PRINCIPAL_AXES, Yaw::NONE}) {
    segmenter.setYaw(yaw);
    EXPECT_EQ(segmenter.getYaw(), yaw);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& invalid :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, nan, 1), Eigen::Vector3d(infinity, 0, 0)}) {
    try {
      segmenter.setUpDirection(invalid);
      ADD_FAILURE() << "accepted " << invalid.transpose();
    } catch (const pcl::PCLException& error) {
      EXPECT_NE(std::string(error.what()).find("up direction"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("above 0"), std::string::npos) << error.what();
    }
  }
  EXPECT_TRUE(segmenter.getUpDirection().isApprox(Eigen::Vector3d(0, 0.6, 0.8)));
}

TYPED_TEST_P(FilterContract, Line27IndicesHavePclsType) {
  using Segmenter = typename TypeParam::Segmenter;
  static_assert(
      std::is_same_v<std::decay_t<decltype(std::declval<Segmenter>().getFarPoints())>, pcl::Indices>);
  pcl::PointIndices ground, objects;
  this->segmenter_.setInputCloud(this->scan_);
  this->segmenter_.segment(ground, objects);
  static_assert(std::is_same_v<decltype(ground.indices), pcl::Indices>);
  static_assert(std::is_same_v<pcl::Indices::value_type, pcl::index_t>);
  EXPECT_EQ(joined(ground.indices, objects.indices), allIndices(this->scan_->size()));
}

TYPED_TEST_P(FilterContract, Line28TwoObjectsInTwoThreadsAreIndependent) {
  using Point = typename TypeParam::Point;
  const auto half = cloudOf<Point>(this->scene_.points.leftCols(3100));
  auto alone_whole = this->recording(this->spoilt_), alone_half = this->recording(half);
  const pcl::Indices expected_whole = this->filterIndices(alone_whole);
  const pcl::Indices expected_half = this->filterIndices(alone_half);

  auto first = this->recording(this->spoilt_), second = this->recording(half);
  const auto run_often = [](auto& segmenter, const pcl::Indices& expected, int& wrong) {
    for (int n = 0; n < 5; ++n) {
      pcl::Indices indices;
      segmenter.filter(indices);
      wrong += indices == expected ? 0 : 1;
    }
  };
  int wrong_first = 0, wrong_second = 0;
  std::thread thread([&] { run_often(first, expected_whole, wrong_first); });
  run_often(second, expected_half, wrong_second);
  thread.join();
  EXPECT_EQ(wrong_first, 0);
  EXPECT_EQ(wrong_second, 0);
}

TYPED_TEST_P(FilterContract, Line28CopiedFilterIsIndependent) {
  using Point = typename TypeParam::Point;
  const auto half = cloudOf<Point>(this->scene_.points.leftCols(3100));
  auto original = this->recording(this->scan_);
  const pcl::Indices expected_whole = this->filterIndices(original);
  auto alone = this->recording(half);
  const pcl::Indices expected_half = this->filterIndices(alone);

  auto copy = original;
  auto assigned = this->recording(half);
  this->filterIndices(assigned);
  assigned = original;
  copy.setInputCloud(half);  // resizes PCL's list of all points, which a copied PCLBase shares
  pcl::Indices whole, part;
  std::thread thread([&] {
    for (int n = 0; n < 5; ++n) copy.filter(part);
  });
  for (int n = 0; n < 5; ++n) original.filter(whole);
  thread.join();
  EXPECT_EQ(whole, expected_whole);
  EXPECT_EQ(part, expected_half);
  EXPECT_EQ(this->filterIndices(assigned), expected_whole);
  EXPECT_EQ(joined(whole, *original.getRemovedIndices()), allIndices(this->scan_->size()));
  EXPECT_EQ(joined(part, *copy.getRemovedIndices()), allIndices(half->size()));
}

TYPED_TEST_P(FilterContract, Line28PointOrderDoesNotMatter) {
  auto segmenter = this->recording(this->scan_);
  const std::vector<int> expected = this->labels(segmenter);
  const std::size_t size = this->scan_->size();
  typename TestFixture::CloudT permuted = *this->scan_;
  const auto source = [size](std::size_t n) { return (n * 2741 + 17) % size; };  // 2741 is prime
  for (std::size_t n = 0; n < size; ++n) permuted[n] = (*this->scan_)[source(n)];
  auto other = this->recording(pcl::make_shared<typename TestFixture::CloudT>(permuted));
  const std::vector<int> found = this->labels(other);
  for (std::size_t n = 0; n < size; ++n)
    EXPECT_TRUE(found[n] == expected[source(n)] || TypeParam::Traits::isAtSurface(other, permuted[n])) << n;
}

TYPED_TEST_P(FilterContract, Line28And32LabelsAreThoseOfPointXYZ) {
  typename TypeParam::template SegmenterOf<pcl::PointXYZ> plain;
  TypeParam::Traits::setUp(plain);
  const auto plain_scan = cloudOf<pcl::PointXYZ>(this->scene_);
  plain.setInputCloud(plain_scan);
  pcl::PointIndices ground, objects;
  plain.segment(ground, objects);
  auto segmenter = this->recording(this->scan_);
  const std::vector<int> found = this->labels(segmenter);
  std::vector<int> expected(found.size(), 0);
  for (const pcl::index_t i : objects.indices) expected[static_cast<std::size_t>(i)] = 1;
  for (std::size_t n = 0; n < found.size(); ++n)
    EXPECT_TRUE(found[n] == expected[n] || TypeParam::Traits::isAtSurface(plain, (*plain_scan)[n])) << n;
}

TYPED_TEST_P(FilterContract, Line29NothingOnStandardOutputErrorsOnStandardError) {
  auto segmenter = this->recording(this->spoilt_);
  const OutputCapture capture;
  for (const bool keep_organized : {false, true}) {
    segmenter.setKeepOrganized(keep_organized);
    this->filterIndices(segmenter);
    this->filterCloud(segmenter);
    this->labels(segmenter);
  }
  segmenter.setIndices(pcl::IndicesPtr(new pcl::Indices{-1}));
  const std::size_t logged = capture.standard_error.text().size();
  this->filterIndices(segmenter);
  EXPECT_NE(capture.standard_error.text().find(TypeParam::Traits::NAME, logged), std::string::npos);
  EXPECT_EQ(capture.standard_output.text(), "");
}

/// The points as those of the type that PCL brings its search tree compiled for.
template <typename CloudT>
pcl::PointCloud<pcl::PointXYZ>::Ptr placesOf(const CloudT& cloud) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr places(new pcl::PointCloud<pcl::PointXYZ>);
  for (const auto& p : cloud)
    places->push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
  places->is_dense = cloud.is_dense;
  return places;
}

TYPED_TEST_P(FilterContract, Line31ResultCanBeClusteredByPcl) {
  auto segmenter = this->recording(this->spoilt_);
  for (const bool negative : {false, true}) {
    segmenter.setNegative(negative);
    const auto result = this->filterCloud(segmenter);
    const pcl::IndicesPtr indices(new pcl::Indices(this->filterIndices(segmenter)));
    const auto clusters = euclideanClusters(placesOf(result), nullptr, 0.1, 20);
    const auto clusters_by_indices = euclideanClusters(placesOf(*this->spoilt_), indices, 0.1, 20);
    ASSERT_FALSE(clusters.empty());
    ASSERT_EQ(clusters_by_indices.size(), clusters.size());
    for (std::size_t n = 0; n < clusters.size(); ++n)
      EXPECT_EQ(clusters_by_indices[n].indices.size(), clusters[n].indices.size());
  }
}

TYPED_TEST_P(FilterContract, Line33SegmentGivesBothClasses) {
  auto segmenter = this->recording(this->spoilt_);
  const pcl::Indices objects_kept = this->filterIndices(segmenter);
  for (const bool negative : {false, true}) {
    segmenter.setNegative(negative);
    segmenter.setKeepOrganized(negative);
    pcl::PointIndices ground, objects;
    ground.indices = objects.indices = {1, 2, 3};
    segmenter.segment(ground, objects);
    EXPECT_EQ(objects.indices, objects_kept);
    EXPECT_EQ(joined(ground.indices, objects.indices),
              this->finiteOf(*this->spoilt_, allIndices(this->spoilt_->size())));
    for (const pcl::PointIndices& list : {ground, objects}) {
      EXPECT_EQ(list.header.frame_id, "sonar");
      EXPECT_EQ(list.header.stamp, 1234567U);
    }
    const pcl::IndicesPtr shuffled = shuffledIndices(this->spoilt_->size());
    segmenter.setIndices(shuffled);
    segmenter.segment(ground, objects);
    EXPECT_EQ(joined(ground.indices, objects.indices), this->finiteOf(*this->spoilt_, sorted(*shuffled)));
    segmenter.setIndices(pcl::IndicesPtr());
  }
}

}  // namespace pcl_fft_ground::test
