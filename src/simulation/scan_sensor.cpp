#include "simulation/scan_sensor.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pcl_fft_ground::core {

namespace {

constexpr double kGapCell = 0.025;  // [m]

/// Half the width of the fan at the mean ground [m]: wide enough to reach ground and objects along both
/// sides.
double fanHalfWidth(const Scene& scene, const ScanGeometry& geometry) {
  constexpr double kObjects = 0.3;  // [m], usual height of objects over the highest ground at the border
  constexpr int kSteps = 40;
  const Eigen::Vector2d half = 0.5 * geometry.footprint;
  double highest = 0.0;
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (const double side : {-half.y(), half.y()}) {
      const Eigen::Vector3d at = geometry.site_from_track * Eigen::Vector3d(half.x() * i / kSteps, side, 0.0);
      highest = std::max(highest, scene.terrain().height(at.x(), at.y()) - at.z());
    }
  }
  const double clearance = std::max(geometry.altitude - highest - kObjects, 0.25 * geometry.altitude);
  return half.y() * geometry.altitude / clearance;
}

/// What one ray brings back, if anything.
class Scanner {
 public:
  Scanner(const Scene& scene, const ScanGeometry& geometry, const GapMask& gaps)
      : scene_(scene),
        geometry_(geometry),
        gaps_(gaps),
        track_from_site_(geometry.site_from_track.inverse()) {}

  /// \param along position of the laser; \param across where its ray meets the mean ground [m]
  std::optional<Sighting> look(double along, double across) {
    const Eigen::Vector3d laser(along, 0.0, geometry_.altitude);
    const Eigen::Vector3d towards(0.0, across, -geometry_.altitude);
    const Ray ray{geometry_.site_from_track * laser,
                  geometry_.site_from_track.linear() * towards.normalized()};
    const double guess = (last_ground_ - ray.origin.z()) / ray.direction.z();
    const Scene::Hit hit = scene_.firstHit(ray, guess);
    const Eigen::Vector3d position = ray.at(hit.range);
    if (hit.object < 0) last_ground_ = position.z();
    if (!isWanted(position) || !isSeen(position, along)) return std::nullopt;
    const double ground = hit.object < 0 ? position.z() : scene_.terrain().height(position.x(), position.y());
    return Sighting{position, ray.direction, ground, hit.object};
  }

 private:
  bool isWanted(const Eigen::Vector3d& position) const {
    const Eigen::Vector2d xy = (track_from_site_ * position).head<2>();
    return (2.0 * xy.cwiseAbs() - geometry_.footprint).maxCoeff() <= 0.0 && !gaps_.isGap(xy);
  }

  bool isSeen(const Eigen::Vector3d& position, double along) const {
    const Eigen::Vector3d camera =
        geometry_.site_from_track * Eigen::Vector3d(along - geometry_.baseline, 0.0, geometry_.altitude);
    return !scene_.isBlocked({position, (camera - position).normalized()});
  }

  const Scene& scene_;
  const ScanGeometry& geometry_;
  const GapMask& gaps_;
  Eigen::Isometry3d track_from_site_;
  double last_ground_ = 0.0;  ///< the next ray will meet the ground about there [m]
};

}  // namespace

GapMask::GapMask(const Eigen::Vector2d& footprint, double share, Random random)
    : corner_(-0.5 * footprint), count_((footprint.array() / kGapCell).round().cast<int>()) {
  Terrain field;
  field.roughness = fractalRoughness(0.5, 1.0, random);
  std::vector<double> depth(static_cast<std::size_t>(count_.prod()));
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const auto column = static_cast<double>(i % count_.x());
    const auto row = static_cast<double>(i / count_.x());
    depth[i] = field.height(column * kGapCell, row * kGapCell);
  }
  std::vector<std::size_t> order(depth.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto gaps = static_cast<std::size_t>(std::lround(share * static_cast<double>(depth.size())));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return depth[a] < depth[b]; });
  gap_.assign(depth.size(), 0);
  for (std::size_t i = 0; i < gaps; ++i) gap_[order[i]] = 1;
}

bool GapMask::isGap(const Eigen::Vector2d& track_xy) const {
  const Eigen::Array2d at = ((track_xy - corner_) / kGapCell).array().floor();
  const Eigen::Array2i cell = at.max(0.0).min((count_ - 1).cast<double>()).cast<int>();
  return gap_[cell.y() * count_.x() + cell.x()] != 0;
}

RayPattern rayPattern(const Scene& scene, const ScanGeometry& geometry, double rays) {
  const double width = 2.0 * fanHalfWidth(scene, geometry);
  const double spacing = std::sqrt(geometry.footprint.x() * width / rays);
  const auto count = [&](double extent) {
    return std::max(1, static_cast<int>(std::ceil(extent / spacing)));
  };
  return {count(geometry.footprint.x()), count(width)};
}

std::vector<Sighting> sense(const Scene& scene, const ScanGeometry& geometry, const RayPattern& pattern,
                            const GapMask& gaps, Random random) {
  const double half_width = fanHalfWidth(scene, geometry);
  const double length = geometry.footprint.x();
  Scanner scanner(scene, geometry, gaps);
  std::vector<Sighting> sightings;
  sightings.reserve(static_cast<std::size_t>(pattern.profiles) * pattern.samples);
  for (int profile = 0; profile < pattern.profiles; ++profile) {
    // A vehicle does not move quite evenly, nor do samples fall on a lattice: both are spread over their
    // steps.
    const double along = length * ((profile + random.uniform(0.0, 1.0)) / pattern.profiles - 0.5);
    for (int sample = 0; sample < pattern.samples; ++sample) {
      const double across = half_width * (2.0 * (sample + random.uniform(0.0, 1.0)) / pattern.samples - 1.0);
      const std::optional<Sighting> sighting = scanner.look(along, across);
      if (sighting) sightings.push_back(*sighting);
    }
  }
  return sightings;
}

}  // namespace pcl_fft_ground::core
