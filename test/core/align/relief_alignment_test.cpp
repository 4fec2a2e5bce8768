#include "pcl_fft_ground/core/align/relief_alignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "analytic_worlds.h"
#include "pcl_fft_ground/core/align/rigid_fit.h"
#include "pcl_fft_ground/core/align/segment_alignment.h"
#include "pcl_fft_ground/core/segments/segment.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double PI = 3.14159265358979323846;
constexpr double DEGREE = PI / 180;

/// Ground of a dozen waves in random directions, 12 to 60 points' spacings long, drawn anew for each seed.
class Seabed {
 public:
  Seabed(unsigned seed, double relief) {
    std::mt19937 random(seed);
    for (int k = 0; k < 12; ++k) {
      const double wavelength = 3 * std::pow(5, test::uniform(random, 0, 1));
      const double direction = test::uniform(random, 0, 2 * PI);
      waves_.push_back({2 * PI / wavelength * std::cos(direction), 2 * PI / wavelength * std::sin(direction),
                        0.02 * relief * wavelength, test::uniform(random, 0, 2 * PI)});
    }
  }

  double operator()(double x, double y) const {
    double z = 0;
    for (const Eigen::Vector4d& wave : waves_) z += wave[2] * std::cos(wave[0] * x + wave[1] * y + wave[3]);
    return z;
  }

 private:
  std::vector<Eigen::Vector4d> waves_;
};

Eigen::Isometry3d poseAt(double x, double y, double degrees) {
  return Eigen::Translation3d(x, y, 0) * Eigen::AngleAxisd(degrees * DEGREE, Eigen::Vector3d::UnitZ());
}

/// A scan of 15 m x 15 m, a quarter of a metre between points, 1 cm of noise, in its own frame.
template <typename Ground>
Points scan(const Ground& ground, const Eigen::Isometry3d& world_from_scan, unsigned seed) {
  std::mt19937 random(seed);
  Points points = test::randomBox(3600, {-7.5, -7.5, 0}, {7.5, 7.5, 0}, random);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Eigen::Vector3d world = world_from_scan * points.col(n).cast<double>();
    const double noise = 0.01 * (test::uniform(random, -1, 1) + test::uniform(random, -1, 1));
    points(2, n) = static_cast<float>(ground(world.x(), world.y()) + noise);
  }
  return points;
}

ReliefParameters navigation(double shift, double turn) {
  ReliefParameters parameters;
  parameters.gates.max_shift = parameters.gates.max_rise = shift;
  parameters.gates.max_turn = turn;
  return parameters;
}

const Eigen::Isometry3d REFERENCE = poseAt(0, 0, 0), MOVING = poseAt(6, 2, 20);
const Eigen::Isometry3d TRUTH = REFERENCE.inverse() * MOVING;

double errorOf(const ReliefResult& result, const Eigen::Isometry3d& truth) {
  const Eigen::Vector3d middle(-3, 0, 0);
  return (result.reference_from_moving * middle - truth * middle).norm();
}

class ReliefAlignmentTest : public testing::TestWithParam<unsigned> {
 protected:
  Seabed ground_ = Seabed(GetParam(), 1);
  Points reference_ = scan(ground_, REFERENCE, 2 * GetParam() + 100);
  Points moving_ = scan(ground_, MOVING, 2 * GetParam() + 101);
};
INSTANTIATE_TEST_SUITE_P(Seeds, ReliefAlignmentTest, testing::Values(1U, 2U, 3U));

TEST_P(ReliefAlignmentTest, FindsThePlaceFromFarAway) {
  const Eigen::Isometry3d guess = poseAt(2.5, -1.5, 4) * TRUTH;
  const ReliefResult result = alignRelief(moving_, reference_, guess, navigation(4, 6));
  ASSERT_TRUE(result.accepted) << result.refusal;
  EXPECT_LT(errorOf(result, TRUTH), 0.05);
  EXPECT_LT(Eigen::AngleAxisd(TRUTH.linear().transpose() * result.reference_from_moving.linear()).angle(),
            0.5 * DEGREE);
  EXPECT_NEAR(result.spacing, 0.25, 0.03);
  EXPECT_LT(result.deviation, 0.1);
  EXPECT_LT(result.best.residual, 1);
  EXPECT_EQ(result.best.distance, 0);
}

TEST_P(ReliefAlignmentTest, ErrorsAreAsLargeAsPredicted) {
  const ReliefResult result = alignRelief(moving_, reference_, poseAt(0.5, 0, 1) * TRUTH, navigation(2, 4));
  ASSERT_TRUE(result.accepted) << result.refusal;
  const Eigen::Isometry3d error = TRUTH * result.reference_from_moving.inverse();
  const Eigen::AngleAxisd turn(error.linear());
  Vector6d v;
  v << error.translation(), turn.angle() * turn.axis();
  EXPECT_LT(v.dot(result.covariance.ldlt().solve(v)) / 6, 4);
}

TEST_P(ReliefAlignmentTest, TheOtherWayRoundIsTheInverse) {
  const Eigen::Isometry3d guess = poseAt(0.8, 0.5, -2) * TRUTH;
  const ReliefResult there = alignRelief(moving_, reference_, guess, navigation(2, 4));
  const ReliefResult back = alignRelief(reference_, moving_, guess.inverse(), navigation(2, 4));
  ASSERT_TRUE(there.accepted && back.accepted) << there.refusal << back.refusal;
  const Eigen::Vector3d middle(-3, 0, 0);
  EXPECT_LT((back.reference_from_moving * there.reference_from_moving * middle - middle).norm(), 0.01);
}

