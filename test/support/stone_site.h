#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "pcl_fft_ground/core/ground/labels.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::test {

/// An upright half ellipsoid, turned about the vertical.
struct Stone {
  Eigen::Vector2d centre;     ///< [m]
  Eigen::Vector3d semi_axes;  ///< [m]
  double yaw;                 ///< [rad]

  /// Height above the ground [m]; 0 beside the stone.
  double heightAt(const Eigen::Vector2d& place) const {
    const Eigen::Vector2d local = Eigen::Rotation2Dd(-yaw) * (place - centre);
    const double inside = 1 - (local.array() / semi_axes.head<2>().array()).square().sum();
    return inside > 0 ? semi_axes.z() * std::sqrt(inside) : 0;
  }
};

using StoneSite = std::vector<Stone>;

/// Stones of different sizes, strewn over 8 m x 6 m around the origin.
inline StoneSite randomStones(unsigned seed, int count = 45) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  StoneSite site;
  for (int n = 0; n < count; ++n) {
    const double x = uniform(-4, 4), y = uniform(-3, 3), yaw = uniform(0, M_PI);
    const double a = uniform(0.1, 0.3), b = uniform(0.07, 0.2), c = uniform(0.08, 0.25);
    site.push_back({{x, y}, {a, b, c}, yaw});
  }
  return site;
}

/// A scan of stones, and which points are stone.
struct StoneScan {
  core::Points points;
  core::Labels labels;
};

/** 3 m x 3 m of a site, seen from above: points scattered over the scan's own x and y, noise along z.
 * \param spacing mean distance of the points [m]
 */
inline StoneScan scanStones(const StoneSite& site, const Eigen::Isometry3d& site_from_scan, unsigned seed,
                            double spacing = 0.008, double noise = 0.001) {
  constexpr double SIDE = 3, LEAST_HEIGHT = 0.01;
  std::mt19937 random(seed);
  const auto scatter = [&] { return SIDE * (static_cast<double>(random()) / 4294967296.0 - 0.5); };
  const auto count = static_cast<Eigen::Index>(SIDE * SIDE / (spacing * spacing));
  StoneScan scan{core::Points(3, count), core::Labels(static_cast<std::size_t>(count), core::Label::GROUND)};
  for (Eigen::Index n = 0; n < count; ++n) {
    const double x = scatter(), y = scatter();
    Eigen::Vector3d place = site_from_scan * Eigen::Vector3d(x, y, 0);
    double height = 0;
    for (const Stone& stone : site) height = std::max(height, stone.heightAt(place.head<2>()));
    if (height > LEAST_HEIGHT) scan.labels[static_cast<std::size_t>(n)] = core::Label::OBJECT;
    place.z() =
        height + 0.03 * std::sin(place.x()) + 0.02 * std::cos(1.3 * place.y()) + noise / SIDE * scatter();
    scan.points.col(n) = (site_from_scan.inverse() * place).cast<float>();
  }
  return scan;
}

/// A pose over the site: place [m] and heading [degrees].
inline Eigen::Isometry3d poseAt(double x, double y, double heading) {
  return Eigen::Translation3d(x, y, 0) * Eigen::AngleAxisd(heading * M_PI / 180, Eigen::Vector3d::UnitZ());
}

}  // namespace pcl_fft_ground::test
