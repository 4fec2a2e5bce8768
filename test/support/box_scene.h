#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace pcl_fft_ground::test {

/// Points whose labels are known.
struct Scene {
  Eigen::Matrix3Xf points;      ///< one point per column [m], row by row
  std::vector<bool> is_object;  ///< true for a point of a box
  std::uint32_t width = 0;      ///< points in a row
  std::uint32_t height = 0;     ///< rows
};

/// Height of the ground [m] under boxScene(): one swell along x and one along y.
inline double boxSceneGround(double x, double y) {
  return 0.05 * std::sin(2 * M_PI * x / 4.0) + 0.03 * std::cos(2 * M_PI * y / 2.5);
}

/// True under one of the boxes.
inline bool isUnderBox(double x, double y) {
  constexpr double HALF_SIDE = 0.2;
  constexpr std::array<std::array<double, 2>, 4> CENTRES = {{{0.7, 0.6}, {1.9, 1.7}, {3.1, 0.9}, {3.3, 2.0}}};
  for (const auto& centre : CENTRES)
    if (std::abs(x - centre[0]) < HALF_SIDE && std::abs(y - centre[1]) < HALF_SIDE) return true;
  return false;
}

/** Boxes 0.4 m wide and 0.3 m high on a gently swelling ground, seen from above: 100 x 62 points, 0.04 m
 * apart.
 *
 * The places are scattered a little. Coordinates are odd multiples of 2^-13 m, so that translations by whole
 * metres and quarter turns are exact in float, and no point lies on the edge of a cell of 0.05 m. The points
 * at the corners span the rectangle [0, 4] x [0, 2.5] exactly.
 */
inline Scene boxScene() {
  constexpr double BOX_HEIGHT = 0.3, STEP = 1.0 / 4096;
  constexpr int WIDTH = 100, HEIGHT = 62, SPACING = 164, MARGIN = 40, SCATTER = 40;  // in steps
  const auto in_steps = [](double length) { return (std::floor(length / STEP) + 0.5) * STEP; };
  std::mt19937 random(1);
  const auto place = [&](int cell) {
    return (cell * SPACING + MARGIN + static_cast<int>(random() % SCATTER) + 0.5) * STEP;
  };
  Scene scene;
  scene.width = WIDTH;
  scene.height = HEIGHT;
  scene.points.resize(3, WIDTH * HEIGHT);
  for (int n = 0; n < WIDTH * HEIGHT; ++n) {
    const int column = n % WIDTH, row = n / WIDTH;
    const bool corner = (column == 0 || column == WIDTH - 1) && (row == 0 || row == HEIGHT - 1);
    const double x = corner ? (column == 0 ? 0.0 : 4.0) : place(column);
    const double y = corner ? (row == 0 ? 0.0 : 2.5) : place(row);
    const bool object = isUnderBox(x, y);
    const double z = boxSceneGround(x, y) + (object ? BOX_HEIGHT : 0.0);
    scene.points.col(n) = Eigen::Vector3d(x, y, in_steps(z)).cast<float>();
    scene.is_object.push_back(object);
  }
  return scene;
}

}  // namespace pcl_fft_ground::test
