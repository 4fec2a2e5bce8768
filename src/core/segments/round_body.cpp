#include "segments/round_body.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl_fft_ground::core {
namespace {

/// A fit is told of if its residual is below this share of its radius: the ribs and sockets of a body that is
/// round but for them stay below it, the halves of something with edges do not.
constexpr double GOOD_RESIDUAL = 1.0 / 12;

constexpr double OUTLIER = 3;  // standard deviations: beyond it a point pulls no more
constexpr int MOST_ITERATIONS = 25;
constexpr Eigen::Index MOST_POINTS = 250;  // of a fit of seven numbers

/// A body by numbers that a solver may change freely: steps of the centre and of the axis in the start's
/// frame, logs of half the length and of the radius. A cylinder has no step along its axis and no length.
using Steps = Eigen::Matrix<double, 7, 1>;

RoundBody stepped(const RoundBody& start, const Eigen::Matrix3d& frame, const Steps& steps) {
  RoundBody body = start;
  body.centre += frame * steps.head<3>();
  body.axis = (frame.col(0) + frame.col(1) * steps(3) + frame.col(2) * steps(4)).normalized();
  body.length = start.length * std::exp(steps(5));
  body.radius = start.radius * std::exp(steps(6));
  return body;
}

/// Distance of a point from the surface, positive outside [m]; to an ellipsoid along the ray from its centre.
double distanceFrom(const RoundBody& body, const Eigen::Vector3d& point) {
  const Eigen::Vector3d offset = point - body.centre;
  const double along = offset.dot(body.axis);
  const double across = (offset - along * body.axis).norm();
  if (body.shape == RoundBody::Shape::CYLINDER) return across - body.radius;
  const double scaled = std::hypot(2 * along / body.length, across / body.radius);
  return scaled > 0 ? offset.norm() * (1 - 1 / scaled) : -body.radius;
}

Eigen::VectorXd distancesFrom(const RoundBody& body, const Eigen::Matrix3Xd& points) {
  Eigen::VectorXd distances(points.cols());
  for (Eigen::Index n = 0; n < points.cols(); ++n) distances(n) = distanceFrom(body, points.col(n));
  return distances;
}

/// Standard deviation of the bulk of some residuals.
double spreadOf(const Eigen::VectorXd& residuals) {
  constexpr double OF_A_NORMAL_ONE = 1.4826;
  std::vector<double> sizes(residuals.data(), residuals.data() + residuals.size());
  for (double& size : sizes) size = std::abs(size);
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2), sizes.end());
  return OF_A_NORMAL_ONE * sizes[sizes.size() / 2];
}

/// Mean square of residuals, those beyond a bound counting as the bound.
double clippedMeanSquare(const Eigen::VectorXd& residuals, double bound) {
  return residuals.cwiseAbs().cwiseMin(bound).squaredNorm() / static_cast<double>(residuals.size());
}

/// Least squares by Levenberg and Marquardt, outliers bounded.
RoundBody refined(const RoundBody& start, const Eigen::Matrix3Xd& points) {
  constexpr double STEP = 1e-6, SMALLEST_GAIN = 1e-9;
  const bool is_cylinder = start.shape == RoundBody::Shape::CYLINDER;
  Eigen::Matrix3d frame;
  frame.col(0) = start.axis;
  frame.col(1) = start.axis.unitOrthogonal();
  frame.col(2) = start.axis.cross(frame.col(1));
  const double scale = start.radius;
  Steps steps = Steps::Zero();
  double damping = 1e-3;
  Eigen::VectorXd residuals = distancesFrom(start, points);
  for (int iteration = 0; iteration < MOST_ITERATIONS; ++iteration) {
    const double bound = OUTLIER * std::max(spreadOf(residuals), 1e-6 * scale);
    const double cost = clippedMeanSquare(residuals, bound);
    const Eigen::VectorXd weights = (residuals.array().abs() <= bound).cast<double>();
    Eigen::Matrix<double, Eigen::Dynamic, 7> slopes(points.cols(), 7);
    for (Eigen::Index k = 0; k < 7; ++k) {
      Steps moved = steps;
      moved(k) += k < 3 ? STEP * scale : STEP;
      slopes.col(k) =
          (distancesFrom(stepped(start, frame, moved), points) - residuals) / (moved(k) - steps(k));
    }
    if (is_cylinder) slopes.col(0).setZero(), slopes.col(5).setZero();
    const Eigen::Matrix<double, 7, 7> normal = slopes.transpose() * weights.asDiagonal() * slopes;
    const Steps gradient = slopes.transpose() * (weights.asDiagonal() * residuals);
    double gain = 0;
    for (int attempt = 0; attempt < 6 && gain <= 0; ++attempt) {
      Eigen::Matrix<double, 7, 7> damped = normal;
      for (Eigen::Index k = 0; k < 7; ++k) damped(k, k) += damping * normal(k, k) + 1e-12 * normal.trace();
      const Steps next = steps - damped.ldlt().solve(gradient);
      const Eigen::VectorXd after = distancesFrom(stepped(start, frame, next), points);
      gain = after.allFinite() ? cost - clippedMeanSquare(after, bound) : 0;
      if (gain > 0) {
        steps = next;
        residuals = after;
        damping = std::max(1e-9, 0.2 * damping);
      } else {
        damping *= 8;
      }
    }
    if (gain <= SMALLEST_GAIN * cost) break;
  }
  return stepped(start, frame, steps);
}

