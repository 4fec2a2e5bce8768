#include "simulation/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_fft_ground::core {

namespace {

constexpr double kBin = 0.2;     // [m], about the width of an object
constexpr double kMargin = 2.0;  // [m] of bins around the extent, for objects that reach beyond it

/// The stretch of a ray inside a box, as (first, last) range; empty where last < first.
Eigen::Vector2d stretchInside(const Eigen::AlignedBox3d& box, const Ray& ray) {
  double first = 0.0;
  double last = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double d = ray.direction[axis];
    const double to_low = box.min()[axis] - ray.origin[axis];
    const double to_high = box.max()[axis] - ray.origin[axis];
    if (d == 0.0) {
      if (to_low > 0.0 || to_high < 0.0) return {0.0, -1.0};
      continue;
    }
    first = std::max(first, std::min(to_low / d, to_high / d));
    last = std::min(last, std::max(to_low / d, to_high / d));
  }
  return {first, last};
}

Eigen::AlignedBox3d turnedBox(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& target_from_source) {
  const Eigen::Vector3d half = target_from_source.linear().cwiseAbs() * (0.5 * box.sizes());
  const Eigen::Vector3d centre = target_from_source * box.center();
  return {centre - half, centre + half};
}

/// Walks the squares of a grid under a line, one after the other (Amanatides and Woo 1987).
class GridWalk {
 public:
  GridWalk(const Eigen::Vector2d& start, const Eigen::Vector2d& direction, const Eigen::Array2i& square) {
    for (int axis = 0; axis < 2; ++axis) {
      const double d = direction[axis];
      step_[axis] = d > 0.0 ? 1 : -1;
      const double edge = square[axis] + (d > 0.0 ? 1.0 : 0.0);
      per_square_[axis] = d == 0.0 ? std::numeric_limits<double>::infinity() : 1.0 / std::abs(d);
      next_[axis] = d == 0.0 ? per_square_[axis] : (edge - start[axis]) / d;
    }
  }
  double leaves() const { return next_.minCoeff(); }
  void advance(Eigen::Array2i& square) {
    const int axis = next_[0] < next_[1] ? 0 : 1;
    square[axis] += step_[axis];
    next_[axis] += per_square_[axis];
  }

 private:
  Eigen::Array2i step_;
  Eigen::Array2d per_square_;
  Eigen::Array2d next_;
};

}  // namespace

Scene::Scene(Terrain terrain, const Eigen::AlignedBox2d& extent)
    : terrain_(std::move(terrain)),
      extent_(extent),
      bins_origin_(extent.min() - Eigen::Vector2d::Constant(kMargin)),
      bin_count_(((extent.sizes().array() + 2.0 * kMargin) / kBin).ceil().cast<int>() + 1),
      bins_(static_cast<std::size_t>(bin_count_.prod())) {}

Eigen::Array2i Scene::binOf(const Eigen::Vector2d& xy) const {
  const Eigen::Array2d at = ((xy - bins_origin_) / kBin).array().floor();
  return at.max(0.0).min((bin_count_ - 1).cast<double>()).cast<int>();
}

void Scene::add(const PlacedObject& object) {
  const int index = static_cast<int>(objects_.size());
  const Eigen::AlignedBox3d tight_box = bounds(object.shape);
  const Eigen::AlignedBox3d box = turnedBox(tight_box, object.site_from_shape);
  objects_.push_back({object, object.site_from_shape.inverse(), tight_box, box});
  reach_.extend(box);
  const Eigen::Array2i first = binOf(box.min().head<2>());
  const Eigen::Array2i last = binOf(box.max().head<2>());
  for (int row = first.y(); row <= last.y(); ++row) {
    for (int column = first.x(); column <= last.x(); ++column) {
      bins_[row * bin_count_.x() + column].push_back(index);
    }
  }
}

Scene Scene::withFirst(std::size_t count) const {
  Scene fewer(terrain_, extent_);
  for (std::size_t i = 0; i < std::min(count, objects_.size()); ++i) fewer.add(objects_[i].object);
  return fewer;
}

void Scene::testBin(const std::vector<int>& bin, const Ray& ray, Span span, double nearest,
                    std::optional<Hit>& best) const {
  for (const int index : bin) {
    const Stored& stored = objects_[index];
    const Eigen::Vector2d inside = stretchInside(stored.box, ray);
    // An object lies in several bins: it is tested where the ray enters its box.
    if (inside[1] < inside[0] || inside[0] <= span.from || inside[0] > span.to) continue;
    if (best && inside[0] > best->range) continue;
    const Ray local{stored.shape_from_site * ray.origin, stored.shape_from_site.linear() * ray.direction};
    const Eigen::Vector2d tight = stretchInside(stored.tight_box, local);
    if (tight[1] < tight[0]) continue;
    const std::optional<double> range = pcl_fft_ground::core::firstHit(stored.object.shape, local, nearest);
    if (range && (!best || *range < best->range)) best = Hit{*range, index};
  }
}

std::optional<Scene::Hit> Scene::firstObject(const Ray& ray, double nearest) const {
  std::optional<Hit> best;
  if (objects_.empty()) return best;
  const Eigen::Vector2d inside = stretchInside(reach_, ray);
  if (inside[1] < inside[0]) return best;

  const Eigen::Vector2d start = (ray.at(inside[0]).head<2>() - bins_origin_) / kBin;
  Eigen::Array2i square = binOf(ray.at(inside[0]).head<2>());
  GridWalk walk(start, ray.direction.head<2>() / kBin, square);
  double from = -1.0;
  while ((square >= 0).all() && (square < bin_count_).all()) {
    const double to = inside[0] + walk.leaves();
    testBin(bin(square), ray, {from, to}, nearest, best);
    if (to > inside[1] || (best && best->range <= to)) break;
    walk.advance(square);
    from = to;
  }
  return best;
}

Scene::Hit Scene::firstHit(const Ray& ray, double guess) const {
  const std::optional<Hit> object = firstObject(ray, 0.0);
  if (object) {
    const Eigen::Vector3d at = ray.at(object->range);
    if (at.z() > terrain_.height(at.x(), at.y())) return *object;
  }
  return {groundRange(terrain_, ray, guess), -1};
}

double Scene::topHeight(double x, double y) const {
  const double above = reach_.isEmpty() ? 0.0 : reach_.max().z();
  const double ground = terrain_.height(x, y);
  const double start = std::max(above, ground) + 1.0;
  const std::optional<Hit> object = firstObject({{x, y, start}, {0.0, 0.0, -1.0}}, 0.0);
  return object ? std::max(ground, start - object->range) : ground;
}

}  // namespace pcl_fft_ground::core
