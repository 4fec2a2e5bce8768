#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/align/segment_alignment.h"
#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// Share of a scan's voxels that objects may have where its relief is asked: they are no relief, as from
/// other places they have other sides (two flight lines over a wood came 0.7 m off, by eight times the
/// deviation predicted). alignRelief() sees points only, and leaves it to its callers.
constexpr double MOST_OBJECTS_ON_RELIEF = 0.1;

/** Settings of alignRelief(): what navigation allows. All else follows from the spacing, the noise and the
 * extent of the scans. */
struct ReliefParameters {
  SearchGates gates;  ///< how far off the initial guess may be; `hypotheses` is not used
  std::optional<double>
      cell_size;  ///< side of the finest cells [m], > 0; 2.4 spacings of the points if not set
  /// Largest deviation predicted at the edge of the overlap that is asked for [m], > 0; 0.4 spacings are
  /// allowed at most, whether it is set or not.
  std::optional<double> max_sigma;
};

/// A place where the relief of two scans fits better than around it.
struct ReliefPose {
  Eigen::Isometry3d reference_from_moving = Eigen::Isometry3d::Identity();
  double overlap = 0;  ///< share of the smaller scan that lies over the other, [0, 1]
  double residual =
      0;  ///< root mean square of the heights left, in units of what noise and roughness explain
  double correlation = 0;  ///< of the band-passed heights of both, [-1, 1]
  /// Logarithm of how much likelier the correlation is than between unrelated places, at the best of all the
  /// places that were tried: 0 is what chance comes to.
  double evidence = 0;
  double distance = 0;  ///< largest displacement of the overlap from the best pose [m]; 0 for that one
};

/** The result for a pair. A refusal is a result, too: the transform then is the initial guess. */
struct ReliefResult {
  Eigen::Isometry3d reference_from_moving = Eigen::Isometry3d::Identity();  ///< places the moving scan
  bool accepted = false;
  std::string refusal;             ///< why not accepted; empty if it is
  ReliefPose best;                 ///< the pose that fits best, accepted or not
  std::vector<ReliefPose> rivals;  ///< other places that fit better than around them, the best first
  double cell_size = 0;            ///< side of the finest cells of the search [m]
  double spacing = 0;              ///< of the points in plan, of the thinner scan [m]
  double deviation = 0;            ///< predicted standard deviation at the edge of the overlap [m]
  /** Covariance of (translation [m], rotation vector [rad]) of a small motion applied after the transform,
   * about the origin of the reference; zero if nothing was computed.
   */
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/** Aligns two overlapping scans by the relief of the ground: where there are no objects the ground itself is
 * the landmark.
 *
 * Band-passed elevation grids are correlated over all shifts at once in the frequency domain (Padfield,
 * "Masked object registration in the Fourier domain", 2012), for every heading that navigation allows and on
 * several scales. From each of the best peaks, and from the guess, ICP of the surfaces follows. The search is
 * exhaustive, hence a certificate: what is accepted fits within the noise, is no work of chance, is held in
 * every direction, and no other place fits nearly as well.
 *
 * \param moving,reference finite points of the scans [m], z roughly up, not far from their origins
 * \param initial_guess reference_from_moving as far as it is known
 * \throws std::invalid_argument if a parameter is out of range or the guess is not finite
 *         std::length_error if grids as fine as the points would have more than MAX_CELLS cells
 */
PCL_FFT_GROUND_CORE_EXPORT ReliefResult alignRelief(const PointsView& moving, const PointsView& reference,
                                                    const Eigen::Isometry3d& initial_guess,
                                                    const ReliefParameters& parameters = {});

}  // namespace pcl_fft_ground::core
