#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "simulation/scene_shapes.h"
#include "simulation/scene_terrain.h"

namespace pcl_fft_ground::core {

/// A shape and where it lies on the site.
struct PlacedObject {
  Shape shape;
  Eigen::Isometry3d site_from_shape;
};

/** \brief A site: ground, and objects on it. It knows nothing of scanners, tracks or poses.
 *
 * Objects are found by a horizontal grid of bins, so that a ray tests only those it passes over.
 */
class Scene {
 public:
  /// \param extent the horizontal rectangle to be scanned [m]; objects may reach beyond it
  Scene(Terrain terrain, const Eigen::AlignedBox2d& extent);

  void add(const PlacedObject& object);

  const Terrain& terrain() const { return terrain_; }
  const Eigen::AlignedBox2d& extent() const { return extent_; }
  std::size_t size() const { return objects_.size(); }
  const PlacedObject& object(std::size_t index) const { return objects_[index].object; }
  /// A horizontal box that holds an object [m].
  Eigen::AlignedBox2d outlineBox(std::size_t index) const {
    const Eigen::AlignedBox3d& box = objects_[index].box;
    return {box.min().head<2>(), box.max().head<2>()};
  }
  /// Where the origin of an object lies, seen from above [m].
  Eigen::Vector2d position(std::size_t index) const {
    return objects_[index].object.site_from_shape.translation().head<2>();
  }

  /// The same site with the first \c count objects only.
  Scene withFirst(std::size_t count) const;

  struct Hit {
    double range;  ///< along the ray [m]
    int object;    ///< index from 0; -1: the ground
  };
  /// First surface that a falling ray meets. \param guess roughly the range of the ground [m]
  Hit firstHit(const Ray& ray, double guess) const;

  /// True where an object stands in the way, farther than a millimetre from the origin.
  bool isBlocked(const Ray& ray) const { return firstObject(ray, 0.001).has_value(); }

  /// Height of the highest surface at a place, objects included [m].
  double topHeight(double x, double y) const;

 private:
  struct Stored {
    PlacedObject object;
    Eigen::Isometry3d shape_from_site;
    Eigen::AlignedBox3d tight_box;  ///< in the shape's frame
    Eigen::AlignedBox3d box;        ///< in the site's frame
  };

  std::optional<Hit> firstObject(const Ray& ray, double nearest) const;
  /// What a ray can meet while it is over one bin.
  struct Span {
    double from;
    double to;
  };
  void testBin(const std::vector<int>& bin, const Ray& ray, Span span, double nearest,
               std::optional<Hit>& best) const;
  Eigen::Array2i binOf(const Eigen::Vector2d& xy) const;
  const std::vector<int>& bin(const Eigen::Array2i& at) const {
    return bins_[at.y() * bin_count_.x() + at.x()];
  }

  Terrain terrain_;
  Eigen::AlignedBox2d extent_;
  Eigen::AlignedBox3d reach_;  ///< holds all objects
  Eigen::Vector2d bins_origin_;
  Eigen::Array2i bin_count_;
  std::vector<std::vector<int>> bins_;
  std::vector<Stored> objects_;
};

}  // namespace pcl_fft_ground::core
