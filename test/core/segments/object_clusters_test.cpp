#include "pcl_fft_ground/core/segments/object_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

#include "pcl_fft_ground/core/segments/voxel_clusters.h"

namespace pcl_fft_ground::core {
namespace {

using Clusters = std::vector<std::vector<Eigen::Index>>;

constexpr ObjectClusterParameters METRIC = {0.028, 0.125};

/// A body that rises above a flat ground: a ball, or with a length a capsule without its round ends.
struct Body {
  Eigen::Vector3d centre;
  double radius;
  double length = 0;                               ///< of a cylinder along the axis; 0: a ball
  Eigen::Vector2d axis = Eigen::Vector2d::Zero();  ///< horizontal, unit length

  /// Height of its upper side at a place; 0, the ground, beside it.
  double top(double x, double y) const {
    const Eigen::Vector2d from_centre = Eigen::Vector2d(x, y) - centre.head<2>();
    const double along = from_centre.dot(axis);
    if (length > 0 && std::abs(along) > 0.5 * length) return 0;
    const double across = (from_centre - along * axis).squaredNorm();
    const double square = radius * radius - across;
    return square > 0 ? std::max(0.0, centre.z() + std::sqrt(square)) : 0;
  }
};

/// What is seen of bodies from above, and of which of them each point is.
struct View {
  Points points;
  std::vector<int> body;
};

/// Points above the ground every 7 mm or so within 2 m x 2 m, with noise of 2 mm in height.
View viewOf(const std::vector<Body>& bodies) {
  constexpr double SPACING = 0.007, LEAST_HEIGHT = 0.012, NOISE = 0.002;
  std::mt19937 random(5);
  const auto uniform = [&] { return static_cast<double>(random() % 10001) / 10000; };
  std::vector<Eigen::Vector3f> points;
  View view;
  for (double x = -1; x < 1; x += SPACING)
    for (double y = -1; y < 1; y += SPACING) {
      const double at_x = x + SPACING * uniform(), at_y = y + SPACING * uniform();
      const double noise = NOISE * (uniform() + uniform() + uniform() - 1.5);
      const auto higher = [&](const Body& a, const Body& b) { return a.top(at_x, at_y) < b.top(at_x, at_y); };
      const auto highest = std::max_element(bodies.begin(), bodies.end(), higher);
      const double height = highest->top(at_x, at_y);
      if (height < LEAST_HEIGHT) continue;
      points.emplace_back(at_x, at_y, height + noise);
      view.body.push_back(static_cast<int>(highest - bodies.begin()));
    }
  view.points.resize(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n) view.points.col(static_cast<Eigen::Index>(n)) = points[n];
  return view;
}

/// Share of the points of a body that are in that cluster which holds most of them, less what else it holds.
double shareFound(const View& view, const Clusters& clusters, int body) {
  const auto total = static_cast<double>(std::count(view.body.begin(), view.body.end(), body));
  double best = 0;
  for (const auto& cluster : clusters) {
    const auto common =
        static_cast<double>(std::count_if(cluster.begin(), cluster.end(), [&](Eigen::Index n) {
          return view.body[static_cast<std::size_t>(n)] == body;
        }));
    best = std::max(best, common / (total + static_cast<double>(cluster.size()) - common));
  }
  return best;
}

/// \param points number of them that a cluster needs to count
std::size_t clustersOf(const Clusters& clusters, std::size_t points) {
  return static_cast<std::size_t>(
      std::count_if(clusters.begin(), clusters.end(), [&](const auto& c) { return c.size() >= points; }));
}

const Eigen::Vector2d ALONG_X = Eigen::Vector2d::UnitX(), ALONG_Y = Eigen::Vector2d::UnitY();

std::vector<Body> heap() {
  return {{{-0.25, 0, 0}, 0.2},
          {{0.1, 0.02, 0.02}, 0.2},
          {{-0.1, 0.3, 0}, 0.17},
          {{0.5, 0, 0.05}, 0.08, 1.2, ALONG_Y}};
}

TEST(ObjectClusters, TellTouchingBallsApart) {
  const View view = viewOf(heap());
  ASSERT_EQ(voxelClusters(view.points, METRIC.leaf_size).size(), 2U) << "the balls do not touch";
  const Clusters clusters = objectClusters(view.points, METRIC);
  EXPECT_EQ(clusters.size(), 4U);
  for (int body = 0; body < 4; ++body) EXPECT_GT(shareFound(view, clusters, body), 0.93) << "body " << body;
}

TEST(ObjectClusters, ABodyStaysWhole) {
  const std::vector<std::vector<Body>> bodies = {
      {{{0, 0, 0}, 0.4}},
      {{{0, 0, -0.05}, 0.15}},
      {{{0, 0, 0.05}, 0.1, 1.6, ALONG_X}},
      {{{0, 0, 0.02}, 0.05, 0.5, Eigen::Vector2d(0.6, 0.8)}},
      {{{0, 0, 0.03}, 0.1, 1.2, ALONG_X}, {{0.56, 0, 0.03}, 0.125, 0.12, ALONG_X}},  // a pipe with its socket
      {{{0, 0, 0.02}, 0.1, 0.6, ALONG_X}, {{0.38, 0, 0.02}, 0.06, 0.2, ALONG_X}},    // a body with its neck
  };
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    SCOPED_TRACE(testing::Message() << "body " << k);
    EXPECT_EQ(objectClusters(viewOf(bodies[k]).points, METRIC).size(), 1U);
  }
}

TEST(ObjectClusters, APipeUnderAnotherOneIsOnePipe) {
  const View view = viewOf({{{0, 0, 0.02}, 0.07, 1.6, ALONG_X}, {{0.1, 0, 0.1}, 0.09, 1.4, ALONG_Y}});
  const Clusters clusters = objectClusters(view.points, METRIC);
  EXPECT_EQ(clusters.size(), 2U);
  EXPECT_GT(shareFound(view, clusters, 0), 0.93);
  EXPECT_GT(shareFound(view, clusters, 1), 0.93);
}

TEST(ObjectClusters, PipesThatMeetAtAnAngleAreTwo) {
  const View view = viewOf({{{-0.4, 0, 0.02}, 0.08, 0.8, ALONG_X}, {{0.08, 0.4, 0.02}, 0.08, 1.0, ALONG_Y}});
  const Clusters clusters = objectClusters(view.points, METRIC);
  EXPECT_EQ(clusters.size(), 2U);
  EXPECT_GT(shareFound(view, clusters, 0), 0.9);
}

TEST(ObjectClusters, WhatIsSmallerThanTheSmallestObjectIsAMark) {
  const View view = viewOf({{{0, 0, 0}, 0.3}, {{0.33, 0, 0}, 0.07}});
  EXPECT_EQ(objectClusters(view.points, {METRIC.leaf_size, 0.08}).size(), 2U);
  EXPECT_EQ(objectClusters(view.points, {METRIC.leaf_size, 0.2}).size(), 1U);
}

TEST(ObjectClusters, CutContactClustersAndLeaveOutNothing) {
  const View view = viewOf(heap());
  std::vector<std::size_t> contact(view.body.size());
  const Clusters touching = voxelClusters(view.points, METRIC.leaf_size);
  for (std::size_t k = 0; k < touching.size(); ++k)
    for (const Eigen::Index n : touching[k]) contact[static_cast<std::size_t>(n)] = k;
  std::vector<int> times(view.body.size(), 0);
  for (const auto& cluster : objectClusters(view.points, METRIC)) {
    EXPECT_TRUE(std::is_sorted(cluster.begin(), cluster.end()));
    for (const Eigen::Index n : cluster) {
      ++times[static_cast<std::size_t>(n)];
      EXPECT_EQ(contact[static_cast<std::size_t>(n)], contact[static_cast<std::size_t>(cluster.front())]);
    }
  }
  EXPECT_EQ(times, std::vector<int>(view.body.size(), 1));
}

TEST(ObjectClusters, DoNotDependOnTheOrderOfThePoints) {
  const View view = viewOf(heap());
  std::vector<Eigen::Index> order(view.body.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  Points shuffled(3, view.points.cols());
  for (std::size_t n = 0; n < order.size(); ++n)
    shuffled.col(static_cast<Eigen::Index>(n)) = view.points.col(order[n]);
  Clusters clusters = objectClusters(shuffled, METRIC);
  for (auto& cluster : clusters) {
    for (Eigen::Index& n : cluster) n = order[static_cast<std::size_t>(n)];
    std::sort(cluster.begin(), cluster.end());
  }
  EXPECT_EQ(clusters, objectClusters(view.points, METRIC));
}

TEST(ObjectClusters, KnowNoScale) {
  const View view = viewOf(heap());
  constexpr float SCALE = 256;
  EXPECT_EQ(
      objectClusters(view.points * SCALE, {SCALE * METRIC.leaf_size, SCALE * METRIC.minimum_object_size}),
      objectClusters(view.points, METRIC));
}

TEST(ObjectClusters, OfAThinScanUseCoarserColumns) {
  const View view = viewOf(heap());
  Points thin(3, view.points.cols() / 5);  // 5 points per voxel's column: 1.3 per quarter
  for (Eigen::Index n = 0; n < thin.cols(); ++n) thin.col(n) = view.points.col(5 * n);
  View thinned{thin, {}};
  for (Eigen::Index n = 0; n < thin.cols(); ++n)
    thinned.body.push_back(view.body[static_cast<std::size_t>(5 * n)]);
  const Clusters clusters = objectClusters(thin, METRIC);
  EXPECT_EQ(clustersOf(clusters, 20), 4U);
  for (int body = 0; body < 4; ++body)
    EXPECT_GT(shareFound(thinned, clusters, body), 0.85) << "body " << body;
}

TEST(ObjectClusters, OfFewPoints) {
  EXPECT_TRUE(objectClusters(Points(3, 0), METRIC).empty());
  EXPECT_EQ(objectClusters(Eigen::Vector3f(1, 2, 3), METRIC), (Clusters{{0}}));
  EXPECT_EQ(objectClusters(Points::Zero(3, 4), METRIC), (Clusters{{0, 1, 2, 3}}));
  Points apart = Points::Zero(3, 3);
  apart.row(0) << 1e6F, -1e30F, 1e6F;
  EXPECT_EQ(objectClusters(apart, METRIC), (Clusters{{0, 2}, {1}}));
}

TEST(ObjectClusters, RefuseLengthsThatAreNone) {
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(objectClusters(Points(3, 0), {bad, 0.1}), std::invalid_argument);
    EXPECT_THROW(objectClusters(Points(3, 0), {0.02, bad}), std::invalid_argument);
  }
}

}  // namespace
}  // namespace pcl_fft_ground::core
