#pragma once

#include <optional>
#include <vector>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/grid/elevation_grid.h"
#include "pcl_fft_ground/core/ground/butterworth.h"
#include "pcl_fft_ground/core/ground/cutoff.h"
#include "pcl_fft_ground/core/ground/ground_surface.h"
#include "pcl_fft_ground/core/ground/spectrum.h"

namespace pcl_fft_ground::core {

/// Whether the axes of the grid are lengthened for the transform.
enum class GridLengths {
  SMOOTH,  ///< to the next product of 2, 3 and 5: the fast lengths
  EXACT,   ///< not at all
};

/// Settings of estimateLowPassGround(); the defaults are the paper's.
struct LowPassParameters {
  double cell_size = 0.02;                 ///< side of an elevation cell [m], > 0
  double relative_max_object_size = 0.5;   ///< m_u: largest object as a share of the scan's extent, (0, 1]
  std::optional<double> max_object_size;   ///< largest object [m], > 0; takes the place of m_u
  std::optional<double> cutoff_frequency;  ///< f_c, (0, sqrt 2], instead of the automatic one
  unsigned filter_order = 2;               ///< n of eq. (1), >= 1
  double passband_ripple = 3.0;            ///< A of eq. (1) [dB], > 0
  PeakParameters peaks;                    ///< window and threshold of eq. (3)
  GridLengths grid_lengths = GridLengths::SMOOTH;  ///< whether the axes are lengthened
};

/// The ground of a scan and everything that led to it.
struct LowPassGround {
  ElevationGrid elevation;          ///< highest point of each cell
  double extent = 0;                ///< e: smaller horizontal extent of the points [m]
  double max_object_size = 0;       ///< m_u e, or the size given [m]
  Spectrum spectrum;                ///< of the elevation, before the filter
  std::vector<SpectrumPeak> peaks;  ///< all peaks, by radius
  Cutoff cutoff;                    ///< the cut-off frequency and its origin
  Butterworth filter;               ///< the filter that was applied
  GroundSurface surface;            ///< the ground

  /// The spectrum after the filter.
  Spectrum filteredSpectrum() const { return filtered(spectrum, filter); }
};

/** The ground of a level scan as published (Sec. IV): elevation grid, DFT, cut-off, low-pass, inverse DFT.
 *
 * \param points points in the level frame, at least one
 * \param frame_from_input the transform that brought them there, kept in the surface
 * \throws std::length_error if the grid would have more than MAX_CELLS cells
 * \note O(points + cells log cells) time, about 32 bytes a cell
 */
PCL_FFT_GROUND_CORE_EXPORT LowPassGround estimateLowPassGround(const PointsView& points,
                                                               const Eigen::Isometry3d& frame_from_input,
                                                               const LowPassParameters& parameters);

}  // namespace pcl_fft_ground::core
