#include "pcl_fft_ground/core/scan/threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pcl_fft_ground/core/ground/ground_warnings.h"
#include "pcl_fft_ground/core/ground/low_pass_ground.h"
#include "pcl_fft_ground/core/ground/robust_ground.h"
#include "pcl_fft_ground/core/scan/prepare.h"
#include "pcl_fft_ground/simulation/simulation.h"

namespace pcl_fft_ground::core {
namespace {

class NumberOfThreads : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Numbers, NumberOfThreads, testing::Values(0U, 1U, 2U, 3U, 8U));

TEST_P(NumberOfThreads, EveryPartIsDoneOnceRoundAfterRound) {
  const Threads threads(GetParam());
  for (const Eigen::Index parts : {0, 1, 2, 7, 1000, 3}) {
    std::vector<std::atomic<int>> calls(static_cast<std::size_t>(parts));
    forEachPart(parts, [&](Eigen::Index part) { ++calls[static_cast<std::size_t>(part)]; });
    for (const std::atomic<int>& count : calls) EXPECT_EQ(count, 1);
  }
}

TEST_P(NumberOfThreads, ResultsOfRangesComeInTheirOrderAndCoverAll) {
  const Threads threads(GetParam());
  const auto ranges = resultsOfRanges(
      1001, 10, [](Eigen::Index begin, Eigen::Index end) { return std::make_pair(begin, end); });
  ASSERT_EQ(ranges.size(), 101U);
  Eigen::Index next = 0;
  for (const auto& [begin, end] : ranges) {
    EXPECT_EQ(begin, next);
    next = end;
  }
  EXPECT_EQ(next, 1001);
  EXPECT_TRUE(resultsOfRanges(0, 10, [](Eigen::Index, Eigen::Index end) { return end; }).empty());
}

TEST_P(NumberOfThreads, WhatAPartThrowsArrivesAndTheThreadsGoOn) {
  const Threads threads(GetParam());
  const auto fail = [](Eigen::Index part) {
    if (part == 5) throw std::runtime_error("part 5");
  };
  EXPECT_THROW(forEachPart(100, fail), std::runtime_error);
  std::atomic<int> calls{0};
  forEachPart(100, [&](Eigen::Index) { ++calls; });
  EXPECT_EQ(calls, 100);
}

TEST_P(NumberOfThreads, WorkWithinWorkIsDoneByTheThreadThatHasIt) {
  const Threads threads(GetParam());
  std::atomic<int> calls{0};
  forEachPart(10, [&](Eigen::Index) {
    const Threads one(1);
    forEachPart(10, [&](Eigen::Index) { ++calls; });
  });
  EXPECT_EQ(calls, 100);
}

/// Prepared, fitted and labelled: so many points that each of these steps has several parts.
struct Results {
  PreparedScan scan;
  RobustGround ground;
  RobustLabels labels;
  std::vector<std::string> warnings;
  LowPassGround low_pass;
  Labels low_pass_labels;
};

Results resultsOn(const Points& points) {
  Results run;
  FrameParameters frame;
  frame.up_estimation = UpEstimation::AUTO;
  run.scan = prepare(points, frame);
  RobustParameters parameters;
  parameters.max_object_size = 1;
  run.ground = estimateRobustGround(run.scan.usable.points, run.scan.frame_from_input, parameters);
  run.labels = labelRobust(run.scan.usable.points, run.ground);
  run.warnings = warningsAbout(run.ground, run.scan.usable.points, run.labels.labels, parameters);
  run.low_pass = estimateLowPassGround(run.scan.usable.points, run.scan.frame_from_input, {});
  run.low_pass_labels = labelByHeight(run.scan.usable.points, run.low_pass.surface, 0);
  return run;
}

TEST_P(NumberOfThreads, GroundAndLabelsAreTheSameBitForBit) {
  SimulationParameters parameters;
  parameters.seed = 7;
  parameters.points = 150000;
  parameters.tilt_degrees = 5;
  const Points points = simulateScan(parameters).points;
  static const Results alone = resultsOn(points);
  const Threads threads(GetParam());
  const Results run = resultsOn(points);
  EXPECT_EQ(run.scan.usable.points, alone.scan.usable.points);
  EXPECT_TRUE((run.ground.surface.height == alone.ground.surface.height).all());
  EXPECT_TRUE((run.ground.lowest == alone.ground.lowest).all());
  EXPECT_EQ(run.ground.scale, alone.ground.scale);
  EXPECT_EQ(run.labels.labels, alone.labels.labels);
  EXPECT_EQ(run.labels.below, alone.labels.below);
  EXPECT_EQ(run.warnings, alone.warnings);
  EXPECT_TRUE((run.low_pass.surface.height == alone.low_pass.surface.height).all());
  EXPECT_EQ(run.low_pass_labels, alone.low_pass_labels);
}

}  // namespace
}  // namespace pcl_fft_ground::core
