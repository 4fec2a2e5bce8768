#pragma once

#include <optional>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "simulation/scene_terrain.h"
#include "simulation/simulation_random.h"

namespace pcl_fft_ground::core {

/// A cylinder with rounded ends, from \c start to \c end.
struct Capsule {
  Eigen::Vector3d start;
  Eigen::Vector3d end;
  double radius;  ///< [m]
};

/// A bent rod, and a ball that holds it: most rays miss that.
struct Handle {
  std::vector<Capsule> parts;
  Eigen::Vector3d centre;
  double reach;  ///< [m]
};

/// A body of revolution about its z axis, perhaps with handles: amphora or pipe.
struct TurnedBody {
  std::vector<Eigen::Vector2d> profile;  ///< (z, radius) [m], z never falling; straight between the points
  double girth;                          ///< largest radius of the profile [m]
  std::vector<Handle> handles;
};

/// An ellipsoid about its origin with pieces chipped off: a boulder.
struct Rock {
  Eigen::Vector3d semi_axes;  ///< [m]
  std::vector<Eigen::Hyperplane<double, 3>>
      cuts;  ///< in coordinates over \c semi_axes; rock where not positive
};

using Shape = std::variant<TurnedBody, Rock>;

/// Least range above \c nearest [m] at which a ray, given in the shape's frame, meets the shape.
std::optional<double> firstHit(const Shape& shape, const Ray& ray, double nearest);

/// A box that holds the shape, in its own frame.
Eigen::AlignedBox3d bounds(const Shape& shape);

/// An amphora with its middle at the origin and its mouth towards +z; \c length [m].
TurnedBody makeAmphora(double length, Random& random);

/// A pipe segment, closed at its ends by sediment, with a socket or not, its middle at the origin; lengths in
/// metres.
TurnedBody makePipe(double length, double radius, bool socket);

/// A boulder; \c size is its largest extent [m].
Rock makeRock(double size, Random& random);

}  // namespace pcl_fft_ground::core
