#include "pcl_fft_ground/core/align/segment_alignment.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>
#include <stdexcept>

#include "pcl_fft_ground/core/align/dense_alignment.h"
#include "stone_site.h"

namespace pcl_fft_ground::core {
namespace {

using test::poseAt;
using test::randomStones;
using test::scanStones;
using test::Stone;
using test::StoneSite;

const Eigen::Isometry3d REFERENCE = poseAt(-0.7, 0, 10);
const Eigen::Isometry3d MOVING = poseAt(0.8, 0.3, -20);
const Eigen::Isometry3d TRUTH = REFERENCE.inverse() * MOVING;

ScanSegments describe(const StoneSite& site, const Eigen::Isometry3d& pose, unsigned seed,
                      double spacing = 0.008) {
  const test::StoneScan scan = scanStones(site, pose, seed, spacing);
  return describeScan(scan.points, scan.labels);
}

/// The true transform, off by a shift [m] and a turn [degrees] amid the overlap.
Eigen::Isometry3d guessOff(double x, double y, double turn) {
  const Eigen::Translation3d amid(0.5 * TRUTH.translation());
  return Eigen::Translation3d(x, y, 0.02) * amid * poseAt(0, 0, turn) * amid.inverse() * TRUTH;
}

/// Displacement of a place amid the overlap [m].
double errorOf(const Alignment& alignment, const Eigen::Isometry3d& truth) {
  const Eigen::Vector3d amid = truth.inverse() * (0.5 * truth.translation());
  return (alignment.reference_from_moving * amid - truth * amid).norm();
}

AlignmentParameters withoutFallback() {
  AlignmentParameters parameters;
  parameters.fallback = Fallback::NONE;
  return parameters;
}

class SegmentAlignmentOfSeed : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, SegmentAlignmentOfSeed, testing::Range(1U, 5U));

TEST_P(SegmentAlignmentOfSeed, FindsTheTruthFromNavigation) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  const StoneSite site = randomStones(GetParam());
  const Alignment result = alignScans(describe(site, MOVING, 1), describe(site, REFERENCE, 2),
                                      guessOff(0.15, -0.1, 2), withoutFallback());
  EXPECT_TRUE(result.accepted) << result.refusal;
  EXPECT_EQ(result.method, AlignmentMethod::SEGMENTS);
  EXPECT_LT(errorOf(result, TRUTH), 0.002);
  EXPECT_GE(result.matches.size(), 3U);
  EXPECT_GT(result.score, 0.9);
  EXPECT_NEAR(result.overlap, 0.5, 0.1);
}

TEST_P(SegmentAlignmentOfSeed, FindsTheTruthFromFarAwayInWideSearch) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  const StoneSite site = randomStones(GetParam());
  const ScanSegments moving = describe(site, MOVING, 1), reference = describe(site, REFERENCE, 2);
  AlignmentParameters parameters = withoutFallback();
  EXPECT_FALSE(alignScans(moving, reference, guessOff(-1.4, 0.9, 15), parameters).accepted);
  parameters.gates = gatesOf(SearchMode::WIDE);
  const Alignment result = alignScans(moving, reference, guessOff(-1.4, 0.9, 15), parameters);
  EXPECT_TRUE(result.accepted) << result.refusal;
  EXPECT_LT(errorOf(result, TRUTH), 0.002);
}

TEST_P(SegmentAlignmentOfSeed, ADenseAndAThinScanAlign) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  const StoneSite site = randomStones(GetParam());
  const Alignment result =
      alignScans(describe(site, MOVING, 1), describe(site, REFERENCE, 2, 0.017), guessOff(0.1, 0.1, -2));
  EXPECT_TRUE(result.accepted) << result.refusal;
  EXPECT_LT(errorOf(result, TRUTH), 0.01);
}

TEST_P(SegmentAlignmentOfSeed, RefusesAnotherPlace) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  const ScanSegments moving = describe(randomStones(GetParam()), MOVING, 1);
  const ScanSegments reference = describe(randomStones(GetParam() + 100), REFERENCE, 2);
  const Alignment result = alignScans(moving, reference, TRUTH);
  EXPECT_FALSE(result.accepted);
  EXPECT_FALSE(result.refusal.empty());
  EXPECT_TRUE(result.reference_from_moving.isApprox(TRUTH)) << "the guess comes back";
}

