#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <vector>

#include "pcl_fft_ground/core/scan/frame.h"
#include "scan/point_sample.h"
#include "scan/robust_up.h"
#include "scan/up_evidence.h"

namespace pcl_fft_ground::core {
namespace {

// What speaks for a direction is a difference of logarithms of roughnesses (UpProfile). Measured on the
// shared scans: from -0.1 (a quarry, a bare reef, a steep wood) to 3.3 for the side of z that is up, and 3 to
// 7 between the axis of the ground and z where another axis is up.
constexpr double OTHER_SIDE = 0.5;      // by which down must be better than z before it is believed
constexpr double OTHER_AXIS = 1.5;      // by which another axis must be
constexpr double OTHER_SHEET = 0.5;     // or one across a smooth sheet, where there is none across z
constexpr double SMOOTH = 0.4;          // ground of a sheet
constexpr double CLEAR = 0.5;           // evidence that needs no sensor to support it
constexpr double DOUBT = 0.3;           // evidence against the direction taken that is worth a warning
constexpr double CONTRADICTION = 0.7;   // against a direction that was given
constexpr double ROUGH = 1.5;           // what can hardly be ground
constexpr double SENSOR_SHOWN = 1.5;    // against a ground all of which lies above the sensor that is seen
constexpr double SENSOR_TOLD = 4;       // or told
constexpr Eigen::Index ENOUGH = 40000;  // points

/// The axis along which the points vary least, and their variances along all three, rising.
struct PrincipalAxis {
  Eigen::Vector3d axis, variance;
};

/// Nothing where the points determine no plane.
std::optional<PrincipalAxis> principalAxis(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::Vector3d& variance = solver.eigenvalues();
  if (variance[1] <= 1e-9 * variance[2]) return std::nullopt;
  return PrincipalAxis{solver.eigenvectors().col(0), variance};
}

Eigen::Vector3d turnedTowards(const Eigen::Vector3d& given, const Eigen::Vector3d& axis) {
  return axis.dot(given) < 0 ? Eigen::Vector3d(-axis) : axis;
}

/// A direction and whether there is a flat sheet across it.
struct Normal {
  Eigen::Vector3d direction;
  bool is_trusted;
};

/// The normal of the flattest half that lies near a direction, where it can be trusted; else that direction.
Normal normalNear(const Eigen::Vector3d& given, const PointSample& scan, const PrincipalAxis& principal) {
  constexpr double FLATTEST_VARIANCE_RATIO = 0.04;  // a fifth, squared
  constexpr double MOST_LEANING = 0.7071;           // cosine of 45 degrees
  constexpr double AGREEING = 0.9986;  // cosine of 3 degrees: all points then tell more precisely than half
  const Eigen::Vector3d up = turnedTowards(given, principal.axis);
  const Eigen::Vector3d& variance = principal.variance;
  const bool trusted = variance[0] <= FLATTEST_VARIANCE_RATIO * variance[1] && up.dot(given) >= MOST_LEANING;
  const Eigen::Vector3d fallback = trusted ? up : given;
  const std::optional<Eigen::Vector3d> normal = normalOfFlattestHalf(scan, given);
  const bool take_normal = normal && !(trusted && normal->dot(up) >= AGREEING);
  return {take_normal ? *normal : fallback, normal || trusted};
}

/// The position of the sensor and how much it counts.
struct Sensor {
  Eigen::Vector3d position;
  double weight;
};

std::optional<Sensor> toldSensor(const FrameParameters& parameters) {
  if (!parameters.sensor_position) return std::nullopt;
  return Sensor{*parameters.sensor_position, SENSOR_TOLD};
}

std::optional<Sensor> shownSensor(const PointsView& points) {
  if (!showsSensorAtOrigin(points)) return std::nullopt;
  return Sensor{Eigen::Vector3d::Zero(), SENSOR_SHOWN};
}

/// An axis that may be vertical, with what tells on which side up is: positive values speak for the axis,
/// negative ones for its opposite.
struct Axis {
  Eigen::Vector3d near;                ///< the direction that led to it
  Eigen::Vector3d up;                  ///< one of its two sides
  bool is_trusted;                     ///< a flat sheet lies across it
  UpProfile profile;                   ///< along `up`
  double prior = 0;                    ///< what speaks against `up` before anything is seen
  double prior_opposite = OTHER_SIDE;  ///< and against its opposite
  double objects = 0;                  ///< of what stands out
  double sensor = 0;                   ///< of the place of the sensor
  double below_ground = 0;             ///< share of the ground above the sensor if `up` is up
  double above_tops = 0;               ///< and if it is down

