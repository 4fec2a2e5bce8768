#include "pcl_fft_ground/core/align/dense_alignment.h"

#include <gtest/gtest.h>

#include "house_site.h"

namespace pcl_fft_ground::core {
namespace {

const Eigen::Vector2d WEST(-1, 0), EAST(1, 0);

ScanSegments describe(const test::FlightLine& line) {
  return describeScan(line.points, line.labels);
}

Eigen::Isometry3d guessOff(double x, double y, double degrees) {
  return Eigen::Translation3d(x, y, 0.05) *
         Eigen::AngleAxisd(degrees * EIGEN_PI / 180, Eigen::Vector3d::UnitZ());
}

AlignmentParameters withinMetres() {
  AlignmentParameters parameters;
  parameters.gates = gatesOf(SearchMode::WIDE);
  return parameters;
}

/// Where two flight lines that lie on each other in truth are put, from some guesses.
class FlightLines : public testing::TestWithParam<Eigen::Isometry3d> {
 protected:
  const ScanSegments from_west_ = describe(test::flyOver(test::nineHouses(), WEST, 1));
  const ScanSegments from_east_ = describe(test::flyOver(test::nineHouses(), EAST, 2));
};
INSTANTIATE_TEST_SUITE_P(Guesses, FlightLines,
                         testing::Values(guessOff(0, 0, 0), guessOff(0.8, -0.5, 2), guessOff(-0.4, 0.9, -3)));

// The walls of either side stand 8 m apart; those that only one line has seen must not pull.
TEST_P(FlightLines, OfOppositeSidesOfHousesComeToLieOnEachOther) {
  for (const bool west_moves : {true, false}) {
    const ScanSegments& moving = west_moves ? from_west_ : from_east_;
    const ScanSegments& reference = west_moves ? from_east_ : from_west_;
    const Alignment result = alignScans(moving, reference, GetParam(), withinMetres());
    ASSERT_TRUE(result.accepted) << result.refusal;
    EXPECT_LT(result.reference_from_moving.translation().norm(), 0.03);
    EXPECT_LT(Eigen::AngleAxisd(result.reference_from_moving.linear()).angle(), 0.001);
  }
}

TEST_P(FlightLines, AreOffByNoMoreThanTheCovarianceSays) {
  const Alignment result = alignDensely(from_west_, from_east_, GetParam(), withinMetres());
  ASSERT_TRUE(result.accepted) << result.refusal;
  EXPECT_EQ(result.method, AlignmentMethod::DENSE);
  for (Eigen::Index k = 0; k < 3; ++k)
    EXPECT_LT(std::abs(result.reference_from_moving.translation()[k]),
              3 * std::sqrt(result.covariance(k, k)));
}

TEST_F(FlightLines, AreRefusedWhereMorePrecisionIsAskedForThanTheyHave) {
  AlignmentParameters parameters = withinMetres();
  parameters.max_sigma = 0.0005;
  const Alignment result = alignScans(from_west_, from_east_, guessOff(0.3, 0, 0), parameters);
  EXPECT_FALSE(result.accepted);
  EXPECT_NE(result.refusal.find("allowed are 0.0005 m"), std::string::npos) << result.refusal;
}

TEST(DenseAlignment, OfRollingGroundIsRightOrRefused) {
  const ScanSegments bare = describe(test::flyOver({}, WEST, 1));
  const ScanSegments again = describe(test::flyOver({}, WEST, 2));
  for (const double off : {0.1, 0.3, 1.0}) {
    const Alignment result = alignDensely(bare, again, guessOff(off, 0, 0), withinMetres());
    EXPECT_TRUE(!result.accepted || result.reference_from_moving.translation().norm() < 0.1) << off;
  }
}

/// A level plain; the noise differs from scan to scan.
ScanSegments plain(unsigned seed) {
  test::FlightLine line = test::flyOver({}, WEST, seed);
  for (Eigen::Index n = 0; n < line.points.cols(); ++n)
    line.points(2, n) -=
        0.3F * std::sin(0.1F * line.points(0, n)) + 0.2F * std::cos(0.13F * line.points(1, n));
  return describe(line);
}

TEST(DenseAlignment, OfAPlainIsRefused) {
  const ScanSegments moving = plain(1), reference = plain(2);
  for (const double off : {0.0, 0.3, 1.0}) {
    const Alignment result = alignDensely(moving, reference, guessOff(off, 0, 0), withinMetres());
    EXPECT_FALSE(result.accepted) << off;
  }
}

}  // namespace
}  // namespace pcl_fft_ground::core