/// Nothing is measured in metres: the same scans a thousand times as large or small give the same.
TEST_P(ReliefAlignmentTest, ScaleDoesNotMatter) {
  const Eigen::Isometry3d guess = poseAt(0.8, 0.5, -2) * TRUTH;
  const ReliefResult plain = alignRelief(moving_, reference_, guess, navigation(2, 4));
  for (const double scale : {1.0 / 1024, 1024.0}) {
    SCOPED_TRACE(scale);
    Eigen::Isometry3d scaled_guess = guess;
    scaled_guess.translation() *= scale;
    const auto factor = static_cast<float>(scale);
    const ReliefResult scaled =
        alignRelief(factor * moving_, factor * reference_, scaled_guess, navigation(2 * scale, 4));
    ASSERT_EQ(scaled.accepted, plain.accepted) << scaled.refusal;
    EXPECT_NEAR(scaled.cell_size / scale, plain.cell_size, 1e-6);
    const Eigen::Vector3d difference =
        scaled.reference_from_moving.translation() / scale - plain.reference_from_moving.translation();
    EXPECT_LT(difference.norm(), 0.005);
  }
}

TEST_P(ReliefAlignmentTest, OtherPlacesAreRefused) {
  const Points other = scan(Seabed(GetParam() + 50, 1), MOVING, 7);
  for (const double turn : {0.0, 90.0, 180.0}) {
    const ReliefResult result = alignRelief(other, reference_, poseAt(1, 1, turn), navigation(2.5, 8));
    EXPECT_FALSE(result.accepted);
    EXPECT_FALSE(result.refusal.empty());
    EXPECT_TRUE(result.reference_from_moving.isApprox(poseAt(1, 1, turn)));
  }
}

/// alignScans() asks it of bare ground; the same points a third of which are objects are no relief.
TEST(ReliefAlignment, IsAskedOfBareGroundOnly) {
  const Seabed ground(1, 1);
  const Points reference = scan(ground, REFERENCE, 11), moving = scan(ground, MOVING, 12);
  AlignmentParameters parameters;
  parameters.gates = navigation(2, 6).gates;
  parameters.fallback = Fallback::NONE;
  parameters.relief = ReliefUse::AUTO;
  const Eigen::Isometry3d guess = poseAt(1, -1, 3) * TRUTH;
  Labels labels(static_cast<std::size_t>(reference.cols()), Label::GROUND);
  const ScanSegments bare = describeScan(reference, labels);
  const Alignment of_bare_ground = alignScans(describeScan(moving, labels), bare, guess, parameters);
  EXPECT_TRUE(of_bare_ground.accepted) << of_bare_ground.refusal;
  EXPECT_EQ(of_bare_ground.method, AlignmentMethod::RELIEF);
  for (std::size_t n = 0; n < labels.size(); n += 3) labels[n] = Label::OBJECT;
  const Alignment of_objects = alignScans(describeScan(moving, labels), bare, guess, parameters);
  EXPECT_FALSE(of_objects.accepted);
  EXPECT_NE(of_objects.refusal.find("bare ground only"), std::string::npos) << of_objects.refusal;
}

TEST(ReliefAlignment, FlatGroundTellsNothing) {
  const auto flat = [](double, double) { return 0.0; };
  const ReliefResult result =
      alignRelief(scan(flat, MOVING, 1), scan(flat, REFERENCE, 2), TRUTH, navigation(2, 4));
  EXPECT_FALSE(result.accepted);
  EXPECT_FALSE(result.refusal.empty());
}

/// Along the crests of a single wave nothing holds; from crest to crest it fits again.
TEST(ReliefAlignment, RipplesAreRefused) {
  const auto wave = [](double x, double) { return 0.2 * std::cos(2 * PI * x / 4); };
  const auto lattice = [&](double x, double y) { return wave(x, y) + wave(y, x); };
  for (unsigned seed = 1; seed <= 3; ++seed) {
    EXPECT_FALSE(
        alignRelief(scan(wave, MOVING, seed), scan(wave, REFERENCE, seed + 9), TRUTH, navigation(2, 4))
            .accepted);
    const Eigen::Isometry3d guess = poseAt(1.5, 0, 0) * TRUTH;
    EXPECT_FALSE(
        alignRelief(scan(lattice, MOVING, seed), scan(lattice, REFERENCE, seed + 9), guess, navigation(6, 4))
            .accepted);
  }
}

TEST(ReliefAlignment, ScansWithoutExtentOrOverlapAreRefused) {
  const Seabed ground(1, 1);
  const Points reference = scan(ground, REFERENCE, 1);
  EXPECT_FALSE(alignRelief(Points(3, 0), reference, TRUTH).accepted);
  EXPECT_FALSE(alignRelief(Points::Ones(3, 50), reference, TRUTH).accepted);
  const ReliefResult apart = alignRelief(reference, reference, poseAt(100, 0, 0), navigation(2, 4));
  EXPECT_FALSE(apart.accepted);
  EXPECT_TRUE(apart.reference_from_moving.isApprox(poseAt(100, 0, 0)));
}

TEST(ReliefAlignment, RejectsParametersOutOfRange) {
  const Points points = Points::Ones(3, 50);
  const auto refused = [&](const auto& change) {
    ReliefParameters parameters;
    change(parameters);
    EXPECT_THROW(alignRelief(points, points, TRUTH, parameters), std::invalid_argument);
  };
  refused([](ReliefParameters& p) { p.gates.max_shift = 0; });
  refused([](ReliefParameters& p) { p.gates.max_rise = -1; });
  refused([](ReliefParameters& p) { p.gates.max_turn = 181; });
  refused([](ReliefParameters& p) { p.cell_size = 0; });
  Eigen::Isometry3d nowhere = TRUTH;
  nowhere.translation().x() = std::nan("");
  EXPECT_THROW(alignRelief(points, points, nowhere), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_fft_ground::core
