#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pcl_fft_ground/core/export.h"

namespace pcl_fft_ground::core {

/// A local maximum of the spectrum's magnitude.
struct SpectrumPeak {
  Eigen::Index k = 0;    ///< bin along x, [0, rows)
  Eigen::Index l = 0;    ///< bin along y, [0, cols)
  double radius = 0;     ///< distance from DC, ratio of the Nyquist range, (0, sqrt 2]
  double magnitude = 0;  ///< magnitude of the bin [m]
};

/// Settings of findSpectrumPeaks().
struct PeakParameters {
  unsigned half_window = 1;  ///< k: the window is (2k + 1) x (2k + 1) bins, >= 1; 1 is eight-connected
  double threshold = 0.0;    ///< c: by how much a peak exceeds every other bin of its window [m], >= 0
};

/** The peaks of a spectrum, eq. (3).
 *
 * A bin is a peak if its magnitude exceeds that of every other bin of its window by more than c. The window
 * is periodic. DC is neither a candidate nor compared; a bin is not compared with its own conjugate;
 * magnitudes below 1e-9 of the largest beside DC, or below 1e-13 of DC, are rounding errors and count as
 * zero.
 *
 * \param magnitude magnitudes of all bins of a real grid, DC at (0, 0): bin (k, l) equals bin (rows - k, cols
 * - l)
 * \return the peaks, both of each conjugate pair, by falling wavelength: sorted by radius, then l, then
 * k
 */
PCL_FFT_GROUND_CORE_EXPORT std::vector<SpectrumPeak> findSpectrumPeaks(Eigen::ArrayXXd magnitude,
                                                                       const PeakParameters& parameters);

/// Where a cut-off frequency comes from.
enum class CutoffSource {
  PEAK,               ///< a peak of the spectrum
  FALLBACK,           ///< the largest object alone, as no peak qualified
  GIVEN,              ///< the user
  FINEST_WAVELENGTH,  ///< the shortest wavelength of a fitted ground
};

/// A cut-off frequency and how it came about.
struct Cutoff {
  double frequency = 0;              ///< f_c, ratio of the Nyquist range, (0, sqrt 2]
  double object_size = 0;            ///< m_c = 2 cell_size / f_c [m], eq. (4): larger objects count as ground
  std::optional<SpectrumPeak> peak;  ///< the peak that gave it, if one did
  CutoffSource source = CutoffSource::FALLBACK;
};

/// The size in metres of the largest object that a cut-off frequency keeps out of the ground, eq. (4).
PCL_FFT_GROUND_CORE_EXPORT double largestObject(double cutoff, double cell_size);

/** The cut-off frequency of Sec. IV-B2: the peak closest to DC whose m_c does not exceed the largest object.
 *
 * Where no peak qualifies, f_c = min(sqrt 2, 2 cell_size / max_object_size), and the source is FALLBACK.
 *
 * \param peaks sorted by radius, see findSpectrumPeaks()
 * \param cell_size [m], > 0
 * \param max_object_size m_u e [m], >= 0
 */
PCL_FFT_GROUND_CORE_EXPORT Cutoff selectCutoff(const std::vector<SpectrumPeak>& peaks, double cell_size,
                                               double max_object_size);

}  // namespace pcl_fft_ground::core
