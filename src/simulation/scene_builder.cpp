#include "simulation/scene_builder.h"

#include <algorithm>
#include <cmath>

namespace pcl_fft_ground::core {

namespace {

constexpr double kTwoPi = 6.28318530717958647692;

Eigen::Vector2d randomSlope(double steepest, Random& random) {
  const double steepness = random.uniform(0.0, steepest);
  const double direction = random.uniform(0.0, kTwoPi);
  return steepness * Eigen::Vector2d(std::cos(direction), std::sin(direction));
}

Mound randomMound(const Eigen::AlignedBox2d& extent, Random& random) {
  const double x = random.uniform(-0.12, 0.12) * extent.sizes().x();
  const double y = random.uniform(-0.12, 0.12) * extent.sizes().y();
  const double length = random.uniform(0.8, 1.2);
  const double width = random.uniform(0.6, 0.9);
  const double turn = random.uniform(0.0, kTwoPi);
  const double height = random.uniform(0.25, 0.4);
  const Eigen::Matrix2d along = Eigen::Rotation2Dd(turn).toRotationMatrix();
  const Eigen::Vector2d scale(1.0 / length, 1.0 / width);
  return {extent.center() + Eigen::Vector2d(x, y), scale.asDiagonal() * along, height};
}

void addWreckGround(const Eigen::AlignedBox2d& extent, Random& random, Terrain& terrain) {
  terrain.slope = randomSlope(0.08, random);
  // One mound for each 16 square metres: the size of a scan.
  const int mounds = std::max(1, static_cast<int>(std::lround(extent.volume() / 16.0)));
  for (int i = 0; i < mounds; ++i) {
    Mound mound = randomMound(extent, random);
    if (mounds > 1) {
      const double x = random.uniform(extent.min().x(), extent.max().x());
      const double y = random.uniform(extent.min().y(), extent.max().y());
      mound.centre = {x, y};
    }
    terrain.mounds.push_back(mound);
  }
  for (const double wavelength : {2.5, 4.0, 6.0}) {
    terrain.waves.push_back(randomWave(wavelength, 0.006 * wavelength, random));
  }
  terrain.roughness = fractalRoughness(1.0, 0.03, random);
}

void addPipesGround(Random& random, Terrain& terrain) {
  terrain.slope = randomSlope(0.04, random);
  const double rolling = random.uniform(0.002, 0.012);  // amplitude over wavelength: flat to gently rolling
  for (const double wavelength : {2.0, 3.0, 5.0}) {
    terrain.waves.push_back(randomWave(wavelength, rolling * wavelength, random));
  }
  terrain.roughness = fractalRoughness(0.8, 0.015, random);
}

/// Highest minus lowest height on a fine grid [m].
double relief(const Terrain& terrain, const Eigen::AlignedBox2d& extent) {
  constexpr double kStep = 0.05;
  double lowest = terrain.height(extent.min().x(), extent.min().y());
  double highest = lowest;
  for (double x = extent.min().x(); x <= extent.max().x(); x += kStep) {
    for (double y = extent.min().y(); y <= extent.max().y(); y += kStep) {
      const double z = terrain.height(x, y);
      lowest = std::min(lowest, z);
      highest = std::max(highest, z);
    }
  }
  return highest - lowest;
}

void addReefGround(const Eigen::AlignedBox2d& extent, Random& random, Terrain& terrain) {
  for (const double wavelength : {0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0}) {
    terrain.waves.push_back(randomWave(wavelength, 0.01 * wavelength, random));
  }
  const double wanted = random.uniform(0.1, 0.3);
  const double scale = wanted / relief(terrain, extent);
  for (Wave& wave : terrain.waves) wave.amplitude *= scale;
  terrain.roughness = fractalRoughness(0.5, 0.01, random);
}

/// Sea floor that is nothing but relief, a metre of it: four standard deviations.
void addBareGround(Random& random, Terrain& terrain) {
  constexpr int kWaves = 48;
  constexpr double kShortest = 3.0;
  constexpr double kLongest = 30.0;
  constexpr double kDeviation = 0.25;
  double squares = 0.0;
  for (int i = 0; i < kWaves; ++i) {
    const double wavelength = kShortest * std::pow(kLongest / kShortest, random.uniform(0.0, 1.0));
    terrain.waves.push_back(randomWave(wavelength, wavelength, random));
    squares += 0.5 * wavelength * wavelength;
  }
  for (Wave& wave : terrain.waves) wave.amplitude *= kDeviation / std::sqrt(squares);
}

double meanHeight(const Terrain& terrain, const Eigen::AlignedBox2d& extent) {
  constexpr int kSteps = 64;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const Eigen::Array2d share((i + 0.5) / kSteps, (j + 0.5) / kSteps);
      const Eigen::Array2d at = extent.min().array() + share * extent.sizes().array();
      sum += terrain.height(at.x(), at.y());
    }
  }
  return sum / (kSteps * kSteps);
}

