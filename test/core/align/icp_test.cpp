#include "align/icp.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pcl_fft_ground::core {
namespace {

TEST(SummariseIcp, PointsWithoutASurfaceSayNothing) {
  constexpr Eigen::Index SIDE = 11;
  constexpr double SPACING = 0.02;
  Points surface(3, SIDE * SIDE + 1);
  for (Eigen::Index n = 0; n < SIDE * SIDE; ++n)
    surface.col(n) = SPACING * Eigen::Vector3f(static_cast<float>(n % SIDE), static_cast<float>(n / SIDE), 0);
  surface.col(SIDE * SIDE) = Eigen::Vector3f(5, 5, 5);  // alone
  const auto correspondence = [&](Eigen::Index n) {
    const Eigen::Vector3d place = surface.col(n).cast<double>();
    return Correspondence{place + Eigen::Vector3d(0, 0, 0.004), place, static_cast<std::size_t>(n), 1, 0};
  };
  std::vector<Correspondence> found;
  for (Eigen::Index n = 0; n < SIDE * SIDE; ++n) found.push_back(correspondence(n));
  SurfaceNormals normals(surface, SPACING, columnNeighbours, static_cast<std::size_t>(surface.cols()));
  const IcpResult alone = summariseIcp(Eigen::Isometry3d::Identity(), found, normals);
  EXPECT_NEAR(std::sqrt(alone.variance), 0.004, 1e-6);
  for (int n = 0; n < 100; ++n) found.push_back(correspondence(SIDE * SIDE));
  EXPECT_NEAR(summariseIcp(Eigen::Isometry3d::Identity(), found, normals).variance, alone.variance, 1e-12);
}

}  // namespace
}  // namespace pcl_fft_ground::core
