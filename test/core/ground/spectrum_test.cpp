#include "pcl_fft_ground/core/ground/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "random_points.h"
#include "slow_dft.h"

namespace pcl_fft_ground::core {
namespace {

using test::randomGrid;
using Size = std::pair<Eigen::Index, Eigen::Index>;

class SpectrumOfSize : public testing::TestWithParam<Size> {
 protected:
  const Eigen::Index rows_ = GetParam().first, cols_ = GetParam().second;
  std::mt19937 random_{static_cast<unsigned>(1000 * rows_ + cols_)};
  const double tolerance_ = 1e-14 * static_cast<double>(rows_ * cols_) + 1e-14;
};
INSTANTIATE_TEST_SUITE_P(Sizes, SpectrumOfSize,
                         testing::Values(Size(1, 1), Size(1, 2), Size(2, 1), Size(2, 2), Size(1, 9),
                                         Size(16, 16), Size(15, 15), Size(16, 15), Size(15, 16), Size(24, 7),
                                         Size(7, 24), Size(37, 41), Size(74, 19), Size(20, 97)));

TEST_P(SpectrumOfSize, AgreesWithTheDefinition) {
  const Eigen::ArrayXXd grid = randomGrid(rows_, cols_, random_);
  const Eigen::ArrayXXcd expected = test::slowDft(grid.cast<std::complex<double>>());
  const Spectrum spectrum = forwardTransform(grid);
  ASSERT_EQ(spectrum.rows, rows_);
  ASSERT_EQ(spectrum.half.rows(), rows_ / 2 + 1);
  ASSERT_EQ(spectrum.cols(), cols_);
  EXPECT_LE((spectrum.half - expected.topRows(rows_ / 2 + 1)).abs().maxCoeff(), tolerance_);
  EXPECT_LE((magnitude(spectrum) - expected.abs()).abs().maxCoeff(), tolerance_);
}

TEST_P(SpectrumOfSize, GivesTheGridBack) {
  const Eigen::ArrayXXd grid = randomGrid(rows_, cols_, random_);
  EXPECT_LE((inverseTransform(forwardTransform(grid)) - grid).abs().maxCoeff(), 1e-14);
}

TEST_P(SpectrumOfSize, IsLinear) {
  const Eigen::ArrayXXd a = randomGrid(rows_, cols_, random_), b = randomGrid(rows_, cols_, random_);
  const Eigen::ArrayXXcd sum = forwardTransform(3 * a - 0.5 * b).half;
  const Eigen::ArrayXXcd expected = 3 * forwardTransform(a).half - 0.5 * forwardTransform(b).half;
  EXPECT_LE((sum - expected).abs().maxCoeff(), 4 * tolerance_);
}

TEST_P(SpectrumOfSize, KeepsTheEnergy) {
  const Eigen::ArrayXXd grid = randomGrid(rows_, cols_, random_);
  const double energy = magnitude(forwardTransform(grid)).square().sum() / static_cast<double>(grid.size());
  EXPECT_NEAR(energy, grid.square().sum(), tolerance_);
}

TEST_P(SpectrumOfSize, AShiftOfTheGridTurnsThePhases) {
  const Eigen::ArrayXXd grid = randomGrid(rows_, cols_, random_);
  Eigen::ArrayXXd shifted(rows_, cols_);
  constexpr Eigen::Index DOWN = 3, RIGHT = 5;
  for (Eigen::Index j = 0; j < cols_; ++j)
    for (Eigen::Index i = 0; i < rows_; ++i) shifted((i + DOWN) % rows_, (j + RIGHT) % cols_) = grid(i, j);
  Eigen::ArrayXXcd expected = forwardTransform(grid).half;
  for (Eigen::Index l = 0; l < cols_; ++l)
    for (Eigen::Index k = 0; k < expected.rows(); ++k) {
      const double turns = static_cast<double>(DOWN * k) / static_cast<double>(rows_) +
                           static_cast<double>(RIGHT * l) / static_cast<double>(cols_);
      expected(k, l) *= std::polar(1.0, -2 * M_PI * turns);
    }
  EXPECT_LE((forwardTransform(shifted).half - expected).abs().maxCoeff(), 4 * tolerance_);
}

TEST_P(SpectrumOfSize, MagnitudesOfConjugateBinsAreEqual) {
  const Eigen::ArrayXXd m = magnitude(forwardTransform(randomGrid(rows_, cols_, random_)));
  for (Eigen::Index l = 0; l < cols_; ++l)
    for (Eigen::Index k = 0; k < rows_; ++k) ASSERT_EQ(m(k, l), m((rows_ - k) % rows_, (cols_ - l) % cols_));
}

TEST_P(SpectrumOfSize, RadiusIsThatOfTheSignedFrequency) {
  for (Eigen::Index l = 0; l < cols_; ++l)
    for (Eigen::Index k = 0; k < rows_; ++k)
      ASSERT_DOUBLE_EQ(binRadius(k, l, rows_, cols_),
                       std::hypot(test::nyquistRatio(k, rows_), test::nyquistRatio(l, cols_)));
}

TEST(Spectrum, OfAGridWithoutCells) {
  const Spectrum spectrum = forwardTransform(Eigen::ArrayXXd(0, 0));
  EXPECT_EQ(spectrum.rows, 0);
  EXPECT_EQ(spectrum.cols(), 0);
  EXPECT_EQ(inverseTransform(spectrum).size(), 0);
  EXPECT_EQ(magnitude(spectrum).size(), 0);
}

TEST(BinRadius, OfKnownBins) {
  EXPECT_EQ(binRadius(0, 0, 8, 6), 0);
  EXPECT_EQ(binRadius(4, 0, 8, 6), 1);
  EXPECT_EQ(binRadius(0, 3, 8, 6), 1);
  EXPECT_DOUBLE_EQ(binRadius(4, 3, 8, 6), M_SQRT2);
  EXPECT_DOUBLE_EQ(binRadius(7, 0, 8, 6), 0.25);
  EXPECT_DOUBLE_EQ(binRadius(3, 0, 10, 10), 0.6);
  EXPECT_DOUBLE_EQ(binRadius(3, 4, 10, 10), 1.0);
}

TEST(SmoothLength, IsTheNextProductOfTwoThreeAndFive) {
  constexpr Eigen::Index MOST = 5000;
  std::vector<bool> is_product(2 * MOST, false);
  for (Eigen::Index a = 1; a < 2 * MOST; a *= 2)
    for (Eigen::Index b = a; b < 2 * MOST; b *= 3)
      for (Eigen::Index c = b; c < 2 * MOST; c *= 5) is_product[static_cast<std::size_t>(c)] = true;
  for (Eigen::Index length = 1; length <= MOST; ++length) {
    Eigen::Index expected = length;
    while (!is_product[static_cast<std::size_t>(expected)]) ++expected;
    ASSERT_EQ(smoothLength(length), expected);
  }
}

}  // namespace
}  // namespace pcl_fft_ground::core
