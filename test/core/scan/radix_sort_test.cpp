#include "scan/radix_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace pcl_fft_ground::core {
namespace {

TEST(RadixSort, GivesTheOrderOfComparisons) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal(0, 1);
  for (const std::size_t count : {0, 1, 2, 3, 4000}) {
    SCOPED_TRACE(count);
    std::vector<float> values(count);
    for (float& value : values) value = normal(random);
    std::vector<float> expected = values;
    std::sort(expected.begin(), expected.end());
    RadixSort()(values);
    EXPECT_EQ(values, expected);
  }
}

TEST(RadixSort, KnowsAllMagnitudesAndBothSigns) {
  constexpr float INF = std::numeric_limits<float>::infinity(), MAX = std::numeric_limits<float>::max(),
                  TINY = std::numeric_limits<float>::denorm_min();
  const std::vector<float> ascending{-INF, -MAX, -1e3F, -1, -1e-30F, -TINY, 0, TINY, 1e-30F, 1, 1, MAX, INF};
  std::vector<float> values = ascending;
  std::reverse(values.begin(), values.end());
  RadixSort()(values);
  EXPECT_EQ(values, ascending);
}

}  // namespace
}  // namespace pcl_fft_ground::core
