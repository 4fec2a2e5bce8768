#include "grid/dct.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

using test::randomGrid;
using Size = std::pair<Eigen::Index, Eigen::Index>;

/// Orthonormal cosine transform of every column, by its definition.
Eigen::ArrayXXd slowDctOfColumns(const Eigen::ArrayXXd& grid) {
  const Eigen::Index n = grid.rows();
  Eigen::ArrayXXd out = Eigen::ArrayXXd::Zero(n, grid.cols());
  for (Eigen::Index k = 0; k < n; ++k) {
    const double scale = std::sqrt((k == 0 ? 1.0 : 2.0) / static_cast<double>(n));
    for (Eigen::Index i = 0; i < n; ++i)
      out.row(k) += scale * grid.row(i) *
                    std::cos(M_PI * static_cast<double>((2 * i + 1) * k) / (2.0 * static_cast<double>(n)));
  }
  return out;
}

Eigen::ArrayXXd slowDct(const Eigen::ArrayXXd& grid) {
  const Eigen::ArrayXXd columns = slowDctOfColumns(grid);
  return slowDctOfColumns(columns.transpose()).transpose();
}

class DctOfSize : public testing::TestWithParam<Size> {
 protected:
  const Eigen::Index rows_ = GetParam().first, cols_ = GetParam().second;
  std::mt19937 random_{static_cast<unsigned>(1000 * rows_ + cols_)};
  Dct2d<double> transform_{rows_, cols_};
};
INSTANTIATE_TEST_SUITE_P(Sizes, DctOfSize,
                         testing::Values(Size(1, 1), Size(1, 2), Size(2, 1), Size(2, 2), Size(1, 9),
                                         Size(16, 16), Size(15, 15), Size(16, 15), Size(24, 7), Size(37, 41),
                                         Size(20, 97), Size(160, 9), Size(12, 176)));

TEST_P(DctOfSize, AgreesWithTheDefinition) {
  const Eigen::ArrayXXd grid = randomGrid(rows_, cols_, random_);
  Eigen::ArrayXXd coefficients = grid;
  transform_.forward(coefficients);
  EXPECT_LE((coefficients - slowDct(grid)).abs().maxCoeff(), 1e-12);
}

TEST_P(DctOfSize, GivesTheGridBackAndKeepsItsEnergy) {
  const Eigen::ArrayXXd grid = randomGrid(rows_, cols_, random_);
  Eigen::ArrayXXd work = grid;
  transform_.forward(work);
  EXPECT_NEAR(work.square().sum(), grid.square().sum(), 1e-12 * static_cast<double>(grid.size()));
  transform_.inverse(work);
  EXPECT_LE((work - grid).abs().maxCoeff(), 1e-13);
}

TEST_P(DctOfSize, IsAsPreciseAsFloatInFloat) {
  const Eigen::ArrayXXd grid = randomGrid(rows_, cols_, random_);
  Eigen::ArrayXXf coefficients = grid.cast<float>();
  Dct2d<float> transform(rows_, cols_);
  transform.forward(coefficients);
  EXPECT_LE((coefficients.cast<double>() - slowDct(grid)).abs().maxCoeff(), 1e-5);
  transform.inverse(coefficients);
  EXPECT_LE((coefficients.cast<double>() - grid).abs().maxCoeff(), 2e-6);
}

TEST(Dct, HalfWaveIsOneCoefficient) {
  constexpr Eigen::Index N = 30, K = 7;
  Eigen::ArrayXXd grid(N, 2);
  for (Eigen::Index i = 0; i < N; ++i)
    grid.row(i) = std::cos(M_PI * (2.0 * static_cast<double>(i) + 1) * K / (2.0 * N));
  Dct2d<double>(N, 2).forward(grid);
  EXPECT_NEAR(grid(K, 0), std::sqrt(static_cast<double>(N)), 1e-12);
  grid(K, 0) = 0;
  EXPECT_LE(grid.abs().maxCoeff(), 1e-12);
}

TEST(Dct, KeepsItsPrecisionInLongLines) {
  std::mt19937 random(2);
  const Eigen::ArrayXXd grid = randomGrid(4096, 2, random);
  Dct2d<double> transform(4096, 2);
  Eigen::ArrayXXd work = grid;
  transform.forward(work);
  transform.inverse(work);
  EXPECT_LE((work - grid).abs().maxCoeff(), 1e-13);
}

TEST(FastDctLength, IsTheNextWithASmallOddFactor) {
  for (const Eigen::Index length : {1, 2, 15, 16, 17, 31, 33, 129, 1000, 4097}) {
    SCOPED_TRACE(length);
    Eigen::Index odd = fastDctLength(length);
    EXPECT_GE(odd, length);
    EXPECT_LE(8 * odd, 9 * length + 8);
    while (odd % 2 == 0) odd /= 2;
    EXPECT_LE(odd, 15);
  }
}

}  // namespace
}  // namespace pcl_fft_ground::core
