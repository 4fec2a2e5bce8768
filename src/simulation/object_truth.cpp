#include "simulation/scan_measurement.h"

#include <algorithm>
#include <optional>
#include <variant>

namespace pcl_fft_ground::core {

namespace {

constexpr int kCells = 96;  // along either side of an object's box: its volume is right to about a hundredth

/// Heights of the lower and upper side of an object at a place.
struct Thickness {
  double bottom;
  double top;
};

std::optional<Thickness> thicknessAt(const PlacedObject& object, const Eigen::Vector2d& xy) {
  constexpr double kBeyond = 10.0;  // [m] from the object's origin, outside of every object
  const Eigen::Isometry3d shape_from_site = object.site_from_shape.inverse();
  const double middle = object.site_from_shape.translation().z();
  const auto range = [&](double side) {
    const Eigen::Vector3d start(xy.x(), xy.y(), middle + side * kBeyond);
    const Eigen::Vector3d direction(0.0, 0.0, -side);
    return firstHit(object.shape, {shape_from_site * start, shape_from_site.linear() * direction}, 0.0);
  };
  const std::optional<double> from_above = range(1.0);
  const std::optional<double> from_below = range(-1.0);
  if (!from_above || !from_below) return std::nullopt;
  return Thickness{middle - kBeyond + *from_below, middle + kBeyond - *from_above};
}

void measureShape(const PlacedObject& object, SimulatedObject& truth) {
  truth.centre = object.site_from_shape.translation();
  if (const auto* body = std::get_if<TurnedBody>(&object.shape)) {
    truth.axis = object.site_from_shape.linear().col(2);
    truth.length = body->profile.back().x() - body->profile.front().x();
    truth.radius = body->girth;
  } else {
    const Rock& rock = std::get<Rock>(object.shape);
    truth.axis = object.site_from_shape.linear().col(0);
    truth.length = 2.0 * rock.semi_axes.x();
    truth.radius = rock.semi_axes.y();
  }
}

SimulatedObject measure(const Scene& scene, std::size_t index, const Eigen::AlignedBox2d& footprint,
                        double faint) {
  const PlacedObject& object = scene.object(index);
  SimulatedObject truth;
  truth.segment = static_cast<std::int32_t>(index) + 1;
  measureShape(object, truth);
  const Eigen::AlignedBox2d box = scene.outlineBox(index);
  const Eigen::Vector2d cell = box.sizes() / kCells;
  double outline = 0.0;
  double seen = 0.0;
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const Eigen::Vector2d xy = box.min() + Eigen::Vector2d((i + 0.5) * cell.x(), (j + 0.5) * cell.y());
      const std::optional<Thickness> thickness = thicknessAt(object, xy);
      if (!thickness) continue;
      const double ground = scene.terrain().height(xy.x(), xy.y());
      truth.volume += cell.prod() * std::max(0.0, thickness->top - std::max(ground, thickness->bottom));
      if (thickness->top < ground + faint) continue;
      constexpr double kRounding = 1e-9;
      const bool is_highest = thickness->top >= scene.topHeight(xy.x(), xy.y()) - kRounding;
      outline += 1.0;
      if (is_highest && footprint.contains(xy)) seen += 1.0;
    }
  }
  truth.share_seen = outline > 0.0 ? seen / outline : 0.0;
  return truth;
}

}  // namespace

std::vector<SimulatedObject> objectTruth(const Scene& scene, const Eigen::AlignedBox2d& footprint,
                                         double faint) {
  std::vector<SimulatedObject> objects;
  for (std::size_t n = 0; n < scene.size(); ++n) objects.push_back(measure(scene, n, footprint, faint));
  return objects;
}

}  // namespace pcl_fft_ground::core
