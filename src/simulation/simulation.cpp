#include "pcl_fft_ground/simulation/simulation.h"

#include <cmath>
#include <vector>

#include "scan/parameter_check.h"
#include "simulation/scan_measurement.h"
#include "simulation/scan_sensor.h"
#include "simulation/scene_builder.h"
#include "simulation/simulation_random.h"

namespace pcl_fft_ground::core {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

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

Scene makeScene(const SimulationParameters& parameters, const ScanGeometry& geometry) {
  const Eigen::AlignedBox2d extent(-0.5 * geometry.footprint, 0.5 * geometry.footprint);
  const Scene site(makeTerrain(parameters.scene, extent, parameters.seed), extent);
  return strewObjects(site, parameters.scene, geometry, parameters.object_share,
                      faintHeight(parameters.noise), parameters.seed);
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

Eigen::Isometry3d tiltedFrame(double degrees) {
  return Eigen::Isometry3d(Eigen::AngleAxisd(degrees * kDegree, Eigen::Vector3d::UnitX()));
}

}  // namespace

SimulatedScan simulateScan(const SimulationParameters& parameters) {
  validate(parameters);
  const ScanGeometry geometry = geometryOf(parameters);
  const Scene scene = makeScene(parameters, geometry);
  const GapMask gaps(geometry.footprint, parameters.gap_share, Random(parameters.seed, RandomStream::GAPS));
  const std::vector<Sighting> sightings =
      senseExactly(parameters.points, scene, geometry, gaps, parameters.seed);
  return measure(
      sightings, scene.terrain(),
      {tiltedFrame(parameters.tilt_degrees), parameters.noise, parameters.seed, outlierOffsets(parameters)});
}

std::vector<SimulatedObject> simulatedObjects(const SimulationParameters& parameters) {
  validate(parameters);
  const ScanGeometry geometry = geometryOf(parameters);
  const Scene scene = makeScene(parameters, geometry);
  std::vector<SimulatedObject> objects = objectTruth(scene, scene.extent(), faintHeight(parameters.noise));
  const Eigen::Isometry3d scan_from_site = tiltedFrame(parameters.tilt_degrees).inverse();
  for (SimulatedObject& object : objects) {
    object.centre = scan_from_site * object.centre;
    object.axis = scan_from_site.linear() * object.axis;
  }
  return objects;
}

}  // namespace pcl_fft_ground::core
