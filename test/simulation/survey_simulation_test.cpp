#include "pcl_fft_ground/simulation/survey_simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace pcl_fft_ground::core {
namespace {

constexpr double DEGREE = EIGEN_PI / 180;

/// A survey that is made fast: few points and objects.
SurveyParameters small(SceneKind site, std::uint32_t seed = 1) {
  SurveyParameters parameters;
  parameters.site = site;
  parameters.seed = seed;
  parameters.points = 4000;
  parameters.object_share = 0.03;
  return parameters;
}

/// Error of navigation in the world's axes.
Eigen::Isometry3d errorOf(const SimulatedSubmap& submap) {
  return submap.world_from_navigation * submap.scan.world_from_scan.inverse();
}

double yawOf(const Eigen::Isometry3d& pose) {
  return std::atan2(pose.linear()(1, 0), pose.linear()(0, 0));
}

/// Area that two rectangles of this size share, each with its own pose, by counting points of a lattice
/// [m^2].
double sharedArea(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const Eigen::Vector2d& size) {
  constexpr double STEP = 0.05;
  int count = 0;
  for (double x = -0.5 * size.x(); x < 0.5 * size.x(); x += STEP)
    for (double y = -0.5 * size.y(); y < 0.5 * size.y(); y += STEP) {
      const Eigen::Vector3d in_b = b.inverse() * a * Eigen::Vector3d(x, y, 0);
      if ((2 * in_b.head<2>().cwiseAbs() - size).maxCoeff() <= 0) ++count;
    }
  return count * STEP * STEP;
}

class EverySite : public testing::TestWithParam<SceneKind> {
 protected:
  Eigen::Vector2d footprint() const {
    return GetParam() == SceneKind::PIPES ? Eigen::Vector2d(6, 1.5) : Eigen::Vector2d(4, 4);
  }
};
INSTANTIATE_TEST_SUITE_P(Sites, EverySite, testing::Values(SceneKind::WRECK, SceneKind::PIPES));

TEST_P(EverySite, EqualSeedsGiveEqualSubmapsInAnyOrder) {
  const SurveySimulation first(small(GetParam())), second(small(GetParam()));
  ASSERT_EQ(first.size(), second.size());
  const SimulatedSubmap late = second.submap(9);
  for (const std::size_t i : {std::size_t{0}, std::size_t{9}}) {
    const SimulatedSubmap a = first.submap(i), b = i == 9 ? late : second.submap(i);
    EXPECT_EQ(a.scan.points, b.scan.points);
    EXPECT_EQ(a.scan.labels, b.scan.labels);
    EXPECT_EQ(a.scan.segments, b.scan.segments);
    EXPECT_TRUE(a.world_from_navigation.isApprox(b.world_from_navigation, 0));
  }
  EXPECT_NE(first.submap(0).scan.points, first.submap(1).scan.points);
  EXPECT_NE(first.submap(0).scan.points, SurveySimulation(small(GetParam(), 2)).submap(0).scan.points);
}

TEST_P(EverySite, SubmapsHaveTheirFootprintAndPoints) {
  SurveyParameters parameters = small(GetParam());
  parameters.noise = 0;
  const SurveySimulation survey(parameters);
  const SimulatedScan scan = survey.submap(3).scan;
  EXPECT_EQ(scan.points.cols(), 4000);
  EXPECT_EQ(scan.labels.size(), 4000u);
  const Eigen::Vector3f size = scan.points.rowwise().maxCoeff() - scan.points.rowwise().minCoeff();
  EXPECT_NEAR(size.x(), footprint().x(), 0.2);
  EXPECT_NEAR(size.y(), footprint().y(), 0.2);
}

TEST_P(EverySite, NeighboursOverlapByThirtyToSixtyPercent) {
  SurveyParameters parameters = small(GetParam());
  parameters.points = 1;
  const SurveySimulation survey(parameters);
  const double area = footprint().prod();
  std::size_t neighbours = 0;
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < survey.size(); ++i) poses.push_back(survey.submap(i).scan.world_from_scan);
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    const bool same_transect =
        std::abs(std::remainder(yawOf(poses[i]) - yawOf(poses[i + 1]), 2 * EIGEN_PI)) < 0.1;
    if (!same_transect) continue;
    ++neighbours;
    const double share = sharedArea(poses[i], poses[i + 1], footprint()) / area;
    EXPECT_GT(share, 0.3) << i;
    EXPECT_LT(share, 0.6) << i;
  }
  EXPECT_GE(neighbours, 18u);
}

