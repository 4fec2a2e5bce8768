// Setting the published estimator, and what it makes of values out of range.

#include <pcl/exceptions.h>

#include <functional>
#include <string>

#include "low_pass_fixture.h"

namespace pcl_fft_ground::test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Expects the call to throw a message that holds all the parts.
void expectRejected(const std::function<void()>& call, const std::vector<std::string>& parts) {
  try {
    call();
    ADD_FAILURE() << "accepted " << parts[1] << " as " << parts[0];
  } catch (const pcl::PCLException& error) {
    for (const std::string& part : parts) EXPECT_TRUE(contains(error.what(), part)) << error.what();
  }
}

TEST(LowPassSegmentation, DefaultsAreThePapers) {
  const Segmenter segmenter;
  EXPECT_EQ(segmenter.getCellSize(), 0.02);
  EXPECT_EQ(segmenter.getRelativeMaximumObjectSize(), 0.5);
  EXPECT_TRUE(std::isnan(segmenter.getMaximumObjectSize()));
  EXPECT_EQ(segmenter.getHeightTolerance(), 0.0);
  EXPECT_EQ(segmenter.getCutoffFrequency(), 0.0);
  EXPECT_EQ(segmenter.getFilterOrder(), 2U);
  EXPECT_EQ(segmenter.getPassbandRipple(), 3.0);
  EXPECT_EQ(segmenter.getPeakWindow(), 1U);
  EXPECT_EQ(segmenter.getPeakThreshold(), 0.0);
  EXPECT_EQ(segmenter.getGridLengths(), core::GridLengths::SMOOTH);
  EXPECT_EQ(segmenter.getUpEstimation(), UpEstimation::PRINCIPAL_AXIS);
  EXPECT_EQ(segmenter.getYaw(), Yaw::MIN_AREA_RECTANGLE);
  EXPECT_EQ(segmenter.getUpDirection(), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(segmenter.getElevationGrid().elevation.size(), 0);
  EXPECT_EQ(segmenter.getGroundSurface().height.size(), 0);
  EXPECT_TRUE(segmenter.getSpectrumPeaks().empty());
  EXPECT_TRUE(segmenter.getFrame().isApprox(Eigen::Isometry3d::Identity(), 0.0));
}

TEST(LowPassSegmentation, SettersReadBack) {
  Segmenter segmenter;
  segmenter.setCellSize(0.5);
  segmenter.setHeightTolerance(-0.25);
  segmenter.setCutoffFrequency(M_SQRT2);
  segmenter.setFilterOrder(7);
  segmenter.setPassbandRipple(0.5);
  segmenter.setPeakWindow(3);
  segmenter.setPeakThreshold(1.5);
  segmenter.setGridLengths(core::GridLengths::EXACT);
  EXPECT_EQ(segmenter.getCellSize(), 0.5);
  EXPECT_EQ(segmenter.getHeightTolerance(), -0.25);
  EXPECT_EQ(segmenter.getCutoffFrequency(), M_SQRT2);
  EXPECT_EQ(segmenter.getFilterOrder(), 7U);
  EXPECT_EQ(segmenter.getPassbandRipple(), 0.5);
  EXPECT_EQ(segmenter.getPeakWindow(), 3U);
  EXPECT_EQ(segmenter.getPeakThreshold(), 1.5);
  EXPECT_EQ(segmenter.getGridLengths(), core::GridLengths::EXACT);
}

TEST(LowPassSegmentation, InvalidValuesAreNamedWithTheirRange) {
  Segmenter s;
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const auto& [value, text] : std::vector<std::pair<double, std::string>>{
           {0.0, "0"}, {-0.5, "-0.5"}, {nan, "nan"}, {infinity, "inf"}}) {
    const double v = value;
    expectRejected([&] { s.setCellSize(v); }, {"cell size", text, "above 0"});
    expectRejected([&] { s.setMaximumObjectSize(v); }, {"maximum object size", text, "above 0"});
    expectRejected([&] { s.setRelativeMaximumObjectSize(v); },
                   {"relative maximum object size", text, "(0, 1]"});
    expectRejected([&] { s.setPassbandRipple(v); }, {"passband ripple", text, "(0, 100]"});
  }
  expectRejected([&] { s.setRelativeMaximumObjectSize(1.25); },
                 {"relative maximum object size", "1.25", "(0, 1]"});
  expectRejected([&] { s.setHeightTolerance(nan); }, {"height tolerance", "nan", "finite"});
  expectRejected([&] { s.setHeightTolerance(infinity); }, {"height tolerance", "inf", "finite"});
  expectRejected([&] { s.setCutoffFrequency(-0.1); }, {"cut-off frequency", "-0.1", "(0, 1.41421]"});
  expectRejected([&] { s.setCutoffFrequency(1.5); }, {"cut-off frequency", "1.5", "(0, 1.41421]"});
  expectRejected([&] { s.setCutoffFrequency(nan); }, {"cut-off frequency", "nan", "(0, 1.41421]"});
  expectRejected([&] { s.setFilterOrder(0); }, {"filter order", "0", "[1, 100]"});
  expectRejected([&] { s.setFilterOrder(101); }, {"filter order", "101", "[1, 100]"});
  expectRejected([&] { s.setPassbandRipple(101); }, {"passband ripple", "101", "(0, 100]"});
  expectRejected([&] { s.setPeakWindow(0); }, {"peak window", "0", "[1, 1000]"});
  expectRejected([&] { s.setPeakWindow(1001); }, {"peak window", "1001", "[1, 1000]"});
  expectRejected([&] { s.setPeakThreshold(-1); }, {"peak threshold", "-1", "at least 0"});
  expectRejected([&] { s.setPeakThreshold(infinity); }, {"peak threshold", "inf", "finite"});
  EXPECT_EQ(s.getCellSize(), 0.02);  // nothing of it was kept
  EXPECT_EQ(s.getFilterOrder(), 2U);
}

}  // namespace
}  // namespace pcl_fft_ground::test
