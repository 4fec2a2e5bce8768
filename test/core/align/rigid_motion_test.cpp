#include "align/rigid_motion.h"

#include <gtest/gtest.h>

namespace pcl_fft_ground::core {
namespace {

Vector6d twist(double size) {
  Vector6d result;
  result << 0.3, -0.7, 0.2, 0.5, -0.4, 0.8;
  return size * result;
}

class RigidMotion : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Sizes, RigidMotion, testing::Values(0.0, 1e-9, 1e-5, 0.01, 1.0, 2.9));

TEST_P(RigidMotion, TwistAndMotionAreInverse) {
  const Vector6d given = twist(GetParam());
  EXPECT_TRUE(twistOf(motionOf(given)).isApprox(given, 1e-9) || given.isZero(0));
}

TEST_P(RigidMotion, IsTheLimitOfManySmallSteps) {
  constexpr int DOUBLINGS = 24;
  const Vector6d small = twist(GetParam()) / (1 << DOUBLINGS);
  Eigen::Matrix4d step = Eigen::Matrix4d::Identity();
  step.topLeftCorner<3, 3>() += crossMatrix(small.tail<3>());
  step.topRightCorner<3, 1>() = small.head<3>();
  for (int i = 0; i < DOUBLINGS; ++i) step = (step * step).eval();
  EXPECT_TRUE(motionOf(twist(GetParam())).matrix().isApprox(step, 1e-5));
}

TEST_P(RigidMotion, AdjointCarriesTwistsIntoTheOtherFrame) {
  const Eigen::Isometry3d motion = motionOf(twist(GetParam()));
  const Vector6d other = twist(0.3).reverse();
  EXPECT_TRUE((motion * motionOf(other)).isApprox(motionOf(adjoint(motion) * other) * motion, 1e-12));
}

TEST(RigidMotionJacobian, IsTheDerivativeOfTheTwist) {
  const Vector6d at = twist(0.1);
  constexpr double STEP = 1e-6;
  for (int k = 0; k < 6; ++k) {
    const Vector6d d = STEP * Vector6d::Unit(k);
    const Vector6d right = (twistOf(motionOf(at) * motionOf(d)) - at) / STEP;
    const Vector6d left = (twistOf(motionOf(d) * motionOf(at)) - at) / STEP;
    EXPECT_LT((right - rightInverseJacobian(at).col(k)).norm(), 1e-4) << k;
    EXPECT_LT((left - rightInverseJacobian(-at).col(k)).norm(), 1e-4) << k;
  }
}

}  // namespace
}  // namespace pcl_fft_ground::core