/// Share of object points that a coarse scan sees.
double seenShare(const Scene& scene, const ScanGeometry& geometry, double faint, std::uint32_t seed) {
  constexpr double kRaysPerSquareMetre = 400.0;
  const double rays = std::max(6000.0, kRaysPerSquareMetre * geometry.footprint.prod());
  const GapMask no_gaps(geometry.footprint, 0.0, Random(seed, RandomStream::GAPS));
  const auto sightings = sense(scene, geometry, rayPattern(scene, geometry, rays), no_gaps,
                               Random(seed, RandomStream::SURVEYING));
  double objects = 0.0;
  double ground = 0.0;
  for (const Sighting& s : sightings) {
    if (s.object < 0) ground += 1.0;
    if (s.object >= 0 && s.position.z() - s.ground >= faint) objects += 1.0;
  }
  return objects / std::max(1.0, objects + ground);
}

}  // namespace

Eigen::Vector2d footprintOf(SceneKind kind) {
  if (kind == SceneKind::BARE) return {20.0, 20.0};
  return kind == SceneKind::PIPES ? Eigen::Vector2d(6.0, 1.5) : Eigen::Vector2d(4.0, 4.0);
}

Terrain makeTerrain(SceneKind kind, const Eigen::AlignedBox2d& extent, std::uint32_t seed) {
  Random random(seed, RandomStream::TERRAIN);
  Terrain terrain;
  switch (kind) {
    case SceneKind::WRECK:
      addWreckGround(extent, random, terrain);
      break;
    case SceneKind::PIPES:
      addPipesGround(random, terrain);
      break;
    case SceneKind::REEF:
      addReefGround(extent, random, terrain);
      break;
    case SceneKind::BARE:
      addBareGround(random, terrain);
      break;
  }
  terrain.level = -meanHeight(terrain, extent);
  return terrain;
}

Scene strewObjects(const Scene& site, SceneKind kind, const ScanGeometry& geometry, double share,
                   double faint, std::uint32_t seed) {
  constexpr std::size_t kMostObjects = 20000;
  if (share <= 0.0) return site;
  const auto seen = [&](std::size_t count, const Scene& from) {
    return seenShare(from.withFirst(count), geometry, faint, seed);
  };
  Random random(seed, RandomStream::OBJECTS);
  Scene scene = site;
  std::size_t too_few = 0;
  do {
    too_few = scene.size();
    const std::size_t more = std::max<std::size_t>(8, scene.size() / 3);
    for (std::size_t i = 0; i < more; ++i) scene.add(placeObject(kind, scene, random));
  } while (seenShare(scene, geometry, faint, seed) < share && scene.size() < kMostObjects);

  // The share grows with the number of objects, apart from single ones: halve the last step until it is
  // found.
  std::size_t enough = scene.size();
  while (enough - too_few > 1) {
    const std::size_t middle = (enough + too_few) / 2;
    (seen(middle, scene) < share ? too_few : enough) = middle;
  }
  const bool fewer_is_closer = share - seen(too_few, scene) < seen(enough, scene) - share;
  return scene.withFirst(fewer_is_closer ? too_few : enough);
}

}  // namespace pcl_fft_ground::core
