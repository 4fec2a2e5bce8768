#include "pcl_fft_ground/core/align/nearest_neighbours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

class ColumnNeighboursOfSeed : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, ColumnNeighboursOfSeed, testing::Range(1U, 5U));

TEST_P(ColumnNeighboursOfSeed, AgreeWithBruteForce) {
  std::mt19937 random(GetParam());
  const Points points = test::randomBox(800, {-1, 2, 0}, {1, 3, 0.3}, random);
  const Points queries = test::randomBox(300, {-1.5, 1.5, -0.2}, {1.5, 3.5, 0.5}, random);
  std::vector<Eigen::Index> found;
  for (const double spacing : {0.001, 0.02, 0.3, 5.0}) {
    const auto search = columnNeighbours(points, spacing);
    for (Eigen::Index q = 0; q < queries.cols(); ++q)
      for (const float reach : {0.03F, 0.2F, 100.0F}) {
        SCOPED_TRACE(testing::Message()
                     << "seed " << GetParam() << " spacing " << spacing << " reach " << reach);
        const Eigen::ArrayXf distances = (points.colwise() - queries.col(q)).colwise().squaredNorm();
        const Neighbour nearest = search->nearest(queries.col(q), reach);
        if (distances.minCoeff() > reach * reach) {
          EXPECT_EQ(nearest.index, -1);
        } else {
          EXPECT_FLOAT_EQ(nearest.squared_distance, distances.minCoeff());
          EXPECT_FLOAT_EQ(distances[nearest.index], distances.minCoeff());
        }
        search->within(queries.col(q), reach, found);
        EXPECT_EQ(static_cast<Eigen::Index>(found.size()), (distances <= reach * reach).count());
      }
  }
}

TEST(ColumnNeighbours, OfNoPointsOrOne) {
  EXPECT_EQ(columnNeighbours(Points(3, 0), 0.02)->nearest(Eigen::Vector3f::Zero(), 1e6F).index, -1);
  const Points one = Eigen::Vector3f(1, 2, 3);
  const auto search = columnNeighbours(one, 0.02);
  EXPECT_EQ(search->nearest(Eigen::Vector3f(1000, -1000, 0), 1e6F).index, 0);
  EXPECT_EQ(search->nearest(Eigen::Vector3f(1, 2, 3.5F), 0.4F).index, -1);
}

TEST(ColumnNeighbours, OnePointFarAwayDoesNotMatter) {
  std::mt19937 random(1);
  Points points = test::randomBox(1000, {0, 0, 0}, {1, 1, 0}, random);
  points.col(7) << 1e7F, -1e7F, 0;
  const auto search = columnNeighbours(points, 0.02);
  EXPECT_EQ(search->nearest(points.col(3), 0.1F).index, 3);
}

}  // namespace
}  // namespace pcl_fft_ground::core
