#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "pcl_fft_ground/core/ground/labels.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::test {

/// A house with a gable roof, 12 m x 8 m, turned about the vertical.
struct House {
  static constexpr double HALF_LENGTH = 6, HALF_WIDTH = 4, EAVES = 5, RISE = 2;  // [m]

  Eigen::Vector2d centre;  ///< [m]
  double yaw;              ///< of the ridge [rad]

  /// Height above the ground [m]; 0 beside the house.
  double heightAt(const Eigen::Vector2d& place) const {
    const Eigen::Vector2d local = Eigen::Rotation2Dd(-yaw) * (place - centre);
    if (std::abs(local.x()) > HALF_LENGTH || std::abs(local.y()) > HALF_WIDTH) return 0;
    return EAVES + RISE * (1 - std::abs(local.y()) / HALF_WIDTH);
  }
};

/// Nine houses on 66 m x 66 m, each turned another way.
inline std::vector<House> nineHouses() {
  std::vector<House> houses;
  for (int n = 0; n < 9; ++n)
    houses.push_back({{22.0 * (n % 3 - 1) + 0.9 * (n % 2), 22.0 * (n / 3 - 1) - 0.7 * (n % 4)}, 0.35 * n});
  return houses;
}

/// What one of two flight lines sees of houses.
struct FlightLine {
  core::Points points;
  core::Labels labels;
};

/** Points of roofs and ground from above, and of the walls that face the aircraft.
 * \param towards horizontal direction from which the aircraft looks, of unit length
 * \param spacing mean distance of the points [m]
 */
inline FlightLine flyOver(const std::vector<House>& houses, const Eigen::Vector2d& towards, unsigned seed,
                          double spacing = 0.25, double noise = 0.01) {
  constexpr double SIDE = 66;
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
  std::vector<Eigen::Vector3d> points;
  FlightLine line;
  const auto add = [&](const Eigen::Vector2d& place, double height) {
    const double ground = 0.3 * std::sin(0.1 * place.x()) + 0.2 * std::cos(0.13 * place.y());
    points.emplace_back(place.x(), place.y(), ground + height + 2 * noise * uniform());
    line.labels.push_back(height > 0 ? core::Label::OBJECT : core::Label::GROUND);
  };
  const auto count = static_cast<int>(SIDE * SIDE / (spacing * spacing));
  for (int n = 0; n < count; ++n) {
    const Eigen::Vector2d place(SIDE * uniform(), SIDE * uniform());
    double height = 0;
    for (const House& house : houses) height = std::max(height, house.heightAt(place));
    add(place, height);
  }
  for (const House& house : houses)
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector2d outwards = Eigen::Rotation2Dd(house.yaw) * Eigen::Vector2d(0, side);
      const double facing = outwards.dot(towards);
      const double area = 2 * House::HALF_LENGTH * House::EAVES;
      for (int n = 0; n < static_cast<int>(facing * area / (spacing * spacing)); ++n) {
        const Eigen::Vector2d local(2 * House::HALF_LENGTH * uniform(), side * House::HALF_WIDTH);
        add(house.centre + Eigen::Rotation2Dd(house.yaw) * local, House::EAVES * (0.5 + uniform()));
      }
    }
  line.points.resize(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n)
    line.points.col(static_cast<Eigen::Index>(n)) = points[n].cast<float>();
  return line;
}

}  // namespace pcl_fft_ground::test
