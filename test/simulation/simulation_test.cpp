#include "pcl_fft_ground/simulation/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace pcl_fft_ground::core {

// Names failing cases by scene and share.
static void PrintTo(const SimulationParameters& p, std::ostream* stream) {
  *stream << "scene " << static_cast<int>(p.scene) << ", seed " << p.seed << ", share " << p.object_share;
}

namespace {

SimulationParameters small(SceneKind scene, std::uint32_t seed = 1, double share = 0.5) {
  SimulationParameters parameters;
  parameters.scene = scene;
  parameters.seed = seed;
  parameters.points = 20000;
  parameters.object_share = share;
  return parameters;
}

std::size_t count(const SimulatedScan& scan, std::int32_t label) {
  return static_cast<std::size_t>(std::count(scan.labels.begin(), scan.labels.end(), label));
}

double objectShare(const SimulatedScan& scan) {
  const auto objects = static_cast<double>(count(scan, 1));
  return objects / (objects + static_cast<double>(count(scan, 0)));
}

double heightAboveGround(const SimulatedScan& scan, std::size_t i) {
  return static_cast<double>(scan.points(2, static_cast<Eigen::Index>(i))) - scan.ground_heights[i];
}

Eigen::Vector3d pointOf(const SimulatedScan& scan, std::size_t i) {
  return scan.points.col(static_cast<Eigen::Index>(i)).cast<double>();
}

/// Cosine of the angle between a point's ray and the vertical.
double rayCosine(const SimulationParameters& parameters, const Eigen::Vector3d& point) {
  const double below = parameters.altitude - point.z();
  return below / std::hypot(below, point.y());
}

class EveryScene : public testing::TestWithParam<SceneKind> {};
INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene,
                         testing::Values(SceneKind::WRECK, SceneKind::PIPES, SceneKind::REEF));

TEST_P(EveryScene, EqualSeedsGiveEqualScans) {
  const SimulatedScan first = simulateScan(small(GetParam()));
  const SimulatedScan second = simulateScan(small(GetParam()));
  EXPECT_EQ(first.points, second.points);
  EXPECT_EQ(first.labels, second.labels);
  EXPECT_EQ(first.segments, second.segments);
  EXPECT_EQ(first.ground_heights, second.ground_heights);
  EXPECT_NE(first.points, simulateScan(small(GetParam(), 2)).points);
}

TEST_P(EveryScene, HasExactlyThePointsAskedFor) {
  for (const std::size_t points : {std::size_t{1}, std::size_t{777}, std::size_t{20001}}) {
    SimulationParameters parameters = small(GetParam());
    parameters.points = points;
    const SimulatedScan scan = simulateScan(parameters);
    EXPECT_EQ(static_cast<std::size_t>(scan.points.cols()), points);
    EXPECT_EQ(scan.labels.size(), points);
    EXPECT_EQ(scan.segments.size(), points);
    EXPECT_EQ(scan.ground_heights.size(), points);
  }
}

TEST_P(EveryScene, FillsItsFootprint) {
  SimulationParameters parameters = small(GetParam());
  parameters.noise = 0.0;
  const SimulatedScan scan = simulateScan(parameters);
  const Eigen::Vector2f size =
      GetParam() == SceneKind::PIPES ? Eigen::Vector2f(6, 1.5) : Eigen::Vector2f(4, 4);
  const Eigen::Vector3f low = scan.points.rowwise().minCoeff();
  const Eigen::Vector3f high = scan.points.rowwise().maxCoeff();
  EXPECT_TRUE(low.head<2>().isApprox(-0.5F * size, 0.02F)) << low.transpose();
  EXPECT_TRUE(high.head<2>().isApprox(0.5F * size, 0.02F)) << high.transpose();
  EXPECT_TRUE((scan.points.topRows<2>().cwiseAbs().colwise() - 0.5F * size).maxCoeff() <= 1e-6F);
}

