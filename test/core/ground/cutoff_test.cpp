#include "pcl_fft_ground/core/ground/cutoff.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>
#include <utility>

#include "pcl_fft_ground/core/ground/spectrum.h"
#include "random_points.h"
#include "slow_dft.h"

namespace pcl_fft_ground::core {
namespace {

using test::nyquistRatio;
using Bins = std::vector<std::pair<Eigen::Index, Eigen::Index>>;

Bins binsOf(const std::vector<SpectrumPeak>& peaks) {
  Bins bins;
  for (const SpectrumPeak& peak : peaks) bins.emplace_back(peak.k, peak.l);
  return bins;
}

/// Eq. (3) word by word, over the whole plane.
Bins slowPeaks(const Eigen::ArrayXXd& magnitude, Eigen::Index half_window, double threshold) {
  const Eigen::Index rows = magnitude.rows(), cols = magnitude.cols();
  const auto isDc = [](Eigen::Index k, Eigen::Index l) { return k == 0 && l == 0; };
  double largest = 0;
  for (Eigen::Index l = 0; l < cols; ++l)
    for (Eigen::Index k = 0; k < rows; ++k)
      if (!isDc(k, l)) largest = std::max(largest, magnitude(k, l));
  const auto m = [&](Eigen::Index k, Eigen::Index l) {
    return magnitude(k, l) < 1e-9 * largest ? 0 : magnitude(k, l);
  };
  const auto exceedsItsWindow = [&](Eigen::Index k, Eigen::Index l) {
    for (Eigen::Index dl = -half_window; dl <= half_window; ++dl)
      for (Eigen::Index dk = -half_window; dk <= half_window; ++dk) {
        const Eigen::Index k2 = (k + dk + rows * half_window) % rows,
                           l2 = (l + dl + cols * half_window) % cols;
        const bool itself = k2 == k && l2 == l;
        const bool conjugate = (k + k2) % rows == 0 && (l + l2) % cols == 0;
        if (!itself && !conjugate && !isDc(k2, l2) && !(m(k, l) > m(k2, l2) + threshold)) return false;
      }
    return true;
  };
  Bins bins;
  for (Eigen::Index l = 0; l < cols; ++l)
    for (Eigen::Index k = 0; k < rows; ++k)
      if (!isDc(k, l) && m(k, l) > 0 && exceedsItsWindow(k, l)) bins.emplace_back(k, l);
  std::sort(bins.begin(), bins.end(), [&](const auto& a, const auto& b) {
    const auto key = [&](const auto& bin) {
      return std::make_tuple(binRadius(bin.first, bin.second, rows, cols), bin.second, bin.first);
    };
    return key(a) < key(b);
  });
  return bins;
}

/// Magnitudes with the symmetry of a real grid's spectrum.
Eigen::ArrayXXd symmetric(const Eigen::ArrayXXd& values) {
  Eigen::ArrayXXd result = values;
  for (Eigen::Index l = 0; l < values.cols(); ++l)
    for (Eigen::Index k = 0; k < values.rows(); ++k)
      result(k, l) = std::max(
          values(k, l), values((values.rows() - k) % values.rows(), (values.cols() - l) % values.cols()));
  return result;
}

void expectPeaksOfEquation3(const Eigen::ArrayXXd& magnitude) {
  for (const unsigned half_window : {1U, 2U, 3U, 9U})
    for (const double threshold : {0.0, 0.5, 1.0, 2.5}) {
      SCOPED_TRACE(testing::Message() << "half window " << half_window << ", threshold " << threshold);
      EXPECT_EQ(binsOf(findSpectrumPeaks(magnitude, {half_window, threshold})),
                slowPeaks(magnitude, half_window, threshold));
    }
}

using Size = std::pair<Eigen::Index, Eigen::Index>;
class PeaksOfSize : public testing::TestWithParam<std::tuple<Size, unsigned>> {};
INSTANTIATE_TEST_SUITE_P(SizesAndSeeds, PeaksOfSize,
                         testing::Combine(testing::Values(Size(1, 1), Size(1, 2), Size(2, 1), Size(2, 2),
                                                          Size(1, 7), Size(8, 1), Size(2, 5), Size(3, 3),
                                                          Size(4, 4), Size(5, 4), Size(7, 7), Size(16, 9),
                                                          Size(13, 20)),
                                          testing::Range(1U, 5U)));

TEST_P(PeaksOfSize, AreThoseOfEquation3) {
  const auto [size, seed] = GetParam();
  const auto [rows, cols] = size;
  SCOPED_TRACE(testing::Message() << rows << " x " << cols << ", seed " << seed);
  std::mt19937 random(seed);
  expectPeaksOfEquation3(symmetric(5 * test::randomGrid(rows, cols, random).abs()));
  // Few different magnitudes: many ties and differences equal to the threshold.
  expectPeaksOfEquation3(symmetric((5 * test::randomGrid(rows, cols, random).abs()).floor()));
  expectPeaksOfEquation3(magnitude(forwardTransform(test::randomGrid(rows, cols, random))));
}

TEST_P(PeaksOfSize, KnowTheirRadiusAndMagnitude) {
  const auto [size, seed] = GetParam();
  const auto [rows, cols] = size;
  SCOPED_TRACE(testing::Message() << rows << " x " << cols << ", seed " << seed);
  std::mt19937 random(seed);
  const Eigen::ArrayXXd m = symmetric(test::randomGrid(rows, cols, random).abs());
  for (const SpectrumPeak& peak : findSpectrumPeaks(m, {})) {
    EXPECT_EQ(peak.magnitude, m(peak.k, peak.l));
    EXPECT_DOUBLE_EQ(peak.radius, std::hypot(nyquistRatio(peak.k, rows), nyquistRatio(peak.l, cols)));
  }
}

TEST(SpectrumPeaks, ComeInConjugatePairsByRadius) {
  Eigen::ArrayXXd m = Eigen::ArrayXXd::Zero(8, 8);
  m(3, 0) = m(5, 0) = 7;
  m(0, 1) = m(0, 7) = 2;
  m(4, 4) = 1;
  m(0, 0) = 100;
  EXPECT_EQ(binsOf(findSpectrumPeaks(m, {})), (Bins{{0, 1}, {0, 7}, {3, 0}, {5, 0}, {4, 4}}));
}

TEST(SpectrumPeaks, AConjugateBesideThePeakDoesNotHideIt) {
  Eigen::ArrayXXd m = Eigen::ArrayXXd::Zero(9, 9);
  m(4, 0) = m(5, 0) = 1;  // each other's conjugate, side by side across the Nyquist frequency
  EXPECT_EQ(binsOf(findSpectrumPeaks(m, {})), (Bins{{4, 0}, {5, 0}}));
}

TEST(SpectrumPeaks, PlateausHaveNone) {
  EXPECT_TRUE(findSpectrumPeaks(Eigen::ArrayXXd::Constant(6, 6, 3), {}).empty());
  EXPECT_TRUE(findSpectrumPeaks(Eigen::ArrayXXd::Zero(6, 6), {}).empty());
  EXPECT_TRUE(findSpectrumPeaks(Eigen::ArrayXXd(0, 0), {}).empty());
  Eigen::ArrayXXd dc_only = Eigen::ArrayXXd::Zero(6, 6);
  dc_only(0, 0) = 5;
  EXPECT_TRUE(findSpectrumPeaks(dc_only, {}).empty());
}

TEST(SpectrumPeaks, RoundingErrorsCountAsZero) {
  Eigen::ArrayXXd m = Eigen::ArrayXXd::Zero(8, 8);
  m(0, 4) = 1;
  m(4, 0) = 0.99e-9;
  m(0, 0) = 1e3;  // its own rounding errors are smaller than those of the peak
  EXPECT_EQ(binsOf(findSpectrumPeaks(m, {})), (Bins{{0, 4}}));
  m(4, 0) = 1.01e-9;
  EXPECT_EQ(binsOf(findSpectrumPeaks(m, {})), (Bins{{4, 0}, {0, 4}}));
  m(0, 0) = 1e6;  // and now larger
  EXPECT_EQ(binsOf(findSpectrumPeaks(m, {})), (Bins{{0, 4}}));
  m(0, 0) = 1e14;
  EXPECT_TRUE(findSpectrumPeaks(m, {}).empty());
}

TEST(SpectrumPeaks, OfAnyWindowThatCoversTheGridAreTheSame) {
  std::mt19937 random(8);
  const Eigen::ArrayXXd m = symmetric(test::randomGrid(6, 7, random).abs());
  const Bins expected = slowPeaks(m, 3, 0);
  for (const unsigned half_window : {3U, 7U, 1000U, 4000000000U})
    EXPECT_EQ(binsOf(findSpectrumPeaks(m, {half_window, 0})), expected) << half_window;
}

/// Peaks at wavelengths of 16, 8 and 4 cells.
std::vector<SpectrumPeak> threePeaks() {
  return {{1, 0, 0.125, 5}, {2, 0, 0.25, 50}, {0, 4, 0.5, 1}};
}

TEST(SelectCutoff, TakesTheLongestWavelengthThatKeepsObjectsOut) {
  constexpr double CELL = 0.0625;  // m_c of the peaks: 1 m, 0.5 m, 0.25 m
  const std::vector<std::pair<double, std::size_t>> peak_of_size = {{100, 0}, {1, 0},    {0.99, 1},
                                                                    {0.5, 1}, {0.49, 2}, {0.25, 2}};
  for (const auto& [max_object_size, n] : peak_of_size) {
    SCOPED_TRACE(max_object_size);
    const Cutoff cutoff = selectCutoff(threePeaks(), CELL, max_object_size);
    ASSERT_TRUE(cutoff.peak.has_value());
    EXPECT_EQ(cutoff.source, CutoffSource::PEAK);
    EXPECT_EQ(cutoff.peak->k, threePeaks()[n].k);
    EXPECT_EQ(cutoff.peak->l, threePeaks()[n].l);
    EXPECT_EQ(cutoff.peak->magnitude, threePeaks()[n].magnitude);
    EXPECT_EQ(cutoff.frequency, threePeaks()[n].radius);
    EXPECT_EQ(cutoff.object_size, 2 * CELL / threePeaks()[n].radius);
  }
}

TEST(SelectCutoff, WithoutAPeakFollowsFromTheSize) {
  for (const auto& peaks : {threePeaks(), std::vector<SpectrumPeak>()}) {
    const Cutoff cutoff = selectCutoff(peaks, 0.0625, 0.2);
    EXPECT_FALSE(cutoff.peak.has_value());
    EXPECT_EQ(cutoff.source, CutoffSource::FALLBACK);
    EXPECT_DOUBLE_EQ(cutoff.frequency, 0.625);
    EXPECT_DOUBLE_EQ(cutoff.object_size, 0.2);
  }
}

TEST(SelectCutoff, NeverExceedsTheCornerOfTheSpectrum) {
  for (const double max_object_size : {0.08, 1e-9, 0.0}) {
    const Cutoff cutoff = selectCutoff(threePeaks(), 0.0625, max_object_size);
    EXPECT_FALSE(cutoff.peak.has_value());
    EXPECT_EQ(cutoff.source, CutoffSource::FALLBACK);
    EXPECT_EQ(cutoff.frequency, M_SQRT2);
    EXPECT_DOUBLE_EQ(cutoff.object_size, 0.125 / M_SQRT2);
  }
}

TEST(LargestObject, IsEquation4) {
  EXPECT_DOUBLE_EQ(largestObject(0.1, 0.02), 0.4);
  EXPECT_DOUBLE_EQ(largestObject(1, 0.02), 0.04);  // Nyquist's frequency: two cells
}

}  // namespace
}  // namespace pcl_fft_ground::core