/// Every so many-th point.
Eigen::Matrix3Xd thinned(const Eigen::Matrix3Xd& points) {
  const Eigen::Index stride = (points.cols() + MOST_POINTS - 1) / MOST_POINTS;
  Eigen::Matrix3Xd result(3, (points.cols() + stride - 1) / stride);
  for (Eigen::Index n = 0; n < result.cols(); ++n) result.col(n) = points.col(n * stride);
  return result;
}

RoundBody fitted(RoundBody::Shape shape, const Eigen::Matrix3Xd& sample, const ObjectProperties& box) {
  RoundBody start;
  start.shape = shape;
  start.axis = box.axes.col(0);
  start.length = box.lengths(0);
  start.radius = 0.5 * std::max(box.lengths(1), 0.05 * box.lengths(0));
  start.centre = box.centre - 0.5 * start.radius * Eigen::Vector3d::UnitZ();  // only the upper side is seen
  RoundBody body = refined(start, sample);
  const Eigen::VectorXd residuals = distancesFrom(body, sample);
  body.residual = std::sqrt(clippedMeanSquare(residuals, OUTLIER * spreadOf(residuals)));
  return body;
}

/// Centre and length of a cylinder from the points on it.
void measureAlong(const Eigen::Matrix3Xd& points, RoundBody& cylinder) {
  const Eigen::RowVectorXd along = cylinder.axis.transpose() * (points.colwise() - cylinder.centre);
  const double low = along.minCoeff(), high = along.maxCoeff();
  cylinder.centre += 0.5 * (low + high) * cylinder.axis;
  cylinder.length = high - low;
}

bool isCredible(const RoundBody& body, const ObjectProperties& box) {
  const double half_width = 0.5 * box.lengths(1);
  return std::isfinite(body.residual) && body.centre.allFinite() &&
         body.residual <= GOOD_RESIDUAL * body.radius && body.radius >= 0.5 * half_width &&
         body.radius <= 2 * half_width && body.length >= body.radius && body.length <= 2 * box.lengths(0);
}

}  // namespace

std::optional<RoundBody> fitRoundBody(const Eigen::Matrix3Xd& points, const ObjectProperties& box) {
  constexpr Eigen::Index FEWEST = 100;  // points: a body of fewer is hardly a shape
  if (points.cols() < FEWEST || !(box.lengths(1) > 0)) return std::nullopt;
  const Eigen::Matrix3Xd sample = thinned(points);
  RoundBody cylinder = fitted(RoundBody::Shape::CYLINDER, sample, box);
  measureAlong(points, cylinder);
  const RoundBody ellipsoid = fitted(RoundBody::Shape::ELLIPSOID, sample, box);
  // A cylinder is long; what is no longer than wide fits one by chance.
  const bool is_cylinder = isCredible(cylinder, box) && cylinder.length >= 3 * cylinder.radius;
  const bool is_ellipsoid = isCredible(ellipsoid, box);
  if (is_cylinder && (!is_ellipsoid || cylinder.residual <= ellipsoid.residual)) return cylinder;
  if (is_ellipsoid) return ellipsoid;
  return std::nullopt;
}

}  // namespace pcl_fft_ground::core
