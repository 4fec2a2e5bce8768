#include "simulation/scene_builder.h"

#include <algorithm>
#include <cmath>

namespace pcl_fft_ground::core {

namespace {

constexpr double kTwoPi = 6.28318530717958647692;
constexpr double kHighestPile = 0.15;  // [m] above the ground that may carry another object

double heapHeight(const Scene& scene, const Eigen::Vector2d& xy) {
  return scene.topHeight(xy.x(), xy.y()) - scene.terrain().height(xy.x(), xy.y());
}

Eigen::Vector2d anywhere(const Scene& scene, Random& random) {
  const Eigen::AlignedBox2d& extent = scene.extent();
  const double x = random.uniform(extent.min().x(), extent.max().x());
  const double y = random.uniform(extent.min().y(), extent.max().y());
  return {x, y};
}

/// Near an earlier object, so that piles form.
Eigen::Vector2d besideAnother(const Scene& scene, Random& random) {
  constexpr double kSpread = 0.22;  // [m]
  const Eigen::Vector2d other = scene.position(random.below(scene.size()));
  const double dx = random.normal(kSpread);
  const double dy = random.normal(kSpread);
  const Eigen::AlignedBox2d& extent = scene.extent();
  return (other + Eigen::Vector2d(dx, dy)).cwiseMax(extent.min()).cwiseMin(extent.max());
}

/// A place where the heap is not too high yet. \param piled share of objects beside another one
Eigen::Vector2d restingPlace(const Scene& scene, double piled, Random& random) {
  constexpr int kTries = 20;
  Eigen::Vector2d xy = anywhere(scene, random);
  for (int i = 0; i < kTries; ++i) {
    const bool beside = scene.size() > 0 && random.chance(piled);
    xy = beside ? besideAnother(scene, random) : anywhere(scene, random);
    if (heapHeight(scene, xy) < kHighestPile) break;
  }
  return xy;
}

/// How a long body comes to lie.
struct Repose {
  Eigen::Vector2d xy;  ///< its middle [m]
  double yaw;          ///< of its axis [rad]
  double length;       ///< [m]
  double radius;       ///< [m]
  double sinking;      ///< height of the axis above what carries it, in radii: -1 just buried, 1 on top
  double pitch;        ///< added to the slope of what carries it [rad]
};

/// The body's z axis runs from its lower support to its upper one and on.
Eigen::Isometry3d layDown(const Scene& scene, const Repose& repose, double roll) {
  constexpr double kSteepest = 0.6;  // [rad]
  const Eigen::Vector2d along(std::cos(repose.yaw), std::sin(repose.yaw));
  const double reach = 0.3 * repose.length;
  const auto top = [&](double distance) {
    const Eigen::Vector2d at = repose.xy + distance * along;
    return scene.topHeight(at.x(), at.y());
  };
  const double low = top(-reach);
  const double high = top(reach);
  const double slope = std::atan2(high - low, 2.0 * reach);
  const double pitch = std::clamp(slope, -kSteepest, kSteepest) + repose.pitch;
  const double support = std::max(0.5 * (low + high), std::min(top(0.0), 0.5 * (low + high) + 0.1));
  Eigen::Isometry3d site_from_shape = Eigen::Isometry3d::Identity();
  site_from_shape.translation() << repose.xy, support + repose.sinking * repose.radius;
  site_from_shape.linear() = (Eigen::AngleAxisd(repose.yaw, Eigen::Vector3d::UnitZ()) *
                              Eigen::AngleAxisd(0.25 * kTwoPi - pitch, Eigen::Vector3d::UnitY()) *
                              Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()))
                                 .toRotationMatrix();
  return site_from_shape;
}

PlacedObject placeAmphora(const Scene& scene, Random& random) {
  const double rank = random.uniform(0.0, 1.0);
  const double length = 0.3 + 0.7 * rank * rank;  // small ones are the most frequent
  const TurnedBody amphora = makeAmphora(length, random);
  Repose repose;
  repose.xy = restingPlace(scene, 0.35, random);
  repose.yaw = random.uniform(0.0, kTwoPi);
  repose.length = length;
  repose.radius = 0.17 * length;
  repose.pitch = random.normal(0.15);
  const double depth = random.uniform(-0.5, 0.6);
  const bool upright = random.chance(0.05);  // stuck in the sediment by the toe
  const double leaning = random.uniform(0.8, 1.5);
  const double roll = random.uniform(0.0, kTwoPi);
  const bool carried = heapHeight(scene, repose.xy) > 0.03;
  repose.sinking = carried ? 0.1 + 0.5 * depth : depth;
  if (upright && !carried) repose.pitch = leaning;
  return {amphora, layDown(scene, repose, roll)};
}

PlacedObject placePipe(const Scene& scene, Random& random) {
  constexpr double kHeading = 0.5;  // [rad]: most pipes lie roughly along the line that they were part of
  const double length = random.uniform(0.5, 2.0);
  const double radius = random.uniform(0.04, 0.13);
  const bool socket = random.chance(0.4);
  Repose repose;
  repose.xy = restingPlace(scene, 0.15, random);
  const bool astray = random.chance(0.3);
  const double stray = random.uniform(0.0, kTwoPi);
  const double heading = random.normal(kHeading);
  repose.yaw = astray ? stray : heading;
  repose.length = length;
  repose.radius = radius;
  repose.pitch = random.normal(0.03);
  const double depth = random.uniform(-0.4, 0.8);
  repose.sinking = heapHeight(scene, repose.xy) > 0.03 ? 0.6 : depth;
  return {makePipe(length, radius, socket), layDown(scene, repose, 0.0)};
}

PlacedObject placeBoulder(const Scene& scene, Random& random) {
  // Small ones are the most frequent: the number above a size falls as its power -1.5.
  const double rank = random.uniform(0.0, 1.0);
  const double largest_share = std::pow(10.0, -1.5);
  const double size = 0.1 * std::pow(1.0 - rank * (1.0 - largest_share), -1.0 / 1.5);
  const Rock rock = makeRock(size, random);
  const Eigen::Vector2d xy = restingPlace(scene, 0.2, random);
  const double yaw = random.uniform(0.0, kTwoPi);
  const double tip = random.normal(0.3);
  const double roll = random.normal(0.3);
  const double depth = random.uniform(-0.2, 0.5);
  Eigen::Isometry3d site_from_shape = Eigen::Isometry3d::Identity();
  site_from_shape.translation() << xy, scene.topHeight(xy.x(), xy.y()) + depth * rock.semi_axes.z();
  site_from_shape.linear() =
      (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(tip, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return {rock, site_from_shape};
}

}  // namespace

PlacedObject placeObject(SceneKind kind, const Scene& scene, Random& random) {
  switch (kind) {
    case SceneKind::PIPES:
      return placePipe(scene, random);
    case SceneKind::REEF:
      return placeBoulder(scene, random);
    case SceneKind::WRECK:
    case SceneKind::BARE:
      break;
  }
  return placeAmphora(scene, random);
}

}  // namespace pcl_fft_ground::core