  double side() const { return objects + sensor; }
};

Axis axisSeen(const Points& sample, const Eigen::Vector3d& near, const Normal& normal) {
  Axis axis{near, normal.direction, normal.is_trusted, profileAlong(sample, normal.direction)};
  axis.objects = axis.profile.evidence();
  return axis;
}

/// Land with a pit is level land with an object, upside down: unless several things stand out downwards, and
/// hardly any upwards, they alone do not turn z over.
void heedPits(const Points& sample, Axis& axis) {
  constexpr int SEVERAL = 3, TO_ONE = 3;
  const int side = axis.up.z() > 0 ? 1 : -1;
  if (side * axis.objects > -OTHER_SIDE) return;
  const int above = thingsStandingOut(sample, side * axis.up),
            below = thingsStandingOut(sample, -side * axis.up);
  if (below < SEVERAL || below < TO_ONE * above) axis.objects = -side * OTHER_SIDE;
}

void placeSensor(const Sensor& sensor, Axis& axis) {
  const double height = axis.up.dot(sensor.position);
  axis.below_ground = sensor.weight * shareAbove(axis.profile.low, height);
  axis.above_tops = sensor.weight * shareAbove(-axis.profile.high, -height);
  axis.sensor = axis.above_tops - axis.below_ground;
}

/// One side of an axis.
struct Choice {
  const Axis* axis = nullptr;
  int side = 1;  ///< 1: `up`, -1: its opposite

