#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::test {

/// A number in [low, high), the same with every standard library.
inline double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
}

/// Points spread evenly over an axis-aligned box.
inline core::Points randomBox(Eigen::Index count, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                              std::mt19937& random) {
  core::Points points(3, count);
  for (Eigen::Index n = 0; n < count; ++n)
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      points(axis, n) = static_cast<float>(uniform(random, low[axis], high[axis]));
  return points;
}

/// Numbers 0 .. count - 1 in random order.
inline std::vector<Eigen::Index> randomOrder(Eigen::Index count, std::mt19937& random) {
  std::vector<Eigen::Index> order;
  for (Eigen::Index n = 0; n < count; ++n) order.push_back(n);
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

/// The same points in another order.
inline core::Points shuffled(const core::Points& points, std::mt19937& random) {
  return points(Eigen::all, randomOrder(points.cols(), random));
}

/// Random heights in [-1, 1).
inline Eigen::ArrayXXd randomGrid(Eigen::Index rows, Eigen::Index cols, std::mt19937& random) {
  return Eigen::ArrayXXd::NullaryExpr(rows, cols, [&] { return uniform(random, -1, 1); });
}

}  // namespace pcl_fft_ground::test
