#include "simulation/scene_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl_fft_ground::core {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Both solutions of a t^2 + 2 b t + c = 0 in rising order; none: both infinite.
std::array<double, 2> quadraticRoots(double a, double b, double c) {
  constexpr double kNearlyLinear = 1e-12;
  if (std::abs(a) < kNearlyLinear) return {b == 0.0 ? kNever : -0.5 * c / b, kNever};
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return {kNever, kNever};
  const double root = std::sqrt(discriminant);
  const double first = (-b - root) / a;
  const double second = (-b + root) / a;
  return {std::min(first, second), std::max(first, second)};
}

/// The flat ring between two points of a profile at the same z.
double ringHit(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Ray& ray, double nearest) {
  if (ray.direction.z() == 0.0) return kNever;
  const double range = (from.x() - ray.origin.z()) / ray.direction.z();
  const double radius = ray.at(range).head<2>().norm();
  const bool inside = radius >= std::min(from.y(), to.y()) && radius <= std::max(from.y(), to.y());
  return inside && range > nearest ? range : kNever;
}

/// The cone between two points of a profile: x^2 + y^2 = (r0 + k (z - z0))^2.
double coneHit(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Ray& ray, double nearest) {
  const double k = (to.y() - from.y()) / (to.x() - from.x());
  const Eigen::Vector3d& o = ray.origin;
  const Eigen::Vector3d& d = ray.direction;
  const double radius = from.y() + k * (o.z() - from.x());
  const double a = d.head<2>().squaredNorm() - k * k * d.z() * d.z();
  const double b = o.head<2>().dot(d.head<2>()) - k * d.z() * radius;
  const double c = o.head<2>().squaredNorm() - radius * radius;
  for (const double range : quadraticRoots(a, b, c)) {
    const double z = o.z() + range * d.z();
    if (range > nearest && range < kNever && z >= from.x() && z <= to.x()) return range;
  }
  return kNever;
}

double ballHit(const Eigen::Vector3d& centre, double radius, const Ray& ray, double nearest) {
  const Eigen::Vector3d o = ray.origin - centre;
  for (const double range : quadraticRoots(1.0, o.dot(ray.direction), o.squaredNorm() - radius * radius)) {
    if (range > nearest) return range;
  }
  return kNever;
}

double capsuleHit(const Capsule& capsule, const Ray& ray, double nearest) {
  const Eigen::Vector3d span = capsule.end - capsule.start;
  const double length = span.norm();
  const Eigen::Vector3d axis = span / length;
  const Eigen::Vector3d o = ray.origin - capsule.start;
  const double o_along = o.dot(axis);
  const double d_along = ray.direction.dot(axis);
  const Eigen::Vector3d o_across = o - o_along * axis;
  const Eigen::Vector3d d_across = ray.direction - d_along * axis;
  const double c = o_across.squaredNorm() - capsule.radius * capsule.radius;
  double best = std::min(ballHit(capsule.start, capsule.radius, ray, nearest),
                         ballHit(capsule.end, capsule.radius, ray, nearest));
  for (const double range : quadraticRoots(d_across.squaredNorm(), o_across.dot(d_across), c)) {
    const double along = o_along + range * d_along;
    if (range > nearest && along >= 0.0 && along <= length) best = std::min(best, range);
  }
  return best;
}

double handleHit(const Handle& handle, const Ray& ray, double nearest) {
  double best = kNever;
  const bool misses =
      ray.direction.cross(handle.centre - ray.origin).squaredNorm() > handle.reach * handle.reach;
  if (misses) return best;
  for (const Capsule& part : handle.parts) best = std::min(best, capsuleHit(part, ray, nearest));
  return best;
}

/// The profile, where the ray is within the cylinder around it: most of its parts lie elsewhere along the
/// axis.
double profileHit(const TurnedBody& body, const Ray& ray, double nearest) {
  constexpr double kRounding = 1e-6;
  const Eigen::Vector3d& o = ray.origin;
  const Eigen::Vector3d& d = ray.direction;
  const double a = d.head<2>().squaredNorm();
  const double c = o.head<2>().squaredNorm() - body.girth * body.girth;
  if (a == 0.0 && c > 0.0) return kNever;
  double low = body.profile.front().x();
  double high = body.profile.back().x();
  if (a > kRounding) {
    const std::array<double, 2> inside = quadraticRoots(a, o.head<2>().dot(d.head<2>()), c);
    if (inside[0] == kNever) return kNever;
    const double enters = o.z() + inside[0] * d.z();
    const double leaves = o.z() + inside[1] * d.z();
    low = std::min(enters, leaves) - kRounding;
    high = std::max(enters, leaves) + kRounding;
  }
  double best = kNever;
  for (std::size_t i = 1; i < body.profile.size(); ++i) {
    const Eigen::Vector2d& from = body.profile[i - 1];
    const Eigen::Vector2d& to = body.profile[i];
    if (to.x() < low || from.x() > high) continue;
    const bool flat = to.x() == from.x();
    best = std::min(best, flat ? ringHit(from, to, ray, nearest) : coneHit(from, to, ray, nearest));
  }
  return best;
}

double hit(const TurnedBody& body, const Ray& ray, double nearest) {
  double best = profileHit(body, ray, nearest);
  for (const Handle& handle : body.handles) best = std::min(best, handleHit(handle, ray, nearest));
  return best;
}

/// A rock is convex: the ray is inside from the last entry to the first exit.
double hit(const Rock& rock, const Ray& ray, double nearest) {
  const Eigen::Vector3d o = ray.origin.cwiseQuotient(rock.semi_axes);
  const Eigen::Vector3d d = ray.direction.cwiseQuotient(rock.semi_axes);
  const std::array<double, 2> sphere = quadraticRoots(d.squaredNorm(), o.dot(d), o.squaredNorm() - 1.0);
  double entry = sphere[0];
  double exit = sphere[1];
  for (const auto& cut : rock.cuts) {
    const double height = cut.signedDistance(o);
    const double rise = cut.normal().dot(d);
    if (rise == 0.0 && height > 0.0) return kNever;
    if (rise < 0.0) entry = std::max(entry, -height / rise);
    if (rise > 0.0) exit = std::min(exit, -height / rise);
  }
  if (!(entry < exit)) return kNever;
  if (entry > nearest) return entry;
  return exit > nearest ? exit : kNever;
}

Eigen::AlignedBox3d box(const TurnedBody& body) {
  Eigen::AlignedBox3d result;
  for (const Eigen::Vector2d& point : body.profile) {
    result.extend(Eigen::Vector3d(point.y(), point.y(), point.x()));
    result.extend(Eigen::Vector3d(-point.y(), -point.y(), point.x()));
  }
  for (const Handle& handle : body.handles) {
    result.extend(handle.centre - Eigen::Vector3d::Constant(handle.reach));
    result.extend(handle.centre + Eigen::Vector3d::Constant(handle.reach));
  }
  return result;
}

Eigen::AlignedBox3d box(const Rock& rock) {
  return {-rock.semi_axes, rock.semi_axes};
}

}  // namespace

std::optional<double> firstHit(const Shape& shape, const Ray& ray, double nearest) {
  const double range = std::visit([&](const auto& body) { return hit(body, ray, nearest); }, shape);
  return range < kNever ? std::optional<double>(range) : std::nullopt;
}

Eigen::AlignedBox3d bounds(const Shape& shape) {
  return std::visit([](const auto& body) { return box(body); }, shape);
}

}  // namespace pcl_fft_ground::core