  double evidence() const { return side * axis->side(); }
  std::optional<double> roughness() const {
    return side > 0 ? axis->profile.rough_below : axis->profile.rough_above;
  }
  double prior() const { return side > 0 ? axis->prior : axis->prior_opposite; }
};

/// The side of an axis for which more speaks.
Choice sideOf(const Axis& axis) {
  return {&axis, axis.side() + axis.prior_opposite - axis.prior >= 0 ? 1 : -1};
}

/// How rough the ground of a side is, as a logarithm.
double logRoughness(const Choice& choice) {
  const UpProfile& profile = choice.axis->profile;
  const double below = profile.rough_below.value_or(ROUGH), above = profile.rough_above.value_or(ROUGH);
  if (profile.is_enclosed) return 0.5 * std::log(below * above);  // neither is better
  return std::log(choice.side > 0 ? below : above);
}

/// The axis, and its side, that is smoothest. The sensor stands before walls as it stands above the ground:
/// it tells the side only.
Choice bestOf(const std::vector<Axis>& axes) {
  Choice best = sideOf(axes.front());
  for (const Axis& axis : axes) {
    const Choice choice = sideOf(axis);
    if (logRoughness(choice) + choice.prior() < logRoughness(best) + best.prior()) best = choice;
  }
  return best;
}

std::string asText(const Eigen::Vector3d& direction) {
  std::ostringstream text;
  text.precision(2);
  for (const double value : {direction.x(), direction.y(), direction.z()})
    text << (text.tellp() > 0 ? " " : "") << (std::abs(value) < 0.005 ? 0.0 : value);
  return text.str();
}

/// Confidences and reasons of a choice.
UpDirection described(const Choice& choice, const std::optional<Sensor>& sensor) {
  constexpr double CONFIDENCE_PER_EVIDENCE = 2;
  UpDirection up;
  const double objects = choice.side * choice.axis->objects, seen = choice.side * choice.axis->sensor;
  up.axis = choice.side * choice.axis->up;
  up.axis_confidence = choice.roughness() ? 1 / (1 + std::pow(*choice.roughness(), 2)) : 0.5;
  up.side_confidence = 1 / (1 + std::exp(-CONFIDENCE_PER_EVIDENCE * choice.evidence()));
  if (std::max(objects, seen) >= DOUBT)
    up.side_from = seen > objects ? SideSource::SENSOR : SideSource::OBJECTS;
  up.reasons.push_back(
      choice.axis->profile.is_enclosed
          ? "two smooth sheets enclose the points, as floor and ceiling do: no side of them tells"
      : objects >= DOUBT  ? "the lowest points form a smoother surface than the highest"
      : objects <= -DOUBT ? "the highest points form a smoother surface than the lowest"
                          : "nothing stands out clearly on one side");
  if (sensor)
    up.reasons.push_back(std::string(sensor->weight == SENSOR_TOLD
                                         ? "the sensor position given "
                                         : "the points show a sensor at the origin, which ") +
                         (seen >= DOUBT    ? "lies above the ground"
                          : seen <= -DOUBT ? "would lie below the ground"
                                           : "does not tell the side"));
  return up;
}

/// A direction that was given stays; what speaks against it is told.
UpDirection checkedGiven(const Axis& axis, const std::optional<Sensor>& sensor) {
  const Choice given{&axis, 1};
  UpDirection up = described(given, sensor);
  up.side_from = SideSource::GIVEN;
  if (given.evidence() <= -CONTRADICTION)
    up.warnings.push_back("up was given as " + asText(axis.near) + ", but " + up.reasons.back() +
                          ": if the other side is up, give " + asText(-axis.near) + " (--up-direction)");
  return up;
}

/// True where a flat sheet lies across an axis, and its ground, on whichever side, is no rougher than this.
bool isSheet(const Axis& axis, double roughest) {
  const UpProfile& profile = axis.profile;
  return axis.is_trusted &&
         std::min(profile.rough_below.value_or(ROUGH), profile.rough_above.value_or(ROUGH)) <= roughest;
}

/// True where another axis has a clearly smoother ground, if not so much that it was taken.
bool hasRival(const std::vector<Axis>& axes, const Choice& choice) {
  constexpr double ANOTHER = 0.9;  // cosine of 26 degrees
  return std::any_of(axes.begin(), axes.end(), [&](const Axis& axis) {
    return isSheet(axis, SMOOTH) && &axis != choice.axis &&
           std::abs(axis.up.dot(choice.axis->up)) < ANOTHER &&
           logRoughness(choice) - logRoughness(sideOf(axis)) >= OTHER_SHEET;
  });
}

/// Up as found where no direction was given, with a warning where little speaks for it.
UpDirection found(const std::vector<Axis>& axes, const std::optional<Sensor>& sensor) {
  const std::string how_to_tell =
      "if that is wrong, give up (--up-direction) or the place of the sensor (--sensor)";
  const Choice choice = bestOf(axes);
  UpDirection up = described(choice, sensor);
  const bool is_prior = choice.axis == &axes.front() && choice.side > 0;
  const bool no_ground = !choice.axis->is_trusted && choice.roughness().value_or(0) > ROUGH;
  const bool doubtful = no_ground || hasRival(axes, choice);
  if (is_prior && choice.evidence() <= -DOUBT)
    up.warnings.push_back("up is taken as z, but " + up.reasons.back() + ": " + how_to_tell);
  else if (is_prior && doubtful)
    up.warnings.push_back("up is taken as z, but hardly any ground is seen across it: " + how_to_tell);
  else if (!is_prior && (choice.evidence() < CLEAR || doubtful))
    up.warnings.push_back("up is taken as " + asText(up.axis) + " and not as z, as " + up.reasons.back() +
                          ": " + how_to_tell);
  return up;
}

/// Axes other than that near z.
void lookElsewhere(const PointSample& scan, const PrincipalAxis& principal, std::vector<Axis>& axes) {
  constexpr double SAME = 0.9;     // cosine of 26 degrees
  constexpr double HIGHEST = 0.7;  // ground is broader than it is high
  for (const Eigen::Vector3d& near : {Eigen::Vector3d(Eigen::Vector3d::UnitY()),
                                      Eigen::Vector3d(Eigen::Vector3d::UnitX()), principal.axis}) {
    const Normal normal = normalNear(near, scan, principal);
    if (heightToBreadth(scan.points, normal.direction) > HIGHEST) continue;
    const auto is_same = [&](const Axis& axis) { return std::abs(axis.up.dot(normal.direction)) > SAME; };
    if (std::any_of(axes.begin(), axes.end(), is_same)) continue;
    Axis axis = axisSeen(scan.points, near, normal);
    const bool is_better = isSheet(axis, SMOOTH) && !axes.front().is_trusted;
    axis.prior = axis.prior_opposite = is_better ? OTHER_SHEET : OTHER_AXIS;
    axes.push_back(std::move(axis));
  }
}

/// The axis near z as found from below, where it is another one: what lies low decides about narrow strips.
void lookDown(const PointSample& scan, const PrincipalAxis& principal, std::vector<Axis>& axes) {
  constexpr double SAME = 0.9994;  // cosine of 2 degrees
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  const Normal normal = normalNear(down, scan, principal);
  if (normal.direction.dot(-axes.front().up) > SAME) return;
  axes.push_back(axisSeen(scan.points, down, normal));
  heedPits(scan.points, axes.back());
  axes.back().prior = OTHER_SIDE;
}

UpDirection searched(const PointsView& points, const PrincipalAxis& principal,
                     const FrameParameters& parameters) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const PointSample sample{sampleOf(points, ENOUGH), points.cols()};
  std::vector<Axis> axes;
  axes.push_back(axisSeen(sample.points, z, normalNear(z, sample, principal)));
  heedPits(sample.points, axes.front());
  const bool is_sheet = axes.front().is_trusted;
  const bool is_clear = is_sheet && axes.front().objects >= CLEAR;
  if (!is_clear) lookDown(sample, principal, axes);
  if (!is_sheet) lookElsewhere(sample, principal, axes);
  std::optional<Sensor> sensor = toldSensor(parameters);
  if (!sensor && !is_clear) sensor = shownSensor(points);
  if (sensor)
    for (Axis& axis : axes) placeSensor(*sensor, axis);
  return found(axes, sensor);
}

/// Up where the method or the user leaves no choice.
UpDirection given(const Eigen::Vector3d& axis) {
  UpDirection up;
  up.axis = axis;
  up.side_from = SideSource::GIVEN;
  up.reasons = {"the direction was given"};
  return up;
}

}  // namespace

