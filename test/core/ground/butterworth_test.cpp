#include "pcl_fft_ground/core/ground/butterworth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "random_points.h"
#include "slow_dft.h"

namespace pcl_fft_ground::core {
namespace {

class ButterworthOf : public testing::TestWithParam<Butterworth> {};
INSTANTIATE_TEST_SUITE_P(Filters, ButterworthOf,
                         testing::Values(Butterworth{}, Butterworth{0.1, 1, 3.0}, Butterworth{0.25, 2, 0.5},
                                         Butterworth{M_SQRT2, 3, 6.0}, Butterworth{0.5, 7, 20.0},
                                         Butterworth{1e-3, 4, 1.0}));

TEST_P(ButterworthOf, PassesDcAndLosesTheRippleAtTheCutoff) {
  const Butterworth filter = GetParam();
  EXPECT_EQ(filter.response(0), 1);
  EXPECT_NEAR(-20 * std::log10(filter.response(filter.cutoff)), filter.passband_ripple, 1e-12);
}

TEST_P(ButterworthOf, FallsByTwentyDecibelsPerOrderAndDecade) {
  const Butterworth filter = GetParam();
  const double far = filter.response(1e4 * filter.cutoff), farther = filter.response(1e5 * filter.cutoff);
  EXPECT_NEAR(20 * std::log10(far / farther), 20.0 * filter.order, 1e-6);
}

TEST_P(ButterworthOf, FallsSteadily) {
  const Butterworth filter = GetParam();
  for (double radius = 0.05; radius < 1.45; radius += 0.05)
    EXPECT_LE(filter.response(radius), filter.response(radius - 0.05)) << radius;
}

TEST_P(ButterworthOf, MultipliesEveryBinByItsResponse) {
  const Butterworth filter = GetParam();
  std::mt19937 random(3);
  for (const Eigen::Index rows : {1, 2, 8, 9})
    for (const Eigen::Index cols : {1, 2, 11, 12}) {
      SCOPED_TRACE(testing::Message() << rows << " x " << cols);
      const Spectrum before = forwardTransform(test::randomGrid(rows, cols, random));
      const Spectrum after = filtered(before, filter);
      EXPECT_EQ(after.rows, rows);
      for (Eigen::Index l = 0; l < cols; ++l)
        for (Eigen::Index k = 0; k <= rows / 2; ++k) {
          const double x = test::nyquistRatio(k, rows) / filter.cutoff;
          const double y = test::nyquistRatio(l, cols) / filter.cutoff;
          const double squared_edge = std::pow(10, filter.passband_ripple / 10) - 1;
          const double response = 1 / std::sqrt(1 + squared_edge * std::pow(x * x + y * y, filter.order));
          ASSERT_LE(std::abs(after.half(k, l) - before.half(k, l) * response), 1e-13) << k << ", " << l;
        }
    }
}

TEST(Butterworth, OfNoBins) {
  EXPECT_EQ(filtered(Spectrum(), Butterworth()).half.size(), 0);
}

}  // namespace
}  // namespace pcl_fft_ground::core
