#include "simulation/scan_measurement.h"

#include <algorithm>

namespace pcl_fft_ground::core {

namespace {

/// Keeps \c count of the items, each choice equally likely, in their order (Knuth, algorithm S).
template <typename T>
std::vector<T> randomSubset(const std::vector<T>& items, std::size_t count, Random random) {
  std::vector<T> kept;
  kept.reserve(count);
  for (std::size_t i = 0; i < items.size() && kept.size() < count; ++i) {
    const auto wanted = static_cast<double>(count - kept.size());
    if (random.chance(wanted / static_cast<double>(items.size() - i))) kept.push_back(items[i]);
  }
  return kept;
}

std::int32_t labelOf(const Sighting& sighting, double faint) {
  if (sighting.object < 0) return 0;
  return sighting.position.z() - sighting.ground >= faint ? 1 : 2;
}

/// z of the true ground in the scan's frame, at a point's x and y in that frame.
double groundHeight(const Terrain& terrain, const Eigen::Isometry3d& world_from_scan,
                    const Eigen::Vector3d& point, double guess) {
  const Ray down{world_from_scan * point, -world_from_scan.linear().col(2)};
  return point.z() - groundRange(terrain, down, guess);
}

SimulatedScan emptyScan(std::size_t points) {
  SimulatedScan scan;
  scan.points.resize(3, static_cast<Eigen::Index>(points));
  scan.labels.resize(points);
  scan.segments.resize(points);
  scan.ground_heights.resize(points);
  return scan;
}

}  // namespace

double faintHeight(double noise) {
  return 4.0 * noise;
}

std::vector<Sighting> senseExactly(std::size_t count, const Scene& scene, const ScanGeometry& geometry,
                                   const GapMask& gaps, std::uint32_t seed) {
  const Random random(seed, RandomStream::RAYS);
  const auto look = [&](double rays) {
    return sense(scene, geometry, rayPattern(scene, geometry, rays), gaps, random);
  };
  constexpr double kTrial = 5000.0;
  constexpr double kReserve = 1.01;
  constexpr double kFew = 50.0;
  const auto wanted = static_cast<double>(count);
  double rays = kTrial * wanted / std::max<double>(1.0, static_cast<double>(look(kTrial).size()));
  while (true) {
    rays = kReserve * rays + kFew;
    const std::vector<Sighting> sightings = look(rays);
    if (sightings.size() >= count) {
      return randomSubset(sightings, count, Random(seed, RandomStream::SELECTION));
    }
    rays *= wanted / std::max<double>(1.0, static_cast<double>(sightings.size()));
  }
}

SimulatedScan measure(const std::vector<Sighting>& sightings, const Terrain& terrain,
                      const Measurement& measurement) {
  SimulatedScan scan = emptyScan(sightings.size());
  scan.world_from_scan = measurement.site_from_scan;
  const Eigen::Isometry3d scan_from_world = scan.world_from_scan.inverse();
  const double faint = faintHeight(measurement.noise);
  Random noise(measurement.seed, RandomStream::NOISE);
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const Sighting& sighting = sightings[i];
    const double offset = measurement.offsets.empty() ? 0.0 : measurement.offsets[i];
    const bool outlier = offset != 0.0;
    const Eigen::Vector3d measured = sighting.position + noise.normal(measurement.noise) * sighting.direction;
    const Eigen::Vector3d point = scan_from_world * (measured + offset * Eigen::Vector3d::UnitZ());
    const double guess = sighting.position.z() - sighting.ground + offset;
    scan.points.col(static_cast<Eigen::Index>(i)) = point.cast<float>();
    scan.ground_heights[i] = static_cast<float>(groundHeight(terrain, scan.world_from_scan, point, guess));
    scan.labels[i] = outlier ? 2 : labelOf(sighting, faint);
    scan.segments[i] = outlier ? 0 : sighting.object + 1;
  }
  return scan;
}

}  // namespace pcl_fft_ground::core
