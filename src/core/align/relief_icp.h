#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "align/relief_surface.h"
#include "pcl_fft_ground/core/align/rigid_fit.h"

namespace pcl_fft_ground::core {

/// How two surfaces lie on each other.
struct ReliefFit {
  Eigen::Isometry3d correction = Eigen::Isometry3d::Identity();  ///< of the moving scan
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();              ///< of the overlap [m]
  double radius = 0;    ///< within which nearly all of the overlap lies [m]
  double overlap = 0;   ///< share of the smaller scan that lies over the other, [0, 1]
  double residual = 0;  ///< root mean square of the heights left, in units of what is expected
  double relief = 0;    ///< what it would be if the two had nothing in common but their mean planes
  double patch = 0;     ///< length over which the relief is alike [m]
  double patches = 0;   ///< number of such patches in the overlap
  double samples = 0;   ///< number of heights that were compared
  Matrix6d information = Matrix6d::Zero();  ///< of motions about the centre, by the expected deviations
  Matrix6d spread = Matrix6d::Zero();       ///< jackknifeCovariance() of parts of the overlap
};

/// A scan to be laid on another one.
struct ReliefScan {
  Points sample;                 ///< points that are compared [m]
  std::vector<double> variance;  ///< of each of them about its own scan's surface [m^2]
  ReliefSurface surface;
};

/// \param spacing of the points [m]
ReliefScan reliefScan(const PointsView& points, double spacing);

/** ICP of two surfaces seen from above, each point compared with the other surface above or below it, both
 * ways. */
class ReliefIcp {
 public:
  /// Keeps references. \param settled a smaller step is the last [m]
  ReliefIcp(const ReliefScan& moving, const ReliefScan& reference, double settled)
      : moving_(moving), reference_(reference), settled_(settled) {}

  /// \param start correction of the moving scan to begin with; its height is found first
  ReliefFit run(const Eigen::Isometry3d& start) const;

 private:
  /// A point of one surface over the other, after the correction.
  struct Pair {
    Eigen::Vector3d from, to, normal;
    double height;    // what is left between them, vertically [m]
    double variance;  // that is expected [m^2]
  };

  std::vector<Pair> pairsOf(const Eigen::Isometry3d& correction) const;
  double overlapOf(const Eigen::Isometry3d& correction) const;
  void describeRelief(const std::vector<Pair>& pairs, ReliefFit& fit) const;
  ReliefFit summarise(const Eigen::Isometry3d& correction) const;

  const ReliefScan& moving_;
  const ReliefScan& reference_;
  double settled_;
};

}  // namespace pcl_fft_ground::core
