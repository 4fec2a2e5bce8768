#include "pcl_fft_ground/relief_alignment.h"

#include <gtest/gtest.h>
#include <pcl/exceptions.h>
#include <pcl/point_types.h>

#include <cmath>
#include <limits>
#include <random>

#include "analytic_worlds.h"

namespace pcl_fft_ground {
namespace {

using Relief = ReliefAlignment<pcl::PointXYZ, pcl::PointXYZ>;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// Ground of five crossing waves.
double ground(double x, double y) {
  return 0.3 * std::cos(0.5 * x + 0.2 * y) + 0.2 * std::cos(0.9 * y - 0.3 * x + 1) +
         0.15 * std::cos(1.1 * x + 0.8 * y + 2) + 0.1 * std::cos(1.6 * x - 0.7 * y + 3) +
         0.1 * std::cos(0.4 * x - 1.7 * y + 4);
}

Eigen::Isometry3d poseAt(double x, double y, double turn) {
  return Eigen::Translation3d(x, y, 0) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
}

/// 14 m x 14 m of it, with a centimetre of noise.
Cloud::Ptr scan(const Eigen::Isometry3d& world_from_scan, unsigned seed,
                const Eigen::Matrix3d& input_from_level) {
  std::mt19937 random(seed);
  const core::Points places = test::randomBox(3000, {-7, -7, 0}, {7, 7, 0}, random);
  const Cloud::Ptr cloud(new Cloud);
  for (Eigen::Index n = 0; n < places.cols(); ++n) {
    Eigen::Vector3d point = places.col(n).cast<double>();
    const Eigen::Vector3d world = world_from_scan * point;
    point.z() = ground(world.x(), world.y()) + test::uniform(random, -0.01, 0.01);
    const Eigen::Vector3f input = (input_from_level * point).cast<float>();
    cloud->emplace_back(input.x(), input.y(), input.z());
  }
  constexpr float NO_NUMBER = std::numeric_limits<float>::quiet_NaN();
  cloud->emplace_back(NO_NUMBER, NO_NUMBER, NO_NUMBER);
  return cloud;
}

const Eigen::Isometry3d TRUTH = poseAt(5, 1, 0.2);

class ReliefAlignmentClass : public testing::Test {
 protected:
  void give(const Eigen::Matrix3d& input_from_level = Eigen::Matrix3d::Identity()) {
    relief_.setInputSource(scan(TRUTH, 1, input_from_level));
    relief_.setInputTarget(scan(Eigen::Isometry3d::Identity(), 2, input_from_level));
    relief_.setMaxShift(2);
    relief_.setMaxTurn(6);
  }

  /// \return how far the result is off amid the source [m]
  double align(const Eigen::Isometry3d& guess, const Eigen::Isometry3d& truth) {
    relief_.align(aligned_, guess.matrix().cast<float>());
    return (relief_.getFinalTransformation().cast<double>() - truth.matrix()).norm();
  }

  Relief relief_;
  Cloud aligned_;
};

TEST_F(ReliefAlignmentClass, AlignsBareGround) {
  give();
  EXPECT_LT(align(poseAt(1.2, -0.8, 0.06) * TRUTH, TRUTH), 0.03);
  EXPECT_TRUE(relief_.hasConverged()) << relief_.getRefusal();
  EXPECT_GT(relief_.getCovariance().diagonal().minCoeff(), 0);
  EXPECT_GT(relief_.getBest().evidence, 3);
  ASSERT_EQ(aligned_.size(), relief_.getInputSource()->size());
  const Eigen::Vector4f first =
      relief_.getFinalTransformation() * (*relief_.getInputSource())[0].getVector4fMap();
  EXPECT_TRUE(aligned_[0].getVector4fMap().isApprox(first));
}

TEST_F(ReliefAlignmentClass, UpMayPointAnywhere) {
  const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 0.5).normalized()).toRotationMatrix();
  give(turned);
  relief_.setUpDirection(turned.col(2));
  const Eigen::Isometry3d input_from_level(turned);
  const auto seen = [&](const Eigen::Isometry3d& pose) {
    return Eigen::Isometry3d(input_from_level * pose * input_from_level.inverse());
  };
  EXPECT_LT(align(seen(poseAt(0.5, 0.5, 0) * TRUTH), seen(TRUTH)), 0.03);
  EXPECT_TRUE(relief_.hasConverged()) << relief_.getRefusal();
}

TEST_F(ReliefAlignmentClass, RefusesWhatNavigationDoesNotAllow) {
  give();
  const Eigen::Isometry3d guess = poseAt(5, 5, 0) * TRUTH;
  align(guess, TRUTH);
  EXPECT_FALSE(relief_.hasConverged());
  EXPECT_FALSE(relief_.getRefusal().empty());
  EXPECT_TRUE(relief_.getFinalTransformation().isApprox(guess.matrix().cast<float>()));
}

