#include "simulation/survey_plan.h"

#include <algorithm>
#include <cmath>

#include "simulation/simulation_random.h"

namespace pcl_fft_ground::core {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180.0;

/// Evenly spaced places from \c low to \c high; those of footprints of this length overlap by 40 % or more.
std::vector<double> stationsAlong(double low, double high, double footprint) {
  constexpr double kStep = 0.6;
  const double span = std::max(0.0, high - low - footprint);
  const double steps = std::ceil(span / (kStep * footprint) - 1e-9);
  std::vector<double> stations;
  for (int i = 0; i <= steps; ++i) {
    stations.push_back(low + 0.5 * std::min(footprint, high - low) + (steps > 0.0 ? span * i / steps : 0.0));
  }
  return stations;
}

/// The stations of one transect, in the direction of its heading.
void addTransect(std::vector<SurveyStation> line, bool reversed, std::vector<SurveyStation>& plan) {
  if (reversed) {
    std::reverse(line.begin(), line.end());
    for (SurveyStation& station : line) station.heading += kPi;
  }
  plan.insert(plan.end(), line.begin(), line.end());
}

/// A vehicle strays from its plan: by 5 % of its swath and 2 degrees.
void stray(const Eigen::Vector2d& footprint, Random& random, std::vector<SurveyStation>& plan) {
  const double most = 0.05 * footprint.minCoeff();
  for (SurveyStation& station : plan) {
    const double dx = random.uniform(-most, most);
    const double dy = random.uniform(-most, most);
    station.centre += Eigen::Vector2d(dx, dy);
    station.heading += random.uniform(-2.0, 2.0) * kDegree;
  }
}

double eitherSign(double size, Random& random) {
  return random.chance(0.5) ? size : -size;
}

Eigen::Vector3d randomDirection(Random& random) {
  const double z = random.uniform(-1.0, 1.0);
  const double angle = random.uniform(0.0, 2.0 * kPi);
  const double across = std::sqrt(1.0 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
}

}  // namespace

Eigen::AlignedBox2d surveyExtent(SceneKind site) {
  if (site == SceneKind::BARE) return {Eigen::Vector2d(-34.0, -22.0), Eigen::Vector2d(34.0, 22.0)};
  const Eigen::Vector2d half(8.0, site == SceneKind::PIPES ? 3.0 : 5.0);
  return {-half, half};
}

std::vector<SurveyStation> planSurvey(const Eigen::AlignedBox2d& extent, const Eigen::Vector2d& footprint,
                                      std::uint32_t seed) {
  const Eigen::Vector2d low = extent.min();
  const Eigen::Vector2d high = extent.max();
  std::vector<SurveyStation> plan;
  bool reversed = false;
  for (const double y : stationsAlong(low.y(), high.y(), footprint.y())) {
    std::vector<SurveyStation> line;
    for (const double x : stationsAlong(low.x(), high.x(), footprint.x())) line.push_back({{x, y}, 0.0});
    addTransect(line, reversed, plan);
    reversed = !reversed;
  }
  for (const double x : {low.x() + extent.sizes().x() / 3.0, high.x() - extent.sizes().x() / 3.0}) {
    std::vector<SurveyStation> line;
    for (const double y : stationsAlong(low.y(), high.y(), footprint.x()))
      line.push_back({{x, y}, 0.5 * kPi});
    addTransect(line, reversed, plan);
    reversed = !reversed;
  }
  Random random(seed, RandomStream::ROUTE);
  stray(footprint, random, plan);
  return plan;
}

std::vector<NavigationError> drawErrors(const SurveyParameters& parameters, std::size_t count) {
  constexpr double kDepth = 0.02;          // [m], standard deviation
  constexpr double kTilt = 0.2 * kDegree;  // standard deviation
  Random random(parameters.seed, RandomStream::NAVIGATION);
  std::vector<NavigationError> errors(count);
  for (NavigationError& error : errors) {
    const double distance = parameters.navigation_error * random.uniform(0.1, 1.0);
    const double direction = random.uniform(0.0, 2.0 * kPi);
    const double depth = random.normal(kDepth);
    error.translation = {distance * std::cos(direction), distance * std::sin(direction), depth};
    const double turn = parameters.heading_error * kDegree * random.uniform(1.0 / 6.0, 1.0);
    error.heading = eitherSign(turn, random);
    const double roll = random.normal(kTilt);
    const double pitch = random.normal(kTilt);
    error.tilt = {roll, pitch};
    error.drift = parameters.drift * randomDirection(random);
  }
  return errors;
}

}  // namespace pcl_fft_ground::core
