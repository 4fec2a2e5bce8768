#include "pcl_fft_ground/core/survey/survey_tables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace pcl_fft_ground::core {
namespace {

/// An aligned pair of 1000 voxels before.
PairResult aligned(const std::string& method, std::size_t voxels_after, double error = 0.001) {
  PairResult result;
  result.method = method;
  result.status = PairStatus::ALIGNED;
  result.overlap = 0.4;
  result.nx_before = 1000;
  result.nx_after = voxels_after;
  result.translation_error = error;
  result.rotation_error = 10 * error;
  return result;
}

PairResult notAligned(const std::string& method, PairStatus status, double overlap = 0.4) {
  PairResult result = aligned(method, 1000, 0.3);
  result.status = status;
  result.overlap = overlap;
  return result;
}

TEST(SurveyTables, CountsPairsAsThePaperDoes) {
  std::vector<PairResult> results = {aligned("a", 800),
                                     aligned("a", 1250),
                                     aligned("a", 500),
                                     notAligned("a", PairStatus::REFUSED),
                                     notAligned("a", PairStatus::UNPROCESSED),
                                     notAligned("b", PairStatus::REFUSED)};
  results.push_back(aligned("a", 10));
  results.back().kind = PairKind::OTHER;
  const std::vector<CrispnessRow> rows = crispnessTable(results);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].method, "a");
  // Changes over the voxels after: -25, +20 and -100 %.
  EXPECT_NEAR(*rows[0].mean, -35.0, 1e-9);
  EXPECT_NEAR(*rows[0].deviation, 60.6218, 1e-3);
  EXPECT_EQ(rows[0].rose, 1u);
  EXPECT_EQ(rows[0].fell, 2u);
  EXPECT_EQ(rows[0].not_computed, 1u);
  EXPECT_EQ(rows[0].unprocessed, 1u);
  EXPECT_FALSE(rows[1].mean);
  EXPECT_EQ(rows[1].not_computed, 1u);
}

TEST(SurveyTables, AccuracyIsThatOfAlignedPairs) {
  const std::vector<PairResult> results = {aligned("a", 900, 0.001),
                                           aligned("a", 900, 0.002),
                                           aligned("a", 900, 0.003),
                                           aligned("a", 900, 0.2),
                                           notAligned("a", PairStatus::REFUSED),
                                           notAligned("a", PairStatus::REFUSED, 0.05)};
  const AccuracyRow row = accuracyTable(results).front();
  EXPECT_EQ(row.overlapping, 5u);
  EXPECT_EQ(row.aligned, 4u);
  EXPECT_EQ(row.wrong, 1u);
  EXPECT_DOUBLE_EQ(*row.median_translation, 0.002);
  EXPECT_DOUBLE_EQ(*row.high_translation, 0.2);
  EXPECT_DOUBLE_EQ(*row.median_rotation, 0.02);
  EXPECT_NEAR(row.aligned_bound, lowerBound(4, 5), 1e-12);
}

TEST(SurveyTables, AFalseAlignmentWithoutOverlapCountsAsWrong) {
  PairResult false_one = aligned("a", 900, 4.0);
  false_one.overlap = 0;
  const AccuracyRow row = accuracyTable({false_one}).front();
  EXPECT_EQ(row.overlapping, 0u);
  EXPECT_EQ(row.wrong, 1u);
}

TEST(SurveyTables, AMethodThatCannotRunSaysWhy) {
  std::vector<PairResult> results = {aligned("a", 900), notAligned("a", PairStatus::NOT_RUN)};
  results.back().refusal = "not run: too many cells";
  const CrispnessRow row = crispnessTable(results).front();
  EXPECT_EQ(row.not_run, "not run: too many cells");
  EXPECT_EQ(row.unprocessed, 1u);
  EXPECT_EQ(row.not_computed, 0u);
  EXPECT_EQ(accuracyTable(results).front().aligned, 1u);
}

TEST(SurveyTables, LowerBoundSolvesWilsonsEquation) {
  constexpr double Z = 1.2815515655446004;
  for (const auto& [successes, trials] : {std::pair(84, 88), std::pair(1, 10), std::pair(40, 40)}) {
    const double n = trials, share = successes / n;
    const double bound = lowerBound(static_cast<std::size_t>(successes), static_cast<std::size_t>(trials));
    EXPECT_NEAR((share - bound) / std::sqrt(bound * (1 - bound) / n), Z, 1e-6);
  }
  EXPECT_EQ(lowerBound(0, 7), 0.0);
  EXPECT_EQ(lowerBound(0, 0), 0.0);
}

TEST(SurveyTables, QuantilesAreValuesOfTheSample) {
  EXPECT_FALSE(quantileOf({}, 0.5));
  EXPECT_EQ(*quantileOf({3}, 0.9), 3);
  EXPECT_EQ(*quantileOf({5, 1, 4, 2, 3}, 0.5), 3);
  EXPECT_EQ(*quantileOf({10, 9, 8, 7, 6, 5, 4, 3, 2, 1}, 0.9), 9);
  EXPECT_EQ(*quantileOf({2, 1}, 0), 1);
}

}  // namespace
}  // namespace pcl_fft_ground::core
