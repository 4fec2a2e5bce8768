#include "pcl_fft_ground/simulation/evaluation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

namespace pcl_fft_ground::core {
namespace {

TEST(Confusion, MeasuresOfAMatrixCountedByHand) {
  const Confusion confusion{40, 10, 45, 5};  // true and false positives, true and false negatives
  EXPECT_DOUBLE_EQ(confusion.truePositiveRate(), 40.0 / 45);
  EXPECT_DOUBLE_EQ(confusion.trueNegativeRate(), 45.0 / 55);
  EXPECT_DOUBLE_EQ(confusion.precision(), 0.8);
  EXPECT_DOUBLE_EQ(confusion.f1(), 80.0 / 95);
  EXPECT_DOUBLE_EQ(confusion.intersectionOverUnion(), 40.0 / 55);
  EXPECT_DOUBLE_EQ(confusion.totalError(), 0.15);
  EXPECT_DOUBLE_EQ(confusion.kappa(), 0.7);  // 0.85 agree, 0.5 x 0.45 + 0.5 x 0.55 would by chance
}

TEST(Confusion, PerfectAndInvertedLabels) {
  const Confusion perfect{30, 0, 70, 0}, inverted{0, 50, 0, 50};
  EXPECT_EQ(perfect.f1(), 1);
  EXPECT_EQ(perfect.totalError(), 0);
  EXPECT_DOUBLE_EQ(perfect.kappa(), 1);
  EXPECT_EQ(inverted.f1(), 0);
  EXPECT_EQ(inverted.totalError(), 1);
  EXPECT_DOUBLE_EQ(inverted.kappa(), -1);
}

TEST(Confusion, MeasuresWithoutAMeaningAreNan) {
  const Confusion nothing, only_ground{0, 0, 10, 0}, only_objects{10, 0, 0, 0};
  for (const double value : {nothing.truePositiveRate(), nothing.trueNegativeRate(), nothing.precision(),
                             nothing.f1(), nothing.intersectionOverUnion(), nothing.totalError(),
                             nothing.kappa(), only_ground.truePositiveRate(), only_ground.precision(),
                             only_ground.f1(), only_ground.intersectionOverUnion(), only_ground.kappa(),
                             only_objects.trueNegativeRate(), only_objects.kappa()})
    EXPECT_TRUE(std::isnan(value));
  EXPECT_EQ(only_ground.trueNegativeRate(), 1);
  EXPECT_EQ(only_ground.totalError(), 0);
  EXPECT_EQ(only_objects.f1(), 1);
}

TEST(Compare, AgreesWithAnIndependentCount) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::vector<int> truth;
    Labels labels;
    std::array<std::array<std::size_t, 3>, 5> counts{};  // by true label + 1, then label
    for (int n = 0; n < 5000; ++n) {
      const std::size_t row = random() % 5, column = random() % 3;
      truth.push_back(static_cast<int>(row) - 1);
      labels.push_back(static_cast<Label>(column));
      ++counts[row][column];
    }
    const Confusion confusion = compare(truth, labels);
    EXPECT_EQ(confusion.true_positives, counts[2][1]);
    EXPECT_EQ(confusion.false_positives, counts[1][1]);
    EXPECT_EQ(confusion.true_negatives, counts[1][0]);
    EXPECT_EQ(confusion.false_negatives, counts[2][0]);
  }
}

TEST(Compare, NothingToCompare) {
  const Confusion confusion = compare({}, {});
  EXPECT_EQ(confusion.true_positives + confusion.false_positives, 0U);
  EXPECT_EQ(confusion.true_negatives + confusion.false_negatives, 0U);
}

TEST(Compare, RefusesListsOfDifferentLengths) {
  EXPECT_THROW(compare({0, 1}, {Label::GROUND}), std::invalid_argument);
  EXPECT_THROW(compare({}, {Label::GROUND}), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_fft_ground::core