TEST_P(SegmentAlignmentOfSeed, RefusesTheMirrorImage) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  const StoneSite site = randomStones(GetParam());
  StoneSite mirrored = site;
  for (Stone& stone : mirrored) {
    stone.centre.x() = -stone.centre.x();
    stone.yaw = -stone.yaw;
  }
  EXPECT_FALSE(alignScans(describe(mirrored, REFERENCE, 1), describe(site, REFERENCE, 2),
                          Eigen::Isometry3d::Identity())
                   .accepted);
}

TEST(SegmentAlignment, IdenticalScansStayWhereTheyAre) {
  const ScanSegments scan = describe(randomStones(1), REFERENCE, 1);
  const Alignment result = alignScans(scan, scan, poseAt(0.05, 0.02, 1));
  EXPECT_TRUE(result.accepted) << result.refusal;
  EXPECT_TRUE(result.reference_from_moving.isApprox(Eigen::Isometry3d::Identity(), 1e-4));
  EXPECT_GT(result.overlap, 0.99);
}

/// Stones of one shape at the places of a square lattice.
StoneSite latticeOf(const Eigen::Vector3d& semi_axes, double pitch, double yaw) {
  StoneSite lattice;
  const int count = static_cast<int>(6 / pitch);
  for (int n = 0; n < count * count; ++n)
    lattice.push_back({{pitch * (n % count) - 3, pitch * (n / count) - 3}, semi_axes, yaw});  // NOLINT
  return lattice;
}

TEST(SegmentAlignment, OfALatticeOfOneShapeIsRightOrRefused) {
  const StoneSite lattice = latticeOf({0.15, 0.1, 0.12}, 0.6, 0.3);
  const ScanSegments moving = describe(lattice, MOVING, 1), reference = describe(lattice, REFERENCE, 2);
  for (const double shift : {0.0, 0.1, 0.2, 0.3, 0.4}) {
    SCOPED_TRACE(shift);
    const Alignment result = alignScans(moving, reference, guessOff(shift, 0, 0));
    EXPECT_TRUE(!result.accepted || errorOf(result, TRUTH) < 0.05) << errorOf(result, TRUTH);
  }
}

// Navigation allows several places of the lattice, and headings at which no place fits.
TEST(SegmentAlignment, OfADenseLatticeNoneIsAccepted) {
  const StoneSite lattice = latticeOf({0.14, 0.14, 0.14}, 0.42, 0);
  const ScanSegments moving = describe(lattice, MOVING, 1, 0.03);
  const ScanSegments reference = describe(lattice, REFERENCE, 2, 0.03);
  for (const double turn : {0.0, 5.0, -12.0, 16.0}) {
    SCOPED_TRACE(turn);
    const Alignment result = alignScans(moving, reference, guessOff(0.1, 0.15, turn), withoutFallback());
    EXPECT_FALSE(result.accepted) << result.score;
  }
}

TEST(SegmentAlignment, RefusesWhatHasNoSegmentsNoPointsOrNoOverlap) {
  const ScanSegments scan = describe(randomStones(1), REFERENCE, 1);
  const ScanSegments bare = describe({}, REFERENCE, 2);
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  const ScanSegments nothing;
  EXPECT_FALSE(alignScans(nothing, scan, identity).accepted);
  EXPECT_FALSE(alignScans(scan, nothing, identity).accepted);
  EXPECT_FALSE(alignScans(nothing, nothing, identity).accepted);
  EXPECT_FALSE(alignScans(bare, scan, identity).accepted);
  EXPECT_FALSE(alignScans(scan, bare, identity).accepted);
  EXPECT_FALSE(alignScans(scan, scan, poseAt(20, 0, 0)).accepted);
  EXPECT_NE(alignScans(bare, scan, identity).refusal.find("the moving scan has no segments"),
            std::string::npos);
  EXPECT_NE(alignScans(scan, bare, identity).refusal.find("the reference has no segments"),
            std::string::npos);
}

