#include <algorithm>
#include <array>
#include <cmath>

#include "simulation/scene_shapes.h"

namespace pcl_fft_ground::core {

namespace {

/// Outline of an amphora of length 1 from toe to lip: (height, radius), after the common Dressel 1 type.
const std::vector<Eigen::Vector2d>& amphoraOutline() {
  static const std::vector<Eigen::Vector2d> outline = {
      {0.00, 0.000}, {0.00, 0.028}, {0.07, 0.032}, {0.11, 0.045}, {0.17, 0.080}, {0.24, 0.115},
      {0.32, 0.143}, {0.40, 0.160}, {0.48, 0.168}, {0.54, 0.168}, {0.59, 0.158}, {0.63, 0.135},
      {0.66, 0.105}, {0.69, 0.075}, {0.72, 0.060}, {0.80, 0.052}, {0.92, 0.052}, {0.93, 0.068},
      {0.99, 0.072}, {1.00, 0.066}, {1.00, 0.000}};
  return outline;
}

/// A handle from the shoulder up to the neck, on the side of \c side = +-1.
Handle makeHandle(double length, double girth, double side) {
  const std::array<Eigen::Vector2d, 5> path = {Eigen::Vector2d(0.62, 0.125 * girth),
                                               Eigen::Vector2d(0.72, 0.132), Eigen::Vector2d(0.84, 0.130),
                                               Eigen::Vector2d(0.89, 0.110), Eigen::Vector2d(0.90, 0.050)};
  const double radius = 0.017 * length;
  const auto place = [&](const Eigen::Vector2d& p) {
    return Eigen::Vector3d(side * p.y() * length, 0.0, (p.x() - 0.5) * length);
  };
  Handle handle;
  handle.centre = 0.5 * (place(path.front()) + place(path.back()));
  handle.reach = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    handle.parts.push_back({place(path[i - 1]), place(path[i]), radius});
  }
  for (const Eigen::Vector2d& point : path) {
    handle.reach = std::max(handle.reach, (place(point) - handle.centre).norm() + radius);
  }
  return handle;
}

double largestRadius(const std::vector<Eigen::Vector2d>& profile) {
  double largest = 0.0;
  for (const Eigen::Vector2d& point : profile) largest = std::max(largest, point.y());
  return largest;
}

Eigen::Vector3d randomDirection(Random& random) {
  constexpr double kTwoPi = 6.28318530717958647692;
  const double z = random.uniform(-1.0, 1.0);
  const double angle = random.uniform(0.0, kTwoPi);
  const double across = std::sqrt(1.0 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
}

}  // namespace

TurnedBody makeAmphora(double length, Random& random) {
  const double girth = random.uniform(0.85, 1.25);
  TurnedBody amphora;
  for (const Eigen::Vector2d& point : amphoraOutline()) {
    const bool belly = point.x() > 0.1 && point.x() < 0.7;
    amphora.profile.emplace_back((point.x() - 0.5) * length, point.y() * length * (belly ? girth : 1.0));
  }
  amphora.girth = largestRadius(amphora.profile);
  amphora.handles = {makeHandle(length, girth, 1.0), makeHandle(length, girth, -1.0)};
  return amphora;
}

TurnedBody makePipe(double length, double radius, bool socket) {
  const double end = 0.5 * length;
  TurnedBody pipe;
  pipe.profile = {{-end, 0.0}, {-end, radius}};
  if (socket) {
    const double start = end - 1.2 * radius;
    pipe.profile.insert(pipe.profile.end(), {{start, radius}, {start, 1.25 * radius}, {end, 1.25 * radius}});
  } else {
    pipe.profile.emplace_back(end, radius);
  }
  pipe.profile.emplace_back(end, 0.0);
  pipe.girth = largestRadius(pipe.profile);
  return pipe;
}

Rock makeRock(double size, Random& random) {
  const double middle = random.uniform(0.65, 1.0);
  const double least = random.uniform(0.5, 0.85);
  Rock rock;
  rock.semi_axes = 0.5 * size * Eigen::Vector3d(1.0, middle, least * middle);
  constexpr int kCuts = 9;
  for (int i = 0; i < kCuts; ++i) {
    const Eigen::Vector3d normal = randomDirection(random);
    const double depth = random.uniform(0.7, 0.98);
    rock.cuts.emplace_back(normal, -depth);
  }
  return rock;
}

}  // namespace pcl_fft_ground::core