TEST_P(EverySite, NavigationIsWrongByCentimetresAndDegrees) {
  SurveyParameters parameters = small(GetParam());
  parameters.points = 1;
  const SurveySimulation survey(parameters);
  double largest = 0;
  for (std::size_t i = 0; i < survey.size(); ++i) {
    const SimulatedSubmap submap = survey.submap(i);
    const Eigen::Vector3d shift =
        submap.world_from_navigation.translation() - submap.scan.world_from_scan.translation();
    const double turn = std::abs(yawOf(errorOf(submap))) / DEGREE;
    EXPECT_GE(shift.head<2>().norm(), 0.02 - 1e-9);
    EXPECT_LE(shift.head<2>().norm(), 0.2 + 1e-9);
    EXPECT_LT(std::abs(shift.z()), 0.1);
    EXPECT_GT(turn, 0.4);
    EXPECT_LT(turn, 3.1);
    EXPECT_LT(std::acos(std::min(1.0, errorOf(submap).linear()(2, 2))) / DEGREE, 1.2);
    largest = std::max(largest, shift.head<2>().norm());
  }
  EXPECT_GT(largest, 0.12);
}

TEST_P(EverySite, TruePosesLayTheSubmapsOnOneSite) {
  SurveyParameters parameters = small(GetParam());
  parameters.points = 20000;
  parameters.noise = 0;
  const SurveySimulation survey(parameters);
  const SimulatedSubmap a = survey.submap(0), b = survey.submap(1);
  const auto heightGap = [&](const Eigen::Isometry3d& pose_a, const Eigen::Isometry3d& pose_b) {
    // Mean height difference of ground points within 2 cm of each other, seen from above.
    double sum = 0, count = 0;
    for (Eigen::Index n = 0; n < a.scan.points.cols(); n += 40) {
      const Eigen::Vector3d p = pose_b.inverse() * pose_a * a.scan.points.col(n).cast<double>();
      if (a.scan.labels[static_cast<std::size_t>(n)] != 0 ||
          (2 * p.head<2>().cwiseAbs() - footprint()).maxCoeff() > 0)
        continue;
      Eigen::Index nearest = 0;
      const float distance = (b.scan.points.topRows<2>().colwise() - p.head<2>().cast<float>())
                                 .colwise()
                                 .norm()
                                 .minCoeff(&nearest);
      if (distance > 0.02F || b.scan.labels[static_cast<std::size_t>(nearest)] != 0) continue;
      sum += std::abs(p.z() - static_cast<double>(b.scan.points(2, nearest)));
      ++count;
    }
    EXPECT_GT(count, 20);
    return sum / count;
  };
  const double by_truth = heightGap(a.scan.world_from_scan, b.scan.world_from_scan);
  EXPECT_LT(by_truth, 0.003);
  EXPECT_GT(heightGap(a.world_from_navigation, b.world_from_navigation), 2 * by_truth);
}

TEST_P(EverySite, DriftShearsASubmapByItsSizeAndNothingElse) {
  SurveyParameters parameters = small(GetParam());
  const SimulatedScan straight = SurveySimulation(parameters).submap(2).scan;
  parameters.drift = 0.01;
  const SimulatedScan sheared = SurveySimulation(parameters).submap(2).scan;
  const Eigen::Matrix3Xf moved = sheared.points - straight.points;
  EXPECT_TRUE(sheared.world_from_scan.isApprox(straight.world_from_scan, 0));
  EXPECT_NEAR(moved.colwise().norm().maxCoeff(), 0.005, 2e-4);
  const Eigen::Vector3f mean = moved.rowwise().mean();
  EXPECT_LT(mean.norm(), 5e-4);
  Eigen::Index first = 0, last = 0;
  straight.points.row(0).minCoeff(&first);
  straight.points.row(0).maxCoeff(&last);
  EXPECT_NEAR((moved.col(last) - moved.col(first)).norm(), 0.01, 5e-4);
}

/// The sea floor under a sub-map, without noise, by the true pose.
double groundUnder(const SimulatedScan& scan, Eigen::Index n) {
  const Eigen::Vector3d place(static_cast<double>(scan.points(0, n)), static_cast<double>(scan.points(1, n)),
                              static_cast<double>(scan.ground_heights[static_cast<std::size_t>(n)]));
  return (scan.world_from_scan * place).z();
}