TEST_P(EveryScene, LabelsAgreeWithHeightsAboveTheTrueGround) {
  const SimulationParameters parameters = small(GetParam());
  const SimulatedScan scan = simulateScan(parameters);
  const double sigma = parameters.noise;
  for (std::size_t i = 0; i < scan.labels.size(); ++i) {
    const double height = heightAboveGround(scan, i);
    SCOPED_TRACE(i);
    switch (scan.labels[i]) {
      case 0:
        ASSERT_LT(std::abs(height), 6.0 * sigma);
        break;
      case 1:
        ASSERT_GT(height, (4.0 - 6.0) * sigma);
        break;
      default:
        ASSERT_LT(height, (4.0 + 6.0) * sigma);
        break;
    }
    ASSERT_EQ(scan.segments[i] > 0, scan.labels[i] != 0);
  }
}

TEST_P(EveryScene, WithoutNoiseGroundPointsLieOnTheGroundAndObjectsAboveIt) {
  SimulationParameters parameters = small(GetParam());
  parameters.noise = 0.0;
  const SimulatedScan scan = simulateScan(parameters);
  EXPECT_EQ(count(scan, 2), 0U);
  for (std::size_t i = 0; i < scan.labels.size(); ++i) {
    const double height = heightAboveGround(scan, i);
    if (scan.labels[i] == 0) {
      ASSERT_NEAR(height, 0.0, 1e-5);
    } else {
      ASSERT_GE(height, -1e-6);
    }
  }
}

TEST_P(EveryScene, NoiseHasTheDeviationAskedFor) {
  SimulationParameters parameters = small(GetParam());
  parameters.noise = 0.005;
  const SimulatedScan scan = simulateScan(parameters);
  double squares = 0.0;
  for (std::size_t i = 0; i < scan.labels.size(); ++i) {
    if (scan.labels[i] != 0) continue;
    const double along_ray = heightAboveGround(scan, i) / rayCosine(parameters, pointOf(scan, i));
    squares += along_ray * along_ray;
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(count(scan, 0))), parameters.noise,
              0.05 * parameters.noise);
}

TEST_P(EveryScene, ObjectsAreOfTheSizesPromised) {
  const SimulatedScan scan = simulateScan(small(GetParam()));
  const double longest = GetParam() == SceneKind::PIPES ? 2.1 : 1.1;
  std::map<std::int32_t, Eigen::AlignedBox3d> boxes;
  for (std::size_t i = 0; i < scan.labels.size(); ++i) {
    if (scan.segments[i] > 0) boxes[scan.segments[i]].extend(pointOf(scan, i));
  }
  EXPECT_GT(boxes.size(), 10U);
  for (const auto& [segment, box] : boxes) EXPECT_LT(box.sizes().maxCoeff(), longest) << "object " << segment;
}

TEST_P(EveryScene, ComesProfileAfterProfile) {
  SimulationParameters parameters = small(GetParam());
  parameters.noise = 0.0;
  const SimulatedScan scan = simulateScan(parameters);
  for (std::size_t i = 1; i < scan.labels.size(); ++i) {
    const Eigen::Vector3d before = pointOf(scan, i - 1);
    const Eigen::Vector3d after = pointOf(scan, i);
    // Where the rays meet z = 0. Coordinates are floats: points of one profile agree to their rounding.
    const double ray_before = before.y() * parameters.altitude / (parameters.altitude - before.z());
    const double ray_after = after.y() * parameters.altitude / (parameters.altitude - after.z());
    const bool same_profile = std::abs(after.x() - before.x()) < 1e-6;
    ASSERT_TRUE(same_profile ? ray_after > ray_before - 1e-5 : after.x() > before.x()) << i;
  }
}

TEST_P(EveryScene, TheSceneDoesNotDependOnTheNumberOfPoints) {
  SimulationParameters parameters = small(GetParam());
  const SimulatedScan thin = simulateScan(parameters);
  parameters.points = 40000;
  const SimulatedScan dense = simulateScan(parameters);
  EXPECT_NEAR(objectShare(thin), objectShare(dense), 0.015);
  const auto few = std::max_element(thin.segments.begin(), thin.segments.end());
  const auto many = std::max_element(dense.segments.begin(), dense.segments.end());
  EXPECT_NEAR(*few, *many, 3);
}

