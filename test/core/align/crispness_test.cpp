#include "pcl_fft_ground/core/align/crispness.h"

#include <gtest/gtest.h>

namespace pcl_fft_ground::core {
namespace {

/// Points amid the voxels of a plate: `side` x `side` of 2 cm.
Points plate(int side) {
  Points points(3, side * side);
  for (int n = 0; n < side * side; ++n)
    points.col(n) << 0.02F * (static_cast<float>(n % side) + 0.5F),
        0.02F * (static_cast<float>(n / side) + 0.5F), 0.01F;
  return points;
}

Eigen::Isometry3d shift(double x, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, 0, z));
}

TEST(Crispness, CountsTheVoxelsOfTheUnion) {
  const Points points = plate(20);
  EXPECT_EQ(occupiedVoxels(points, points, shift(0, 0)), 400U);
  EXPECT_EQ(occupiedVoxels(points, points, shift(0.2, 0)), 600U);
  EXPECT_EQ(occupiedVoxels(points, points, shift(0, 0.02)), 800U);
  EXPECT_EQ(occupiedVoxels(Points(3, 0), points, shift(0, 0)), 400U);
}

TEST(Crispness, ChangeIsAShareOfWhatIsThereAfter) {
  EXPECT_DOUBLE_EQ(crispnessChange(110, 100), -10);
  EXPECT_DOUBLE_EQ(crispnessChange(80, 100), 20);
  EXPECT_DOUBLE_EQ(crispnessChange(0, 0), 0);
}

TEST(Crispness, OfTheOverlapDoesNotFallAsTheOverlapGrows) {
  const Points points = plate(20);
  EXPECT_DOUBLE_EQ(overlapCrispness(points, points, shift(0, 0)).value(), 1);
  EXPECT_DOUBLE_EQ(overlapCrispness(points, points, shift(0.2, 0)).value(), 1);
  EXPECT_DOUBLE_EQ(overlapCrispness(points, points, shift(0.2, 0.02)).value(), 2);
  EXPECT_FALSE(overlapCrispness(points, points, shift(1, 0)).has_value());
}

}  // namespace
}  // namespace pcl_fft_ground::core