TEST(SegmentAlignment, NeedsAsManyMatchesAsAskedFor) {
  const StoneSite site = randomStones(3);
  const ScanSegments moving = describe(site, MOVING, 1), reference = describe(site, REFERENCE, 2);
  AlignmentParameters parameters = withoutFallback();
  const std::size_t found = alignScans(moving, reference, TRUTH, parameters).matches.size();
  parameters.min_matches = found;
  EXPECT_TRUE(alignScans(moving, reference, TRUTH, parameters).accepted);
  parameters.min_matches = found + 1;
  const Alignment refused = alignScans(moving, reference, TRUTH, parameters);
  EXPECT_FALSE(refused.accepted);
  EXPECT_NE(refused.refusal.find(std::to_string(found + 1) + " are needed"), std::string::npos)
      << refused.refusal;
}

TEST(SegmentAlignment, FallsBackToDenseIcp) {
  const StoneSite site = randomStones(2);
  ScanSegments moving = describe(site, MOVING, 1), reference = describe(site, REFERENCE, 2);
  moving.segments.resize(1);
  EXPECT_FALSE(alignScans(moving, reference, guessOff(0.05, 0.05, 1), withoutFallback()).accepted);
  const Alignment result = alignScans(moving, reference, guessOff(0.05, 0.05, 1));
  EXPECT_TRUE(result.accepted) << result.refusal;
  EXPECT_EQ(result.method, AlignmentMethod::DENSE);
  EXPECT_LT(errorOf(result, TRUTH), 0.005);
}

TEST(SegmentAlignment, OfAllPointsPullsTheScansOnToEachOther) {
  const StoneSite site = randomStones(2);
  const ScanSegments moving = describe(site, MOVING, 1), reference = describe(site, REFERENCE, 2);
  const Alignment overlap = alignDensely(moving, reference, guessOff(0.05, 0.05, 1));
  const Alignment everywhere =
      alignDensely(moving, reference, guessOff(0.05, 0.05, 1), {}, DensePoints::EVERYWHERE);
  EXPECT_TRUE(overlap.accepted) << overlap.refusal;
  EXPECT_TRUE(everywhere.accepted);
  EXPECT_LT(errorOf(overlap, TRUTH), 0.005);
  EXPECT_GT(errorOf(everywhere, TRUTH), 2 * errorOf(overlap, TRUTH));
}

TEST(SegmentAlignment, InPlainWayIsRougher) {
  const StoneSite site = randomStones(1);
  AlignmentParameters plain = withoutFallback();
  plain.matching = Matching::PLAIN;
  const Alignment result =
      alignScans(describe(site, MOVING, 1), describe(site, REFERENCE, 2), guessOff(0.1, 0, 1), plain);
  EXPECT_TRUE(result.accepted) << result.refusal;
  EXPECT_LT(errorOf(result, TRUTH), 0.05);
}

TEST(SegmentAlignment, ItsCovarianceIsPositiveAndSmall) {
  const StoneSite site = randomStones(1);
  const Alignment result = alignScans(describe(site, MOVING, 1), describe(site, REFERENCE, 2), TRUTH);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(result.covariance);
  EXPECT_GT(solver.eigenvalues()[0], 0);
  EXPECT_LT(std::sqrt(solver.eigenvalues()[5]), 0.01);
}

TEST(SegmentAlignment, IsTheSameAtEveryCall) {
  const StoneSite site = randomStones(1);
  const ScanSegments moving = describe(site, MOVING, 1), reference = describe(site, REFERENCE, 2);
  const Alignment first = alignScans(moving, reference, guessOff(0.1, 0.1, 1));
  const Alignment second = alignScans(moving, reference, guessOff(0.1, 0.1, 1));
  EXPECT_EQ(first.reference_from_moving.matrix(), second.reference_from_moving.matrix());
  EXPECT_EQ(first.covariance, second.covariance);
}

TEST(SegmentAlignment, RejectsParametersOutOfRange) {
  const ScanSegments scan;
  const auto align = [&](const AlignmentParameters& parameters) {
    return alignScans(scan, scan, Eigen::Isometry3d::Identity(), parameters);
  };
  AlignmentParameters parameters;
  parameters.min_matches = 0;
  EXPECT_THROW(align(parameters), std::invalid_argument);
  parameters = {};
  parameters.min_score = 1.1;
  EXPECT_THROW(align(parameters), std::invalid_argument);
  parameters = {};
  parameters.gates.max_shift = std::numeric_limits<double>::infinity();
  EXPECT_THROW(align(parameters), std::invalid_argument);
  Eigen::Isometry3d guess = Eigen::Isometry3d::Identity();
  guess.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(alignScans(scan, scan, guess), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_fft_ground::core
