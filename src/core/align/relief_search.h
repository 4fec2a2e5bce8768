#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "pcl_fft_ground/core/grid/elevation_grid.h"
#include "pcl_fft_ground/core/ground/spectrum.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// Where to look for the moving scan.
struct ReliefBounds {
  Eigen::Vector2d pivot;  ///< about which it turns: amid the overlap [m]
  double shift;           ///< largest [m]
  double turn;            ///< largest, either way [rad]
};

/// How well band-passed heights agree.
struct ReliefAgreement {
  double correlation = 0;  ///< [-1, 1]
  double evidence = 0;     ///< log-likelihood against chance, less that of the best of all chances
};

/// A place where they agree better than around it.
struct ReliefPeak {
  Eigen::Isometry3d correction;  ///< a turn about the vertical through the pivot, then a shift
  ReliefAgreement agreement;
};

/// Band-passed heights, 0 where there are none, and where there are.
struct ReliefGrid {
  Eigen::ArrayXXd heights, mask;
};

/// Spectra of a ReliefGrid with room for the shifts.
struct ReliefSpectra {
  Spectrum mask, heights, squares;
};

/** Correlation of two scans' elevation grids over all shifts and headings within bounds.
 *
 * Masked normalised cross-correlation (Padfield 2012) of band-passed heights: of rippled, sloping or partly
 * overlapping ground only the relief of a few cells' wavelength counts.
 */
class ReliefSearch {
 public:
  /// Keeps references. \param cell_size side of a cell [m]
  ReliefSearch(const Points& moving, const Points& reference, const ReliefBounds& bounds, double cell_size);

  /// The best peaks, the best first. \param count at most so many
  std::vector<ReliefPeak> peaks(std::size_t count);

  /// After peaks(): the agreement at any correction of the moving scan.
  ReliefAgreement at(const Eigen::Isometry3d& correction) const;

  double headings() const { return 2 * turns_ + 1; }

 private:
  ReliefGrid reliefOf(const Points& points, const Eigen::Isometry3d& correction) const;
  ReliefSpectra spectraOf(const ReliefGrid& relief) const;
  void searchHeading(double turn, std::vector<ReliefPeak>& found);
  std::vector<ReliefPeak> peaksOf(const Eigen::ArrayXXd& correlations, const Eigen::ArrayXXd& likelihoods,
                                  const Eigen::Isometry3d& turned) const;
  double logTrials() const;

  const Points& moving_;
  ReliefBounds bounds_;
  GridGeometry geometry_;
  Eigen::Index padded_rows_ = 0, padded_cols_ = 0;
  Eigen::Index reach_ = 0;  // largest shift [cells]
  double step_ = 0;         // between headings [rad]
  double turns_ = 0;        // steps either way
  ReliefGrid reference_;
  ReliefSpectra spectra_;
  double area_ = 1;  // in which heights are alike [cells], mean of the headings searched
};

}  // namespace pcl_fft_ground::core