UpDirection estimateUp(const PointsView& points, const PointStatistics& statistics,
                       const FrameParameters& parameters) {
  const Eigen::Vector3d reference = parameters.up_direction.value_or(Eigen::Vector3d::UnitZ()).normalized();
  const std::optional<PrincipalAxis> principal =
      parameters.up_estimation == UpEstimation::GIVEN || points.cols() == 0
          ? std::nullopt
          : principalAxis(statistics.covariance);
  if (!principal && !(parameters.up_direction && points.cols() > 0)) return given(reference);
  if (parameters.up_estimation == UpEstimation::PRINCIPAL_AXIS)
    return given(principal ? turnedTowards(reference, principal->axis) : reference);
  if (!parameters.up_direction) return searched(points, *principal, parameters);

  const PointSample sample{sampleOf(points, ENOUGH), points.cols()};
  const Normal normal = principal ? normalNear(reference, sample, *principal) : Normal{reference, true};
  Axis seen = axisSeen(sample.points, reference, normal);
  std::optional<Sensor> sensor = toldSensor(parameters);
  if (!sensor && seen.objects < CLEAR) sensor = shownSensor(points);
  if (sensor) placeSensor(*sensor, seen);
  return checkedGiven(seen, sensor);
}

}  // namespace pcl_fft_ground::core
