#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "align/scan_pair.h"
#include "align/surface_patch.h"
#include "pcl_fft_ground/core/align/rigid_fit.h"

namespace pcl_fft_ground::core {

/// A point of the moving scan and its correspondence in the reference.
struct Correspondence {
  Eigen::Vector3d moving;     ///< after the current correction [m]
  Eigen::Vector3d reference;  ///< [m]
  std::size_t place;          ///< number of the reference point, for SurfaceNormals
  double weight;              ///< in (0, 1]
  std::size_t part;           ///< number of the part of the scene whose errors it shares
};

/// Less for distant correspondences. \param gate distance [m] from which correspondences are not taken
inline double weightOf(double distance, double gate) {
  const double ratio = distance / (0.5 * gate);
  return 1 / (1 + ratio * ratio);
}

/// How near correspondences have to be, and when to stop.
struct IcpSchedule {
  double first_gate;   ///< largest distance of correspondences at first [m]; it shrinks from step to step
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

using FindCorrespondences =
    std::function<std::vector<Correspondence>(const Eigen::Isometry3d& correction, double gate)>;
using IcpStep =
    std::function<Eigen::Isometry3d(const std::vector<Correspondence>&, const Eigen::Vector3d& centre)>;

/// Finds correspondences and steps in turns until the steps are small.
Eigen::Isometry3d iterateIcp(const Eigen::Isometry3d& start, const IcpSchedule& schedule,
                             const FindCorrespondences& find, const IcpStep& step);

/// Yaw and shift that bring points on to their correspondences.
Eigen::Isometry3d stepToPoints(const std::vector<Correspondence>& correspondences,
                               const Eigen::Vector3d& centre);

/// Motion that brings points on to the planes through their correspondences and, a little, on to these
/// themselves.
Eigen::Isometry3d stepToPlanes(const std::vector<Correspondence>& correspondences,
                               const Eigen::Vector3d& centre, SurfaceNormals& normals);

/// How well the correspondences hold the correction.
IcpResult summariseIcp(const Eigen::Isometry3d& correction,
                       const std::vector<Correspondence>& correspondences, SurfaceNormals& normals);

/// ICP whose correspondences stay within matched segments and in what the reference has seen.
class ConstrainedIcp {
 public:
  /// Keeps a reference to the pair.
  explicit ConstrainedIcp(const ScanPair& pair);

  /// Point-to-point in yaw and shift. \param gate largest distance of correspondences at first [voxels]
  Eigen::Isometry3d approach(const std::vector<SegmentMatch>& matches, const Eigen::Isometry3d& start,
                             double gate) const;

  /// Point-to-plane in all six degrees of freedom, from within a few voxels.
  IcpResult refine(const std::vector<SegmentMatch>& matches, const Eigen::Isometry3d& start);

 private:
  /// Correspondences of one in so many of the samples' points.
  FindCorrespondences correspondencesIn(const std::vector<SegmentMatch>& matches, Eigen::Index one_in) const;
  std::optional<Correspondence> correspondenceOf(const Eigen::Vector3d& point,
                                                 const std::vector<std::size_t>& segments, double gate) const;

  const ScanPair& pair_;
  std::vector<Points> samples_;           // of the moving segments
  std::vector<std::size_t> first_place_;  // per reference segment, the number of its first point
  SurfaceNormals normals_;
};

/** Plane-to-plane ICP of the surfaces that both scans have seen, ground and objects, from within a voxel or
 * two.
 *
 * Takes part what is flat in both scans and faces the same way: what one scan has seen from one side and the
 * other from the other does not pull.
 *
 * \param start correction of the initial guess to begin with
 * \return without information where no surfaces meet
 */
IcpResult alignPlanes(const ScanPair& pair, const Eigen::Isometry3d& start);

}  // namespace pcl_fft_ground::core
