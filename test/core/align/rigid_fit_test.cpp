#include "pcl_fft_ground/core/align/rigid_fit.h"

#include <gtest/gtest.h>

#include <random>

#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

const Eigen::Vector3d CENTRE(1, -2, 0.5);

Eigen::Isometry3d smallMotion() {
  Vector6d motion;
  motion << 0.02, -0.01, 0.03, 0.002, -0.001, 0.003;
  return motionAbout(CENTRE, motion);
}

TEST(RigidFit, YawFitRecoversTurnAndShift) {
  std::mt19937 random(1);
  const Points points = test::randomBox(20, {-1, -1, 0}, {1, 1, 1}, random);
  const Eigen::Isometry3d truth =
      Eigen::Translation3d(0.3, -0.2, 0.1) * Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitZ());
  YawFit fit;
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Eigen::Vector3d point = points.col(n).cast<double>();
    fit.add(point, truth * point, 0.1 + static_cast<double>(n));
  }
  EXPECT_TRUE(fit.solve().isApprox(truth, 1e-9));
  EXPECT_TRUE(YawFit().solve().isApprox(Eigen::Isometry3d::Identity()));
}

TEST(RigidFit, MotionFitRecoversASmallMotionFromPlanesAndFromPoints) {
  std::mt19937 random(2);
  const Points points = test::randomBox(50, {0, -3, 0}, {2, -1, 1}, random);
  const Points normals = test::randomBox(50, {-1, -1, -1}, {1, 1, 1}, random);
  const Eigen::Isometry3d truth = smallMotion();
  MotionFit planes(CENTRE), to_points(CENTRE);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Eigen::Vector3d point = points.col(n).cast<double>();
    planes.addToPlane(point, truth * point, normals.col(n).cast<double>().normalized(), 1);
    to_points.addToPoint(point, truth * point, 1);
  }
  EXPECT_TRUE(planes.solve().isApprox(truth, 1e-4));
  EXPECT_TRUE(to_points.solve().isApprox(truth, 1e-4));
}

TEST(RigidFit, WhatNothingHoldsDoesNotMove) {
  MotionFit fit(CENTRE);
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)})
    fit.addToPlane(place, place + Eigen::Vector3d(5, 5, 0.1), Eigen::Vector3d::UnitZ(), 1);
  EXPECT_TRUE(fit.solve().isApprox(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.1)), 1e-9));
}

TEST(RigidFit, ATurnAboutTheCentreMovesTheOrigin) {
  Vector6d turn = Vector6d::Zero();
  turn[5] = 1e-4;
  const Eigen::Vector3d origin_moved = motionAbout(CENTRE, turn) * Eigen::Vector3d::Zero();
  const Matrix6d covariance = covarianceAboutOrigin(turn * turn.transpose(), CENTRE);
  EXPECT_TRUE((covariance.topLeftCorner<3, 3>().isApprox(origin_moved * origin_moved.transpose(), 1e-3)));
  EXPECT_DOUBLE_EQ(covariance(5, 5), 1e-8);
}

TEST(RigidFit, YawAndTiltOfARotation) {
  const Eigen::Isometry3d tilted(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX()));
  EXPECT_NEAR(yawOf(tilted), 0.3, 1e-9);
  EXPECT_NEAR(tiltOf(tilted), 0.05, 1e-9);
}

}  // namespace
}  // namespace pcl_fft_ground::core