class ObjectShare : public testing::TestWithParam<SimulationParameters> {};
INSTANTIATE_TEST_SUITE_P(Shares, ObjectShare,
                         testing::Values(small(SceneKind::WRECK, 1, 0.05), small(SceneKind::WRECK, 2, 0.4),
                                         small(SceneKind::WRECK, 3, 0.75), small(SceneKind::WRECK, 4, 0.8),
                                         small(SceneKind::PIPES, 5, 0.05), small(SceneKind::PIPES, 6, 0.4),
                                         small(SceneKind::PIPES, 7, 0.75), small(SceneKind::PIPES, 8, 0.8),
                                         small(SceneKind::REEF, 9, 0.05), small(SceneKind::REEF, 10, 0.4),
                                         small(SceneKind::REEF, 11, 0.75), small(SceneKind::REEF, 12, 0.8)));

TEST_P(ObjectShare, IsReachedToWithinFivePercentagePoints) {
  EXPECT_NEAR(objectShare(simulateScan(GetParam())), GetParam().object_share, 0.05);
}

TEST(Simulation, NoObjectsWhereNoneAreAskedFor) {
  const SimulatedScan scan = simulateScan(small(SceneKind::WRECK, 1, 0.0));
  EXPECT_EQ(count(scan, 0), scan.labels.size());
}

TEST(Simulation, ReefGroundHasTheReliefPromised) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const SimulatedScan scan = simulateScan(small(SceneKind::REEF, seed, 0.0));
    const auto [low, high] = std::minmax_element(scan.ground_heights.begin(), scan.ground_heights.end());
    EXPECT_GT(*high - *low, 0.09F);
    EXPECT_LT(*high - *low, 0.34F);  // the roughness adds to the 0.3 m of the waves
  }
}

/// The lowest surface seen in each cell, and whether a line of sight passes beneath it.
class LowestSurface {
 public:
  explicit LowestSurface(const SimulatedScan& scan) {
    for (std::size_t i = 0; i < scan.labels.size(); ++i) {
      const Eigen::Vector3d p = pointOf(scan, i);
      const auto [entry, is_new] = lowest_.try_emplace(cellOf(p), p.z());
      if (!is_new) entry->second = std::min(entry->second, p.z());
    }
    highest_ = static_cast<double>(scan.points.row(2).maxCoeff());
  }

  /// True where the line runs beneath everything seen in a cell and its eight neighbours.
  bool hides(const Eigen::Vector3d& point, const Eigen::Vector3d& eye) const {
    const Eigen::Vector3d step = (eye - point).normalized() * 0.01;
    for (Eigen::Vector3d at = point; at.z() < highest_; at += step) {
      if (lowestAround(at) > at.z() + kClearly) return true;
    }
    return false;
  }

 private:
  static constexpr double kCell = 0.03;
  static constexpr double kClearly = 0.02;

  static std::pair<int, int> cellOf(const Eigen::Vector3d& p) {
    return {static_cast<int>(std::floor(p.x() / kCell)), static_cast<int>(std::floor(p.y() / kCell))};
  }
  double lowestAround(const Eigen::Vector3d& at) const {
    const auto [column, row] = cellOf(at);
    double lowest = std::numeric_limits<double>::infinity();
    for (int i = column - 1; i <= column + 1; ++i) {
      for (int j = row - 1; j <= row + 1; ++j) {
        const auto found = lowest_.find({i, j});
        if (found == lowest_.end()) return -std::numeric_limits<double>::infinity();
        lowest = std::min(lowest, found->second);
      }
    }
    return lowest;
  }

  std::map<std::pair<int, int>, double> lowest_;
  double highest_;
};

