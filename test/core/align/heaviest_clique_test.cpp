#include "align/segment_matching.h"

#include <gtest/gtest.h>

#include <random>

#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

double weightOf(const std::vector<std::size_t>& clique, const std::vector<double>& weights) {
  double sum = 0;
  for (const std::size_t vertex : clique) sum += weights[vertex];
  return sum;
}

bool isClique(const std::vector<std::size_t>& vertices, const Adjacency& joined) {
  for (const std::size_t a : vertices)
    for (const std::size_t b : vertices)
      if (a != b && !joined[a][b]) return false;
  return true;
}

/// Tries all sets of vertices.
double slowWeight(const std::vector<double>& weights, const Adjacency& joined) {
  double best = 0;
  for (unsigned set = 0; set < 1U << weights.size(); ++set) {
    std::vector<std::size_t> vertices;
    for (std::size_t n = 0; n < weights.size(); ++n)
      if ((set >> n & 1U) != 0) vertices.push_back(n);
    if (isClique(vertices, joined)) best = std::max(best, weightOf(vertices, weights));
  }
  return best;
}

class HeaviestCliqueOfSeed : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, HeaviestCliqueOfSeed, testing::Range(1U, 21U));

TEST_P(HeaviestCliqueOfSeed, AgreesWithAllSets) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  constexpr std::size_t COUNT = 13;
  const double density = test::uniform(random, 0.1, 0.9);
  std::vector<double> weights(COUNT);
  for (double& weight : weights) weight = test::uniform(random, 0.1, 2);
  Adjacency joined(COUNT, std::vector<bool>(COUNT, false));
  for (std::size_t a = 0; a < COUNT; ++a)
    for (std::size_t b = 0; b < a; ++b) joined[a][b] = joined[b][a] = test::uniform(random, 0, 1) < density;
  const std::vector<std::size_t> clique = heaviestClique(weights, joined);
  EXPECT_TRUE(isClique(clique, joined));
  EXPECT_DOUBLE_EQ(weightOf(clique, weights), slowWeight(weights, joined));
}

TEST(HeaviestClique, OfNothingIsEmptyAndOfOneIsThatOne) {
  EXPECT_TRUE(heaviestClique({}, {}).empty());
  EXPECT_EQ(heaviestClique({0.5}, {{false}}), std::vector<std::size_t>{0});
}

}  // namespace
}  // namespace pcl_fft_ground::core
