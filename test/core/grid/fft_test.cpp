// The Fourier transform of one axis is private; it is tested through grids of one or two lines. Two columns
// become one complex line along x; the bins of two rows along y are complex lines as well.
#include <gtest/gtest.h>

#include <random>

#include "pcl_fft_ground/core/ground/spectrum.h"
#include "random_points.h"
#include "slow_dft.h"

namespace pcl_fft_ground::core {
namespace {

using test::randomGrid;
using test::slowDft;

/// Largest difference to the bins by definition.
double forwardError(const Eigen::ArrayXXd& grid) {
  const Spectrum spectrum = forwardTransform(grid);
  const Eigen::ArrayXXcd expected = slowDft(grid.cast<std::complex<double>>());
  EXPECT_EQ(spectrum.rows, grid.rows());
  EXPECT_EQ(spectrum.cols(), grid.cols());
  return (spectrum.half - expected.topRows(grid.rows() / 2 + 1)).abs().maxCoeff();
}

/// Largest difference after there and back.
double roundTripError(const Eigen::ArrayXXd& grid) {
  return (inverseTransform(forwardTransform(grid)) - grid).abs().maxCoeff();
}

void expectExact(Eigen::Index rows, Eigen::Index cols, unsigned seed) {
  SCOPED_TRACE(testing::Message() << rows << " x " << cols << ", seed " << seed);
  std::mt19937 random(seed);
  const Eigen::ArrayXXd grid = randomGrid(rows, cols, random);
  EXPECT_LE(forwardError(grid), 1e-14 * static_cast<double>(grid.size()) + 1e-13);
  EXPECT_LE(roundTripError(grid), 1e-14);
}

class FftOfLength : public testing::TestWithParam<Eigen::Index> {};
INSTANTIATE_TEST_SUITE_P(UpTo70, FftOfLength, testing::Range<Eigen::Index>(1, 71));
INSTANTIATE_TEST_SUITE_P(Primes, FftOfLength, testing::Values(97, 211, 1009));
INSTANTIATE_TEST_SUITE_P(PrimeMultiples, FftOfLength, testing::Values(2 * 37, 4 * 41, 37 * 37, 31 * 31));

TEST_P(FftOfLength, AgreesWithTheDefinition) {
  const Eigen::Index length = GetParam();
  for (const Eigen::Index lines : {1, 2, 3}) {
    expectExact(length, lines, static_cast<unsigned>(length));
    expectExact(lines, length, static_cast<unsigned>(length));
  }
}

// One line that is one everywhere, and one that is one in one place: the closed forms.
TEST_P(FftOfLength, OfConstantsAndImpulses) {
  const Eigen::Index length = GetParam();
  Eigen::ArrayXXd grid = Eigen::ArrayXXd::Zero(length, 2);
  grid.col(0).setOnes();
  grid(0, 1) = 1;
  const Eigen::ArrayXXcd half = forwardTransform(grid).half;
  const auto n = static_cast<double>(length);
  for (Eigen::Index k = 0; k < half.rows(); ++k) {
    const double constant = k == 0 ? n : 0.0;
    EXPECT_LE(std::abs(half(k, 0) - (constant + 1)), 1e-14 * n);
    EXPECT_LE(std::abs(half(k, 1) - (constant - 1)), 1e-14 * n);
  }
}

TEST_P(FftOfLength, KeepsTheEnergy) {
  const Eigen::Index length = GetParam();
  std::mt19937 random(static_cast<unsigned>(length));
  for (const Eigen::ArrayXXd& grid : {randomGrid(length, 1, random), randomGrid(1, length, random)}) {
    const double energy = magnitude(forwardTransform(grid)).square().sum();
    EXPECT_NEAR(energy / static_cast<double>(length), grid.square().sum(),
                1e-13 * static_cast<double>(length));
  }
}

// A chirp transform whose angles grow with the square of the length would lose digits here.
TEST(Fft, OfALongPrimeLengthIsExact) {
  constexpr Eigen::Index LENGTH = 100003;
  std::mt19937 random(5);
  EXPECT_LE(roundTripError(randomGrid(LENGTH, 1, random)), 1e-13);

  Eigen::ArrayXXd wave(LENGTH, 1);  // one bin, of half the length
  for (Eigen::Index i = 0; i < LENGTH; ++i)
    wave(i, 0) = std::cos(2 * M_PI * static_cast<double>(i * 12345 % LENGTH) / LENGTH);
  Eigen::ArrayXXcd half = forwardTransform(wave).half / (0.5 * LENGTH);
  EXPECT_LE(std::abs(half(12345, 0) - 1.0), 1e-12);
  half(12345, 0) = 0;
  EXPECT_LE(half.abs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace pcl_fft_ground::core