/// Of points spread over the scan, those hidden from an eye that stands \c ahead of each point's laser [m].
double hiddenShare(const SimulatedScan& scan, const SimulationParameters& parameters, double ahead) {
  const LowestSurface surface(scan);
  double hidden = 0.0;
  double tested = 0.0;
  for (std::size_t i = 0; i < scan.labels.size(); i += 7) {
    if (scan.labels[i] != 0) continue;
    const Eigen::Vector3d point = pointOf(scan, i);
    const Eigen::Vector3d eye(point.x() + ahead, 0.0, parameters.altitude);
    hidden += surface.hides(point, eye) ? 1.0 : 0.0;
    tested += 1.0;
  }
  return hidden / tested;
}

TEST(Simulation, NoGroundIsSeenThroughBouldersByLaserOrCamera) {
  SimulationParameters parameters = small(SceneKind::REEF, 3, 0.4);
  parameters.points = 60000;
  parameters.noise = 0.0;
  parameters.baseline = 2.0;
  const SimulatedScan scan = simulateScan(parameters);
  EXPECT_LT(hiddenShare(scan, parameters, 0.0), 0.001);
  EXPECT_LT(hiddenShare(scan, parameters, -parameters.baseline), 0.001);
  // The check can fail: from the other side of the laser much of the ground is hidden.
  EXPECT_GT(hiddenShare(scan, parameters, parameters.baseline), 0.01);
}

TEST(Simulation, GapsLeaveTheirShareOfTheFootprintEmpty) {
  SimulationParameters parameters = small(SceneKind::PIPES, 1, 0.0);
  parameters.points = 60000;
  parameters.noise = 0.0;
  parameters.gap_share = 0.3;
  const SimulatedScan scan = simulateScan(parameters);
  constexpr double kCell = 0.025;
  std::set<std::pair<int, int>> covered;
  for (std::size_t i = 0; i < scan.labels.size(); ++i) {
    const Eigen::Vector3d p = pointOf(scan, i);
    covered.emplace(static_cast<int>((p.x() + 3.0) / kCell), static_cast<int>((p.y() + 0.75) / kCell));
  }
  EXPECT_NEAR(1.0 - static_cast<double>(covered.size()) * kCell * kCell / 9.0, 0.3, 0.02);
}

TEST(Simulation, OutliersAreAsManyAndAsFarAsAskedFor) {
  SimulationParameters parameters = small(SceneKind::WRECK);
  parameters.outlier_share = 0.02;
  const SimulatedScan scan = simulateScan(parameters);
  std::size_t outliers = 0;
  double farthest = 0.0;
  for (std::size_t i = 0; i < scan.labels.size(); ++i) {
    if (scan.labels[i] != 2 || scan.segments[i] != 0) continue;
    ++outliers;
    farthest = std::max(farthest, std::abs(heightAboveGround(scan, i)));
  }
  EXPECT_EQ(outliers, 400U);
  EXPECT_GT(farthest, 8.0);
  EXPECT_LT(farthest, 11.0);
}

TEST(Simulation, TiltTurnsTheScanAndItsPoseUndoesIt) {
  SimulationParameters parameters = small(SceneKind::WRECK);
  const SimulatedScan level = simulateScan(parameters);
  EXPECT_TRUE(level.world_from_scan.isApprox(Eigen::Isometry3d::Identity()));
  parameters.tilt_degrees = 20.0;
  const SimulatedScan tilted = simulateScan(parameters);
  const double turn = Eigen::AngleAxisd(tilted.world_from_scan.linear()).angle();
  EXPECT_NEAR(turn, 20.0 * std::acos(-1.0) / 180.0, 1e-12);
  EXPECT_EQ(level.labels, tilted.labels);
  for (std::size_t i = 0; i < level.labels.size(); ++i) {
    ASSERT_LT((tilted.world_from_scan * pointOf(tilted, i) - pointOf(level, i)).norm(), 1e-5);
    Eigen::Vector3d ground = pointOf(tilted, i);
    ground.z() = static_cast<double>(tilted.ground_heights[i]);
    if (tilted.labels[i] == 0) {
      ASSERT_LT((ground - pointOf(tilted, i)).norm(), 10.0 * parameters.noise);
    }
  }
}

