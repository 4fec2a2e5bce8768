#include "pcl_fft_ground/core/simulation.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "scan_sensor.h"
#include "scene_builder.h"
#include "simulation_random.h"

namespace pcl_fft_ground::core {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

void require(bool valid, const char* name, double value, const char* allowed) {
  if (valid) return;
  std::ostringstream message;
  message << name << " = " << value << ": allowed is " << allowed;
  throw std::invalid_argument(message.str());
}

void requireWithin(const char* name, double value, double low, double high, const char* allowed) {
  require(value >= low && value <= high, name, value, allowed);  // false for NaN too
}

void validate(const SimulationParameters& p) {
  const bool known = p.scene == SceneKind::WRECK || p.scene == SceneKind::PIPES || p.scene == SceneKind::REEF;
  require(known, "scene", static_cast<double>(p.scene), "WRECK, PIPES or REEF");
  require(p.points >= 1 && p.points <= 100000000, "points", static_cast<double>(p.points), "1 to 100000000");
  requireWithin("object_share", p.object_share, 0.0, 0.8, "0 to 0.8");
  requireWithin("noise", p.noise, 0.0, 0.1, "0 to 0.1 m");
  requireWithin("gap_share", p.gap_share, 0.0, 0.9, "0 to 0.9");
  requireWithin("outlier_share", p.outlier_share, 0.0, 0.5, "0 to 0.5");
  requireWithin("tilt_degrees", p.tilt_degrees, -45.0, 45.0, "-45 to 45 degrees");
  requireWithin("altitude", p.altitude, 2.0, 20.0, "2 to 20 m");
  requireWithin("baseline", p.baseline, 0.0, 2.0, "0 to 2 m");
}

ScanGeometry geometryOf(const SimulationParameters& parameters) {
  ScanGeometry geometry;
  geometry.footprint = footprintOf(parameters.scene);
  geometry.altitude = parameters.altitude;
  geometry.baseline = parameters.baseline;
  return geometry;
}

/// Height over the ground from which a point of an object counts as object [m].
double faintHeight(const SimulationParameters& parameters) {
  return 4.0 * parameters.noise;
}

Scene makeScene(const SimulationParameters& parameters, const ScanGeometry& geometry) {
  const Eigen::AlignedBox2d extent(-0.5 * geometry.footprint, 0.5 * geometry.footprint);
  const Scene site(makeTerrain(parameters.scene, extent, parameters.seed), extent);
  return strewObjects(site, parameters.scene, geometry, parameters.object_share, faintHeight(parameters),
                      parameters.seed);
}

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

/// Exactly as many points as asked for: the rays are made dense enough, and the surplus is dropped at random.
std::vector<Sighting> senseExactly(std::size_t count, const Scene& scene, const ScanGeometry& geometry,
                                   const SimulationParameters& parameters) {
  const GapMask gaps(geometry.footprint, parameters.gap_share, Random(parameters.seed, RandomStream::GAPS));
  const Random random(parameters.seed, RandomStream::RAYS);
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
      return randomSubset(sightings, count, Random(parameters.seed, RandomStream::SELECTION));
    }
    rays *= wanted / std::max<double>(1.0, static_cast<double>(sightings.size()));
  }
}

/// For each point how far it is thrown off along z [m]; zero for all but the outliers.
std::vector<double> outlierOffsets(const SimulationParameters& parameters) {
  constexpr double kLeast = 0.1;
  constexpr double kMost = 10.0;
  Random random(parameters.seed, RandomStream::OUTLIERS);
  std::vector<double> offsets(parameters.points, 0.0);
  auto left = static_cast<std::size_t>(
      std::llround(parameters.outlier_share * static_cast<double>(parameters.points)));
  for (std::size_t i = 0; i < offsets.size() && left > 0; ++i) {
    if (!random.chance(static_cast<double>(left) / static_cast<double>(offsets.size() - i))) continue;
    const double size = random.uniform(kLeast, kMost);
    offsets[i] = random.chance(0.5) ? size : -size;
    --left;
  }
  return offsets;
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

SimulatedScan measure(const std::vector<Sighting>& sightings, const Terrain& terrain,
                      const SimulationParameters& parameters) {
  SimulatedScan scan = emptyScan(sightings.size());
  scan.world_from_scan.linear() =
      Eigen::AngleAxisd(parameters.tilt_degrees * kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Eigen::Isometry3d scan_from_world = scan.world_from_scan.inverse();
  const std::vector<double> offsets = outlierOffsets(parameters);
  Random noise(parameters.seed, RandomStream::NOISE);
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const Sighting& sighting = sightings[i];
    const bool outlier = offsets[i] != 0.0;
    const Eigen::Vector3d measured = sighting.position + noise.normal(parameters.noise) * sighting.direction;
    const Eigen::Vector3d point = scan_from_world * (measured + offsets[i] * Eigen::Vector3d::UnitZ());
    const double guess = sighting.position.z() - sighting.ground + offsets[i];
    scan.points.col(static_cast<Eigen::Index>(i)) = point.cast<float>();
    scan.ground_heights[i] = static_cast<float>(groundHeight(terrain, scan.world_from_scan, point, guess));
    scan.labels[i] = outlier ? 2 : labelOf(sighting, faintHeight(parameters));
    scan.segments[i] = outlier ? 0 : sighting.object + 1;
  }
  return scan;
}

}  // namespace

SimulatedScan simulateScan(const SimulationParameters& parameters) {
  validate(parameters);
  const ScanGeometry geometry = geometryOf(parameters);
  const Scene scene = makeScene(parameters, geometry);
  const std::vector<Sighting> sightings = senseExactly(parameters.points, scene, geometry, parameters);
  return measure(sightings, scene.terrain(), parameters);
}

}  // namespace pcl_fft_ground::core
