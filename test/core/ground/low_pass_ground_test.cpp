#include "pcl_fft_ground/core/ground/low_pass_ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "analytic_worlds.h"
#include "random_points.h"
#include "slow_dft.h"

namespace pcl_fft_ground::core {
namespace {

using test::nyquistRatio;
using test::onePointPerCell;
using test::Wave;

constexpr double CELL = 0.0625;  // a power of two: see onePointPerCell()

LowPassParameters exactGrid() {
  LowPassParameters parameters;
  parameters.cell_size = CELL;
  parameters.grid_lengths = GridLengths::EXACT;
  return parameters;
}

LowPassGround groundOf(const Points& points, const LowPassParameters& parameters) {
  return estimateLowPassGround(points, Eigen::Isometry3d::Identity(), parameters);
}

/// Eq. (1) at a bin of a grid.
double response(Eigen::Index k, Eigen::Index l, Eigen::Index rows, Eigen::Index cols,
                const Butterworth& filter) {
  const double x = nyquistRatio(k, rows) / filter.cutoff, y = nyquistRatio(l, cols) / filter.cutoff;
  const double squared_edge = std::pow(10, filter.passband_ripple / 10) - 1;
  return 1 / std::sqrt(1 + squared_edge * std::pow(x * x + y * y, filter.order));
}

/// Transform, filter and inverse transform by their definitions.
Eigen::ArrayXXd slowLowPass(const Eigen::ArrayXXd& grid, const Butterworth& filter) {
  Eigen::ArrayXXcd bins = test::slowDft(grid.cast<std::complex<double>>());
  for (Eigen::Index l = 0; l < grid.cols(); ++l)
    for (Eigen::Index k = 0; k < grid.rows(); ++k)
      bins(k, l) *= response(k, l, grid.rows(), grid.cols(), filter);
  return test::slowInverseDft(bins).real();
}

using Size = std::pair<Eigen::Index, Eigen::Index>;
class LowPassOfSize : public testing::TestWithParam<Size> {
 protected:
  const Eigen::Index rows_ = GetParam().first, cols_ = GetParam().second;
  std::mt19937 random_{static_cast<unsigned>(1000 * rows_ + cols_)};
};
INSTANTIATE_TEST_SUITE_P(Sizes, LowPassOfSize,
                         testing::Values(Size(1, 1), Size(1, 16), Size(17, 1), Size(2, 2), Size(16, 16),
                                         Size(15, 15), Size(16, 15), Size(32, 9), Size(13, 17), Size(31, 37),
                                         Size(41, 20)));

// An analytic world: each wave comes back with its amplitude times the filter's response, its phase
// unchanged.
TEST_P(LowPassOfSize, WavesComeBackAsTheResponseSays) {
  constexpr double LEVEL = -7.5;
  const std::vector<Wave> waves = {{std::min<Eigen::Index>(1, rows_ / 2), 0, 0.8, 0.3},
                                   {0, std::min<Eigen::Index>(2, cols_ / 2), 0.5, -1},
                                   {std::min<Eigen::Index>(3, rows_ / 2), cols_ / 4, 0.3, 2},
                                   {rows_ / 3, cols_ / 2, 0.2, 0},
                                   {rows_ / 2, 0, 0.1, 0}};
  const auto height = [&](Eigen::Index i, Eigen::Index j) {
    double sum = LEVEL;
    for (const Wave& wave : waves) sum += wave.at(i, j, rows_, cols_);
    return sum;
  };
  for (const Butterworth& filter : {Butterworth{0.2, 2, 3}, Butterworth{0.6, 4, 1}, Butterworth{1.4, 1, 6}}) {
    SCOPED_TRACE(testing::Message() << rows_ << " x " << cols_ << ", cut-off " << filter.cutoff);
    LowPassParameters parameters = exactGrid();
    parameters.cutoff_frequency = filter.cutoff;
    parameters.filter_order = filter.order;
    parameters.passband_ripple = filter.passband_ripple;
    const LowPassGround ground = groundOf(onePointPerCell(rows_, cols_, CELL, height), parameters);
    ASSERT_EQ(ground.surface.height.rows(), rows_);
    ASSERT_EQ(ground.surface.height.cols(), cols_);
    for (Eigen::Index j = 0; j < cols_; ++j)
      for (Eigen::Index i = 0; i < rows_; ++i) {
        double expected = LEVEL;
        for (const Wave& wave : waves)
          expected += response(wave.k, wave.l, rows_, cols_, filter) * wave.at(i, j, rows_, cols_);
        // The heights of the points are floats: 2^-22 m near 8 m.
        ASSERT_NEAR(ground.surface.height(i, j), expected, 1e-6) << "cell " << i << ", " << j;
      }
  }
}

TEST_P(LowPassOfSize, AnyGridAgreesWithTheDefinition) {
  SCOPED_TRACE(testing::Message() << rows_ << " x " << cols_);
  const Points points =
      onePointPerCell(rows_, cols_, CELL, [&](auto, auto) { return test::uniform(random_, -1, 1); });
  LowPassParameters parameters = exactGrid();
  parameters.max_object_size = 0.5;
  const LowPassGround ground = groundOf(points, parameters);
  EXPECT_EQ(ground.filter.cutoff, ground.cutoff.frequency);
  EXPECT_EQ(ground.filter.order, 2U);
  EXPECT_EQ(ground.filter.passband_ripple, 3.0);
  const Eigen::ArrayXXd elevation = points.row(2).cast<double>().reshaped(rows_, cols_);
  EXPECT_TRUE((ground.elevation.elevation == elevation).all());
  const Eigen::ArrayXXd expected = slowLowPass(elevation, ground.filter);
  EXPECT_LE((ground.surface.height - expected).abs().maxCoeff(), 1e-12);
}

TEST_P(LowPassOfSize, TheFilteredSpectrumIsThatOfTheSurface) {
  SCOPED_TRACE(testing::Message() << rows_ << " x " << cols_);
  const Points points =
      onePointPerCell(rows_, cols_, CELL, [&](auto, auto) { return test::uniform(random_, -1, 1); });
  const LowPassGround ground = groundOf(points, exactGrid());
  const Eigen::ArrayXXcd of_surface = forwardTransform(ground.surface.height).half;
  EXPECT_LE((ground.filteredSpectrum().half - of_surface).abs().maxCoeff(), 1e-11);
  EXPECT_LE((ground.spectrum.half - forwardTransform(ground.elevation.elevation).half).abs().maxCoeff(),
            1e-11);
}

TEST_P(LowPassOfSize, LengthenedGridsAreCutBack) {
  SCOPED_TRACE(testing::Message() << rows_ << " x " << cols_);
  const Points all =
      onePointPerCell(rows_, cols_, CELL, [&](auto, auto) { return test::uniform(random_, -1, 1); });
  LowPassParameters parameters = exactGrid();
  parameters.grid_lengths = GridLengths::SMOOTH;
  parameters.cutoff_frequency = 0.3;
  const LowPassGround ground = groundOf(all, parameters);
  const Eigen::Index rows = smoothLength(rows_), cols = smoothLength(cols_);
  EXPECT_EQ(ground.spectrum.rows, rows);
  EXPECT_EQ(ground.spectrum.cols(), cols);
  // Every cell is observed, so that the nearest one to a new cell is that at the border.
  Eigen::ArrayXXd lengthened(rows, cols);
  for (Eigen::Index j = 0; j < cols; ++j)
    for (Eigen::Index i = 0; i < rows; ++i)
      lengthened(i, j) = ground.elevation.elevation(std::min(i, rows_ - 1), std::min(j, cols_ - 1));
  const Eigen::ArrayXXd expected = slowLowPass(lengthened, ground.filter).topLeftCorner(rows_, cols_);
  ASSERT_EQ(ground.surface.height.rows(), rows_);
  ASSERT_EQ(ground.surface.height.cols(), cols_);
  EXPECT_LE((ground.surface.height - expected).abs().maxCoeff(), 1e-12);
}

TEST_P(LowPassOfSize, LevelGroundStaysAsItIs) {
  SCOPED_TRACE(testing::Message() << rows_ << " x " << cols_);
  const LowPassGround ground =
      groundOf(onePointPerCell(rows_, cols_, CELL, [](auto, auto) { return 3.25; }), exactGrid());
  EXPECT_LE((ground.surface.height - 3.25).abs().maxCoeff(), 1e-14);
}

/// Waves of 4 cells along x (radius 0.5) and of 2 cells along y (radius 1), 12 x 14 cells.
Points twoWaves() {
  return onePointPerCell(12, 14, CELL, [](Eigen::Index i, Eigen::Index j) {
    const double along_x = i % 4 == 0 ? 1 : i % 4 == 2 ? -1 : 0;
    return along_x + (j % 2 == 0 ? 0.5 : -0.5);
  });
}

LowPassGround groundOfTwoWaves(double max_object_size) {
  LowPassParameters parameters = exactGrid();
  parameters.max_object_size = max_object_size;
  return groundOf(twoWaves(), parameters);
}

TEST(LowPassGround, FindsThePeaksOfItsWaves) {
  const LowPassGround ground = groundOfTwoWaves(1);
  ASSERT_EQ(ground.peaks.size(), 3U);
  const std::vector<Size> bins = {{3, 0}, {9, 0}, {0, 7}};
  for (std::size_t n = 0; n < bins.size(); ++n)
    EXPECT_EQ(Size(ground.peaks[n].k, ground.peaks[n].l), bins[n]) << n;
  EXPECT_NEAR(ground.peaks[0].magnitude, 12 * 14 / 2.0, 1e-10);
  EXPECT_NEAR(ground.peaks[2].magnitude, 12 * 14 * 0.5, 1e-10);
}

TEST(LowPassGround, TheCutoffFollowsFromTheLargestObject) {
  // Sizes in cells; m_c of the waves are 4 and 2 cells.
  const std::vector<std::tuple<double, double, bool>> cases = {
      {10, 0.5, true}, {4, 0.5, true}, {3.9, 1, true}, {2, 1, true}, {1.6, 1.25, false}, {1, M_SQRT2, false}};
  for (const auto& [cells, cutoff, by_peak] : cases) {
    SCOPED_TRACE(testing::Message() << "largest object: " << cells << " cells");
    const LowPassGround ground = groundOfTwoWaves(cells * CELL);
    EXPECT_EQ(ground.max_object_size, cells * CELL);
    EXPECT_DOUBLE_EQ(ground.cutoff.frequency, cutoff);
    EXPECT_DOUBLE_EQ(ground.cutoff.object_size, 2 * CELL / cutoff);
    EXPECT_EQ(ground.cutoff.peak.has_value(), by_peak);
    EXPECT_EQ(ground.cutoff.source, by_peak ? CutoffSource::PEAK : CutoffSource::FALLBACK);
  }
}

TEST(LowPassGround, TheLargestObjectIsAShareOfTheSmallerExtent) {
  LowPassParameters parameters = exactGrid();
  const LowPassGround half = groundOf(twoWaves(), parameters);
  EXPECT_EQ(half.extent, 11 * CELL);
  EXPECT_EQ(half.max_object_size, 0.5 * 11 * CELL);
  parameters.relative_max_object_size = 0.125;
  EXPECT_EQ(groundOf(twoWaves(), parameters).max_object_size, 0.125 * 11 * CELL);
  parameters.max_object_size = 40.0;  // takes the place of the share, however large
  EXPECT_EQ(groundOf(twoWaves(), parameters).max_object_size, 40.0);
}

TEST(LowPassGround, AGivenCutoffIsUsedAsItIs) {
  LowPassParameters parameters = exactGrid();
  parameters.cutoff_frequency = 0.3;
  const LowPassGround ground = groundOf(twoWaves(), parameters);
  EXPECT_EQ(ground.cutoff.frequency, 0.3);
  EXPECT_EQ(ground.filter.cutoff, 0.3);
  EXPECT_DOUBLE_EQ(ground.cutoff.object_size, 2 * CELL / 0.3);
  EXPECT_FALSE(ground.cutoff.peak.has_value());
  EXPECT_EQ(ground.cutoff.source, CutoffSource::GIVEN);
  EXPECT_EQ(ground.peaks.size(), 3U);
}

TEST(LowPassGround, PeaksObeyTheirSettings) {
  LowPassParameters parameters = exactGrid();
  parameters.peaks.threshold = 84.5;  // above both waves' 84 m
  EXPECT_TRUE(groundOf(twoWaves(), parameters).peaks.empty());
  parameters.peaks.threshold = 83.5;
  EXPECT_EQ(groundOf(twoWaves(), parameters).peaks.size(), 3U);
  parameters.peaks.half_window = 7;  // now each window holds the other wave, equally high up to rounding
  EXPECT_TRUE(groundOf(twoWaves(), parameters).peaks.empty());
}

TEST(LowPassGround, OfNoPointsIsEmpty) {
  const LowPassGround ground = groundOf(Points(3, 0), {});
  EXPECT_EQ(ground.surface.height.size(), 0);
  EXPECT_EQ(ground.elevation.elevation.size(), 0);
  EXPECT_TRUE(ground.peaks.empty());
}

TEST(LowPassGround, OfTooManyCellsIsRefused) {
  Points points = Points::Zero(3, 2);
  points.col(1) << 1000, 1000, 0;
  LowPassParameters parameters;
  parameters.cell_size = 0.01;
  EXPECT_THROW(groundOf(points, parameters), std::length_error);
}

TEST(LowPassGround, KeepsTheFrame) {
  const Eigen::Isometry3d frame(Eigen::Translation3d(1, 2, 3) *
                                Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  const LowPassGround ground = estimateLowPassGround(twoWaves(), frame, exactGrid());
  EXPECT_EQ(ground.surface.frame_from_input.matrix(), frame.matrix());
}

class LowPassOfSeed : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, LowPassOfSeed, testing::Range(1U, 5U));

// Long swells pass, so that scattered points lie on the surface but for the highest of a cell being taken.
TEST_P(LowPassOfSeed, FollowsALongSwell) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  constexpr double SIDE = 4, HEIGHT = 0.05, CELL_SIZE = 0.04;
  const auto swell = [&](double x, double y) {
    return HEIGHT * (std::cos(2 * M_PI * x / SIDE) + std::sin(2 * M_PI * y / SIDE));
  };
  LowPassParameters parameters;
  parameters.cell_size = CELL_SIZE;
  parameters.cutoff_frequency = 0.15;  // a wavelength of 0.53 m
  const LowPassGround ground = groundOf(test::scatteredOn(60000, SIDE, SIDE, swell, random), parameters);
  constexpr double STEEPEST = 2 * M_PI * HEIGHT / SIDE;
  constexpr double WITHIN_A_CELL = 2 * STEEPEST * CELL_SIZE;
  for (double x = 0.2; x < SIDE - 0.2; x += 0.1)
    for (double y = 0.2; y < SIDE - 0.2; y += 0.1)
      ASSERT_NEAR(ground.surface.heightAt(x, y), swell(x, y), WITHIN_A_CELL) << x << ", " << y;
}

TEST_P(LowPassOfSeed, DoesNotDependOnTheOrderOfThePoints) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(GetParam());
  const Points points = test::randomBox(4000, {0, 0, 0}, {4, 3, 1}, random);
  const LowPassGround a = groundOf(points, exactGrid());
  const LowPassGround b = groundOf(test::shuffled(points, random), exactGrid());
  EXPECT_TRUE((a.surface.height == b.surface.height).all());
  EXPECT_EQ(a.cutoff.frequency, b.cutoff.frequency);
}

}  // namespace
}  // namespace pcl_fft_ground::core