struct Invalid {
  const char* name;
  const char* value;
  std::function<void(SimulationParameters&)> set;
};

void PrintTo(const Invalid& invalid, std::ostream* stream) {
  *stream << invalid.name << " = " << invalid.value;
}

class InvalidParameter : public testing::TestWithParam<Invalid> {};

TEST_P(InvalidParameter, IsRefusedByNameAndValue) {
  SimulationParameters parameters = small(SceneKind::WRECK);
  GetParam().set(parameters);
  try {
    simulateScan(parameters);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    const std::string expected = std::string(GetParam().name) + " = " + GetParam().value + ": allowed is ";
    EXPECT_EQ(std::string(error.what()).substr(0, expected.size()), expected);
  }
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
using P = SimulationParameters;
INSTANTIATE_TEST_SUITE_P(Parameters, InvalidParameter,
                         testing::Values(Invalid{"scene", "9",
                                                 [](P& p) { p.scene = static_cast<SceneKind>(9); }},
                                         Invalid{"points", "0", [](P& p) { p.points = 0; }},
                                         Invalid{"object_share", "0.9", [](P& p) { p.object_share = 0.9; }},
                                         Invalid{"object_share", "nan", [](P& p) { p.object_share = kNan; }},
                                         Invalid{"noise", "-0.001", [](P& p) { p.noise = -0.001; }},
                                         Invalid{"noise", "1", [](P& p) { p.noise = 1.0; }},
                                         Invalid{"gap_share", "0.95", [](P& p) { p.gap_share = 0.95; }},
                                         Invalid{"outlier_share", "-1", [](P& p) { p.outlier_share = -1.0; }},
                                         Invalid{"tilt_degrees", "60", [](P& p) { p.tilt_degrees = 60.0; }},
                                         Invalid{"altitude", "1", [](P& p) { p.altitude = 1.0; }},
                                         Invalid{"baseline", "nan", [](P& p) { p.baseline = kNan; }}));

TEST(SimulatedObjects, HoldThePointsOfTheirSegments) {
  SimulationParameters parameters;
  parameters.scene = SceneKind::PIPES;
  parameters.object_share = 0.3;
  parameters.points = 20000;
  parameters.tilt_degrees = 20;
  const SimulatedScan scan = simulateScan(parameters);
  const std::vector<SimulatedObject> objects = simulatedObjects(parameters);
  ASSERT_FALSE(objects.empty());
  for (std::size_t n = 0; n < objects.size(); ++n) {
    const SimulatedObject& object = objects[n];
    SCOPED_TRACE(testing::Message() << "object " << n);
    EXPECT_EQ(object.segment, static_cast<std::int32_t>(n) + 1);
    EXPECT_NEAR(object.axis.norm(), 1, 1e-9);
    EXPECT_GE(object.share_seen, 0);
    EXPECT_LE(object.share_seen, 1);
    EXPECT_GT(object.volume, 0);
    EXPECT_LT(object.volume, 3.1416 * object.radius * object.radius * object.length);
  }
  for (std::size_t n = 0; n < scan.segments.size(); ++n) {
    if (scan.segments[n] == 0) continue;
    const SimulatedObject& object = objects.at(static_cast<std::size_t>(scan.segments[n] - 1));
    const Eigen::Vector3d offset =
        scan.points.col(static_cast<Eigen::Index>(n)).cast<double>() - object.centre;
    EXPECT_LE(std::abs(offset.dot(object.axis)), 0.5 * object.length + 6 * parameters.noise);
    EXPECT_LE(offset.cross(object.axis).norm(), object.radius + 6 * parameters.noise);
  }
}

}  // namespace
}  // namespace pcl_fft_ground::core