class BareSurvey : public testing::TestWithParam<std::uint32_t> {
 protected:
  static SurveySimulation survey(std::size_t points) {
    SurveyParameters parameters = surveyParametersFor(SceneKind::BARE);
    EXPECT_EQ(parameters.points, 6400u);
    parameters.seed = GetParam();
    parameters.points = points;
    return SurveySimulation(parameters);
  }
};
INSTANTIATE_TEST_SUITE_P(Seeds, BareSurvey, testing::Values(1U, 2U, 3U));

TEST_P(BareSurvey, HasAMetreOfReliefAndNoObjects) {
  const SurveySimulation bare = survey(400);
  ASSERT_EQ(bare.size(), 21u);
  double sum = 0, squares = 0, count = 0;
  for (std::size_t i = 0; i < bare.size(); i += 2) {
    const SimulatedScan scan = bare.submap(i).scan;
    ASSERT_EQ(scan.points.cols(), 400);
    EXPECT_EQ(std::count(scan.labels.begin(), scan.labels.end(), 0), 400);
    for (Eigen::Index n = 0; n < scan.points.cols(); ++n) {
      const double height = groundUnder(scan, n);
      sum += height;
      squares += height * height;
      ++count;
    }
  }
  const double deviation = std::sqrt(squares / count - std::pow(sum / count, 2));
  EXPECT_GT(deviation, 0.15);  // four of them are a metre, or so it is over a much larger site
  EXPECT_LT(deviation, 0.35);
}

TEST_P(BareSurvey, NeighboursOverlapByThirtyToSixtyPercent) {
  const SurveySimulation bare = survey(1);
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < bare.size(); ++i) poses.push_back(bare.submap(i).scan.world_from_scan);
  std::size_t neighbours = 0;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    if (std::abs(std::remainder(yawOf(poses[i]) - yawOf(poses[i + 1]), 2 * EIGEN_PI)) > 0.1) continue;
    ++neighbours;
    const double share = sharedArea(poses[i], poses[i + 1], {20, 20}) / 400;
    EXPECT_GT(share, 0.3) << i;
    EXPECT_LT(share, 0.6) << i;
  }
  EXPECT_GE(neighbours, 14u);
}

TEST_P(BareSurvey, NavigationIsWrongByAMetre) {
  const SurveySimulation bare = survey(1);
  double largest = 0;
  for (std::size_t i = 0; i < bare.size(); ++i) {
    const SimulatedSubmap submap = bare.submap(i);
    const Eigen::Vector3d shift =
        submap.world_from_navigation.translation() - submap.scan.world_from_scan.translation();
    EXPECT_LE(shift.head<2>().norm(), 1 + 1e-9);
    EXPECT_LT(std::abs(yawOf(errorOf(submap))) / DEGREE, 2.1);
    largest = std::max(largest, shift.head<2>().norm());
  }
  EXPECT_GT(largest, 0.6);
}

TEST(SurveySimulation, RefusesParametersOutOfRange) {
  const auto refused = [](const auto& change) {
    SurveyParameters parameters;
    change(parameters);
    EXPECT_THROW(SurveySimulation survey(parameters), std::invalid_argument);
  };
  refused([](auto& p) { p.site = SceneKind::REEF; });
  refused([](auto& p) { p.points = 0; });
  refused([](auto& p) { p.object_share = 0.9; });
  refused([](auto& p) { p.site = SceneKind::BARE; });
  refused([](auto& p) { p.noise = -1; });
  refused([](auto& p) { p.navigation_error = std::numeric_limits<double>::quiet_NaN(); });
  refused([](auto& p) { p.heading_error = 90; });
  refused([](auto& p) { p.drift = 2; });
  refused([](auto& p) { p.altitude = 1; });
  refused([](auto& p) { p.baseline = 3; });
}

TEST(SurveySimulation, RefusesSubmapsThatAreNotThere) {
  SurveyParameters parameters = small(SceneKind::PIPES);
  parameters.points = 1;
  const SurveySimulation survey(parameters);
  EXPECT_EQ(survey.size(), 26u);
  EXPECT_THROW(survey.submap(26), std::out_of_range);
}

}  // namespace
}  // namespace pcl_fft_ground::core