/// Seen from above it is a line, and its points lie so close that the cells would be too many.
TEST_F(ReliefAlignmentClass, AWallIsRefused) {
  const Cloud::Ptr wall(new Cloud);
  std::mt19937 random(3);
  for (int n = 0; n < 50; ++n)
    wall->emplace_back(n % 2 == 0 ? 0.0F : 1e-30F, static_cast<float>(test::uniform(random, 0, 1)),
                       static_cast<float>(test::uniform(random, 0, 1)));
  relief_.setInputSource(wall);
  relief_.setInputTarget(wall);
  const Eigen::Isometry3d guess = poseAt(0.1, 0.2, 0.03);
  ASSERT_NO_THROW(align(guess, TRUTH));
  EXPECT_FALSE(relief_.hasConverged());
  EXPECT_NE(relief_.getRefusal().find("cells"), std::string::npos) << relief_.getRefusal();
  EXPECT_TRUE(relief_.getFinalTransformation().isApprox(guess.matrix().cast<float>()));
}

/// Lifts all points within half a metre of the places of a square lattice, and the same ones in both scans.
void addBoxes(Cloud& cloud, const Eigen::Isometry3d& world_from_scan) {
  for (auto& point : cloud) {
    const Eigen::Vector3d world = world_from_scan * point.getVector3fMap().cast<double>();
    const double dx = world.x() - 2 * std::round(world.x() / 2),
                 dy = world.y() - 2 * std::round(world.y() / 2);
    if (std::max(std::abs(dx), std::abs(dy)) < 0.5) point.z += 1.5F;
  }
}

TEST_F(ReliefAlignmentClass, ObjectsAreNoReliefUnlessTheyMayBe) {
  const Cloud::Ptr source = scan(TRUTH, 1, Eigen::Matrix3d::Identity());
  const Cloud::Ptr target = scan(Eigen::Isometry3d::Identity(), 2, Eigen::Matrix3d::Identity());
  addBoxes(*source, TRUTH);
  addBoxes(*target, Eigen::Isometry3d::Identity());
  relief_.setInputSource(source);
  relief_.setInputTarget(target);
  relief_.setMaxShift(0.5);
  relief_.setMaxTurn(3);
  relief_.setMaxObjectShare(1);
  align(TRUTH, TRUTH);
  ASSERT_TRUE(relief_.hasConverged()) << relief_.getRefusal();
  relief_.setMaxObjectShare(0.1);
  align(TRUTH, TRUTH);
  EXPECT_FALSE(relief_.hasConverged());
  EXPECT_NE(relief_.getRefusal().find("objects have"), std::string::npos) << relief_.getRefusal();
  EXPECT_TRUE(relief_.getFinalTransformation().isApprox(TRUTH.matrix().cast<float>()));
}

TEST_F(ReliefAlignmentClass, IsAsPreciseAsAskedFor) {
  give();
  relief_.setMaxSigma(1e-5);
  align(TRUTH, TRUTH);
  EXPECT_FALSE(relief_.hasConverged());
  EXPECT_NE(relief_.getRefusal().find("deviation"), std::string::npos) << relief_.getRefusal();
}

TEST_F(ReliefAlignmentClass, SettersAndGettersAgree) {
  relief_.setMaxShift(3);
  EXPECT_EQ(relief_.getMaxShift(), 3);
  EXPECT_EQ(relief_.getMaxRise(), 3);
  relief_.setMaxRise(0.5);
  EXPECT_EQ(relief_.getMaxRise(), 0.5);
  relief_.setMaxTurn(20);
  EXPECT_EQ(relief_.getMaxTurn(), 20);
  relief_.setCellSize(0.7);
  EXPECT_EQ(relief_.getCellSize(), 0.7);
  relief_.setCellSize(0);
  EXPECT_EQ(relief_.getCellSize(), 0);
  relief_.setMaxObjectShare(0.3);
  EXPECT_EQ(relief_.getMaxObjectShare(), 0.3);
  relief_.setMaxSigma(0.02);
  EXPECT_EQ(relief_.getMaxSigma(), 0.02);
  relief_.setMaxSigma(0);
  EXPECT_EQ(relief_.getMaxSigma(), 0);
  EXPECT_THROW(relief_.setMaxObjectShare(1.1), pcl::PCLException);
  EXPECT_THROW(relief_.setMaxSigma(-1), pcl::PCLException);
  EXPECT_THROW(relief_.setMaxShift(0), pcl::PCLException);
  EXPECT_THROW(relief_.setMaxRise(-1), pcl::PCLException);
  EXPECT_THROW(relief_.setMaxTurn(181), pcl::PCLException);
  EXPECT_THROW(relief_.setCellSize(-1), pcl::PCLException);
  EXPECT_THROW(relief_.setUpDirection(Eigen::Vector3d::Zero()), pcl::PCLException);
}

}  // namespace
}  // namespace pcl_fft_ground
