#include "align/icp.h"

#include <algorithm>
#include <cmath>

namespace pcl_fft_ground::core {
namespace {

constexpr int MAX_ITERATIONS = 40;
constexpr double GATE_STEP = 0.8;     // by which the gate shrinks in an iteration
constexpr double POINT_SHARE = 0.05;  // of point-to-point in point-to-plane

Eigen::Vector3d centreOf(const std::vector<Correspondence>& correspondences) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Correspondence& p : correspondences) sum += p.reference;
  return sum / static_cast<double>(correspondences.size());
}

MotionFit fitPlanes(const std::vector<Correspondence>& correspondences, const Eigen::Vector3d& centre,
                    SurfaceNormals& normals) {
  MotionFit fit(centre);
  for (const Correspondence& p : correspondences) {
    fit.addToPlane(p.moving, p.reference, normals.at(p.place, p.reference), p.weight);
    fit.addToPoint(p.moving, p.reference, POINT_SHARE * p.weight);
  }
  return fit;
}

}  // namespace

Eigen::Isometry3d iterateIcp(const Eigen::Isometry3d& start, const IcpSchedule& schedule,
                             const FindCorrespondences& find, const IcpStep& step) {
  Eigen::Isometry3d correction = start;
  double gate = schedule.first_gate;
  for (int iteration = 0; iteration < MAX_ITERATIONS; ++iteration) {
    const std::vector<Correspondence> correspondences = find(correction, gate);
    if (correspondences.empty()) break;
    const Eigen::Vector3d centre = centreOf(correspondences);
    const Eigen::Isometry3d motion = step(correspondences, centre);
    correction = motion * correction;
    const double moved = (motion * centre - centre).norm() + std::abs(yawOf(motion));
    if (gate <= schedule.finest_gate && moved < schedule.settled) break;
    gate = std::max(schedule.finest_gate, GATE_STEP * gate);
  }
  return correction;
}

Eigen::Isometry3d stepToPoints(const std::vector<Correspondence>& correspondences,
                               const Eigen::Vector3d& centre) {
  YawFit fit;
  for (const Correspondence& p : correspondences) fit.add(p.moving - centre, p.reference - centre, p.weight);
  return Eigen::Translation3d(centre) * fit.solve() * Eigen::Translation3d(-centre);
}

Eigen::Isometry3d stepToPlanes(const std::vector<Correspondence>& correspondences,
                               const Eigen::Vector3d& centre, SurfaceNormals& normals) {
  return fitPlanes(correspondences, centre, normals).solve();
}

IcpResult summariseIcp(const Eigen::Isometry3d& correction,
                       const std::vector<Correspondence>& correspondences, SurfaceNormals& normals) {
  IcpResult result;
  result.correction = correction;
  if (correspondences.empty()) return result;
  result.centre = centreOf(correspondences);
  std::vector<MotionFit> parts;
  double sum = 0, weights = 0;
  for (const Correspondence& p : correspondences) {
    const Eigen::Vector3d& normal = normals.at(p.place, p.reference);
    if (normal.isZero()) continue;  // a point without a surface says nothing, least of all that it fits
    parts.resize(std::max(parts.size(), p.part + 1), MotionFit(result.centre));
    parts[p.part].addToPlane(p.moving, p.reference, normal, p.weight);
    const double distance = normal.dot(p.moving - p.reference);
    sum += p.weight * distance * distance;
    weights += p.weight;
  }
  if (parts.empty()) return result;
  for (const MotionFit& part : parts) result.information += part.information();
  result.variance = sum / weights;
  result.spread = jackknifeCovariance(parts);
  return result;
}

}  // namespace pcl_fft_ground::core
