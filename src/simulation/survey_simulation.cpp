#include "pcl_fft_ground/simulation/survey_simulation.h"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "scan/parameter_check.h"
#include "simulation/scan_measurement.h"
#include "simulation/scene_builder.h"
#include "simulation/survey_plan.h"

namespace pcl_fft_ground::core {

namespace {

void validate(const SurveyParameters& p) {
  require(p.site != SceneKind::REEF && p.site <= SceneKind::BARE, "site", static_cast<double>(p.site),
          "WRECK, PIPES or BARE");
  require(p.points >= 1 && p.points <= 100000000, "points", static_cast<double>(p.points), "1 to 100000000");
  requireWithin("object_share", p.object_share, 0.0, 0.8, "0 to 0.8");
  require(p.site != SceneKind::BARE || p.object_share == 0.0, "object_share", p.object_share,
          "0 on a bare site");
  requireWithin("noise", p.noise, 0.0, 0.1, "0 to 0.1 m");
  requireWithin("navigation_error", p.navigation_error, 0.0, 5.0, "0 to 5 m");
  requireWithin("heading_error", p.heading_error, 0.0, 45.0, "0 to 45 degrees");
  requireWithin("drift", p.drift, 0.0, 1.0, "0 to 1 m");
  requireWithin("altitude", p.altitude, 2.0, 20.0, "2 to 20 m");
  requireWithin("baseline", p.baseline, 0.0, 2.0, "0 to 2 m");
}

Eigen::Isometry3d poseOf(const Eigen::Vector3d& translation, double heading) {
  return Eigen::Translation3d(translation) * Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ());
}

/// The middle of the site in one scan, by which the share of objects is judged: they lie everywhere alike.
ScanGeometry middleOf(const Eigen::AlignedBox2d& extent, double baseline) {
  ScanGeometry middle;
  middle.footprint = 0.5 * extent.sizes();
  middle.altitude = 2.0 * extent.sizes().maxCoeff();  // so that nothing hides behind anything
  middle.baseline = baseline;
  return middle;
}

/// Pipes lie on a bottom with stones, which make up a third of the objects.
Scene makeSite(const SurveyParameters& p, const Eigen::AlignedBox2d& extent) {
  constexpr std::uint32_t kStones = 0x51ed270bU;  // parts the seed of the stones from that of the pipes
  constexpr double kPipes = 2.0 / 3.0;
  const ScanGeometry middle = middleOf(extent, p.baseline);
  const double faint = faintHeight(p.noise);
  const Scene bare(makeTerrain(p.site, extent, p.seed), extent);
  if (p.site != SceneKind::PIPES) return strewObjects(bare, p.site, middle, p.object_share, faint, p.seed);
  const Scene pipes = strewObjects(bare, p.site, middle, kPipes * p.object_share, faint, p.seed);
  return strewObjects(pipes, SceneKind::REEF, middle, p.object_share, faint, p.seed ^ kStones);
}

/// Mean height of the ground under a track, which the vehicle keeps its altitude above [m].
double trackHeight(const Terrain& terrain, const SurveyStation& station, double length) {
  constexpr int kSteps = 32;
  const Eigen::Vector2d along = Eigen::Rotation2Dd(station.heading) * Eigen::Vector2d::UnitX();
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Vector2d at = station.centre + length * ((i + 0.5) / kSteps - 0.5) * along;
    sum += terrain.height(at.x(), at.y());
  }
  return sum / kSteps;
}

/// Displaces the points by their share of the drift: half of it back at the start, half forth at the end.
void shear(const Eigen::Vector3d& drift, double length, Eigen::Matrix3Xf& points) {
  const Eigen::RowVectorXf share = points.row(0) / static_cast<float>(length);
  points += drift.cast<float>() * share;
}

/// A seed of its own for each sub-map; neighbours are scattered by Random.
std::uint32_t seedOf(std::uint32_t seed, std::size_t index) {
  return seed ^ (0x85ebca6bU * (static_cast<std::uint32_t>(index) + 1U));
}

}  // namespace

/// What lies on the bottom, where the vehicle goes, and what it takes to be so.
class SurveySimulation::Site {
 public:
  explicit Site(const SurveyParameters& parameters)
      : parameters_(parameters),
        scene_(makeSite(parameters, surveyExtent(parameters.site))),
        plan_(planSurvey(scene_.extent(), footprintOf(parameters.site), parameters.seed)),
        errors_(drawErrors(parameters, plan_.size())) {}

  std::size_t size() const { return plan_.size(); }

  SimulatedSubmap submap(std::size_t index) const {
    const SurveyStation& station = plan_.at(index);
    const NavigationError& error = errors_[index];
    const std::uint32_t seed = seedOf(parameters_.seed, index);
    const ScanGeometry geometry = geometryAt(station);
    const GapMask no_gaps(geometry.footprint, 0.0, Random(seed, RandomStream::GAPS));
    const Eigen::Isometry3d scan_pose = geometry.site_from_track *
                                        Eigen::AngleAxisd(error.tilt.x(), Eigen::Vector3d::UnitX()) *
                                        Eigen::AngleAxisd(error.tilt.y(), Eigen::Vector3d::UnitY());
    SimulatedSubmap result;
    result.scan = measure(senseExactly(parameters_.points, scene_, geometry, no_gaps, seed), scene_.terrain(),
                          {scan_pose, parameters_.noise, seed, {}});
    shear(error.drift, geometry.footprint.x(), result.scan.points);
    result.world_from_navigation =
        poseOf(scan_pose.translation() + error.translation, station.heading + error.heading);
    return result;
  }

 private:
  ScanGeometry geometryAt(const SurveyStation& station) const {
    ScanGeometry geometry;
    geometry.footprint = footprintOf(parameters_.site);
    geometry.altitude = parameters_.altitude;
    geometry.baseline = parameters_.baseline;
    const double height = trackHeight(scene_.terrain(), station, geometry.footprint.x());
    geometry.site_from_track = poseOf({station.centre.x(), station.centre.y(), height}, station.heading);
    return geometry;
  }

  SurveyParameters parameters_;
  Scene scene_;
  std::vector<SurveyStation> plan_;
  std::vector<NavigationError> errors_;
};

SurveyParameters surveyParametersFor(SceneKind site) {
  SurveyParameters parameters;
  parameters.site = site;
  if (site != SceneKind::BARE) return parameters;
  constexpr double kSpacing = 0.25;  // [m]
  parameters.points = static_cast<std::size_t>(footprintOf(site).prod() / (kSpacing * kSpacing));
  parameters.object_share = 0.0;
  parameters.noise = 0.02;
  parameters.navigation_error = 1.0;
  parameters.heading_error = 2.0;
  parameters.altitude = 20.0;
  parameters.baseline = 0.0;
  return parameters;
}

SurveySimulation::SurveySimulation(const SurveyParameters& parameters) {
  validate(parameters);
  site_ = std::make_unique<Site>(parameters);
}

SurveySimulation::~SurveySimulation() = default;
SurveySimulation::SurveySimulation(SurveySimulation&&) noexcept = default;
SurveySimulation& SurveySimulation::operator=(SurveySimulation&&) noexcept = default;

std::size_t SurveySimulation::size() const {
  return site_->size();
}

SimulatedSubmap SurveySimulation::submap(std::size_t index) const {
  return site_->submap(index);
}

}  // namespace pcl_fft_ground::core
