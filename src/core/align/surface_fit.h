#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "align/icp.h"
#include "align/scan_pair.h"
#include "align/view_field.h"

namespace pcl_fft_ground::core {

/// A piece of a scan's surface.
struct Surfel {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< mean of its points [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of unit length, its sign arbitrary
  double variance = 0;                               ///< of its points about their plane [m^2]
  double tilt = 0;                                   ///< variance of the normal by noise [rad^2]
  double radius = 0;                                 ///< of the neighbourhood that was asked for points [m]
  bool is_valid = false;                             ///< false: there were too few points
  bool is_flat = false;
};

/// A scan as pieces of its surface, and what it could have seen.
class SurfaceModel {
 public:
  /// Keeps a reference to the scan.
  SurfaceModel(const ScanSegments& scan, const NearestNeighboursFactory& neighbours);

  /// The piece around the n-th point of the surface, fitted when it is first asked for.
  const Surfel& at(Eigen::Index n);
  /// The nearest point of the surface.
  Neighbour nearest(const Eigen::Vector3d& place, double reach) const {
    return search_->nearest(place.cast<float>(), static_cast<float>(reach));
  }
  const ViewField& view() const { return view_; }
  double voxelSize() const { return scan_.voxel_size; }
  /// Points around which there is a piece, evenly taken: those that are compared.
  const std::vector<Eigen::Index>& sample() const { return sample_; }
  /// Median variance of the flat pieces [m^2]: the noise.
  double typicalVariance() const { return typical_; }

 private:
  Surfel fit(Eigen::Index n);

  const ScanSegments& scan_;
  std::unique_ptr<NearestNeighbours> search_;
  ViewField view_;
  std::vector<std::optional<Surfel>> kept_;
  std::vector<Eigen::Index> near_;
  std::vector<Eigen::Index> sample_;
  double typical_ = 0;
};

/** What two scans say for a pose, in both directions.
 *
 * Each piece of either surface weighs as much as the logarithm of how much likelier it is where the other
 * surface is found, within the noise of both, than anywhere near: sharp ones tell, rough ones hardly. It
 * agrees, in part or wholly, or contradicts where the other scan has looked and found nothing of the kind;
 * what that scan could not see says nothing.
 */
struct SurfaceEvidence {
  double evidence = 0;  ///< logarithm of how much likelier the pose is than surfaces by chance
  double seen = 0;      ///< share of the pieces that agree or contradict, [0, 1]
  /// Share of the pieces seen that lie where the other scan looked through, of the scan with the lesser one:
  /// what has come, gone or is transparent is missing from one scan, what is misplaced is from both.
  double misplaced = 0;
  Eigen::Matrix3d agreeing = Eigen::Matrix3d::Zero();       ///< sum of weight times squared normal
  Eigen::Matrix3d contradicting = Eigen::Matrix3d::Zero();  ///< the same

  /// Share of the weight that agrees, [0, 1].
  double share() const;
  /// The same in the direction in which it is least: a floor agrees anywhere, but only with vertical shifts.
  double leastShare() const;
};

/// How many of the pieces are compared.
enum class Pieces {
  ALL,
  FEW,  ///< enough to tell whether a pose is worth the rest; what comes of them is sums of a sample
};

/// Compares and aligns the surfaces of two scans; the poses are corrections of the pair's initial guess.
class SurfaceFit {
 public:
  /// Keeps a reference to the pair.
  explicit SurfaceFit(const ScanPair& pair);

  /// ICP of surfaces from afar, symmetric: distances weigh less along both surfaces than across them.
  /// \param reach largest distance of correspondences at first [m]
  Eigen::Isometry3d approach(const Eigen::Isometry3d& start, double reach) const;

  /// The pose near by of the most evidence (by expectation and maximisation), and how well it is held.
  IcpResult refine(const Eigen::Isometry3d& start, Pieces pieces = Pieces::ALL) const;

  SurfaceEvidence at(const Eigen::Isometry3d& correction, Pieces pieces = Pieces::ALL) const;

  /// Whether either scan is seen from above, as it was not taken from one place.
  bool isFromAbove() const { return moving_->view().isFromAbove() || reference_->view().isFromAbove(); }

  /// By how much two poses displace the reference's surface [m], its median.
  double displacement(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) const;

 private:
  struct Match;
  std::vector<Match> matches(const Eigen::Isometry3d& correction, Pieces pieces) const;
  void addMatches(SurfaceModel& from, SurfaceModel& to, const Eigen::Isometry3d& to_from, Pieces pieces,
                  std::vector<Match>& found) const;

  const ScanPair& pair_;
  std::unique_ptr<SurfaceModel> moving_, reference_;
};

}  // namespace pcl_fft_ground::core
