#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <vector>

#include "align/surface_normals.h"
#include "pcl_fft_ground/core/align/rigid_fit.h"

namespace pcl_fft_ground::core {

/// A point of the moving scan and its partner in the reference.
struct Partners {
  Eigen::Vector3d moving;     ///< after the current correction [m]
  Eigen::Vector3d reference;  ///< [m]
  std::size_t place;          ///< number of the partner, for SurfaceNormals
  double weight;              ///< in (0, 1]
  std::size_t part;           ///< number of the part of the scene whose errors it shares
};

/// Less for distant partners. \param gate distance [m] from which partners are not taken
inline double weightOf(double distance, double gate) {
  const double ratio = distance / (0.5 * gate);
  return 1 / (1 + ratio * ratio);
}

/// How near partners have to be, and when to stop.
struct IcpSchedule {
  double first_gate;   ///< largest distance of partners at first [m]; it shrinks from step to step
  double finest_gate;  ///< down to this [m]
  double settled;      ///< a smaller step at the finest gate is the last [m]
};

/// What ICP came to.
struct IcpResult {
  Eigen::Isometry3d correction = Eigen::Isometry3d::Identity();  ///< of the initial guess
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();              ///< of the points that took part
  Matrix6d information = Matrix6d::Zero();  ///< of motions about the centre, for errors of 1 m
  double variance = 0;                      ///< mean squared distance to the planes [m^2]
  double least_deviation = 0;               ///< of a distance, whatever the residuals say [m]
  Matrix6d spread = Matrix6d::Zero();       ///< jackknifeCovariance() of the parts, about the centre
};

using FindPartners = std::function<std::vector<Partners>(const Eigen::Isometry3d& correction, double gate)>;
using IcpStep = std::function<Eigen::Isometry3d(const std::vector<Partners>&, const Eigen::Vector3d& centre)>;

/// Finds partners and steps in turns until the steps are small.
Eigen::Isometry3d iterateIcp(const Eigen::Isometry3d& start, const IcpSchedule& schedule,
                             const FindPartners& find, const IcpStep& step);

/// Yaw and shift that bring points on to their partners.
Eigen::Isometry3d stepToPoints(const std::vector<Partners>& partners, const Eigen::Vector3d& centre);

/// Motion that brings points on to the planes through their partners and, a little, on to these themselves.
Eigen::Isometry3d stepToPlanes(const std::vector<Partners>& partners, const Eigen::Vector3d& centre,
                               SurfaceNormals& normals);

/// How well the partners hold the correction.
IcpResult summariseIcp(const Eigen::Isometry3d& correction, const std::vector<Partners>& partners,
                       SurfaceNormals& normals);

}  // namespace pcl_fft_ground::core
