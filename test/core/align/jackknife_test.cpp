#include "pcl_fft_ground/core/align/rigid_fit.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace pcl_fft_ground::core {
namespace {

/// A part of the scene that says the scan is to be shifted so far, and nothing of its turning.
MotionFit saying(const Eigen::Vector3d& shift) {
  MotionFit part(Eigen::Vector3d::Zero());
  for (int k = 0; k < 3; ++k) part.addToPlane(Eigen::Vector3d::Zero(), shift, Eigen::Vector3d::Unit(k), 1);
  return part;
}

TEST(Jackknife, OfAMeanIsTheVarianceOfTheMean) {
  const std::array<double, 4> shifts{0.01, 0.03, -0.02, 0.06};  // mean 0.02, sum of squares 0.0034
  std::vector<MotionFit> parts;
  for (const double shift : shifts) parts.push_back(saying({shift, 2 * shift, 0}));
  const Matrix6d covariance = jackknifeCovariance(parts);
  const double expected = 0.0034 / 3 / 4;
  EXPECT_NEAR(covariance(0, 0), expected, 1e-9);
  EXPECT_NEAR(covariance(0, 1), 2 * expected, 1e-9);
  EXPECT_NEAR(covariance(1, 1), 4 * expected, 1e-9);
  EXPECT_NEAR(covariance(2, 2), 0, 1e-12);
}

TEST(Jackknife, PartsThatAgreeHaveNoSpread) {
  EXPECT_TRUE(jackknifeCovariance({saying({0.1, 0, 0}), saying({0.1, 0, 0})}).isZero(1e-12));
}

TEST(Jackknife, NeedsTwoPartsThatSayAnything) {
  const MotionFit silent(Eigen::Vector3d::Zero());
  EXPECT_TRUE(jackknifeCovariance({}).isZero(0));
  EXPECT_TRUE(jackknifeCovariance({saying({1, 0, 0}), silent}).isZero(0));
  const std::vector<MotionFit> two{saying({0.1, 0, 0}), saying({0.3, 0, 0})};
  const std::vector<MotionFit> with_silent{two[0], silent, two[1]};
  EXPECT_TRUE(jackknifeCovariance(two).isApprox(jackknifeCovariance(with_silent)));
}

}  // namespace
}  // namespace pcl_fft_ground::core
