#pragma once

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/ground/spectrum.h"

namespace pcl_fft_ground::core {

/// Butterworth-like low-pass filter of eq. (1), with the sign mended: as printed it has a pole.
struct Butterworth {
  double cutoff = 1.0;           ///< f_c, ratio of the Nyquist range, (0, sqrt 2]
  unsigned order = 2;            ///< n, >= 1
  double passband_ripple = 3.0;  ///< A, attenuation at the cut-off [dB], > 0

  /** |T| = 1 / sqrt(1 + eps^2 (r / f_c)^(2 n)), eps^2 = 10^(A / 10) - 1.
   * \param radius distance from DC as a ratio of the Nyquist range, see binRadius()
   */
  PCL_FFT_GROUND_CORE_EXPORT double response(double radius) const;
};

/// The spectrum with each bin multiplied by the filter's response at its (elliptical, eq. 2) radius.
PCL_FFT_GROUND_CORE_EXPORT Spectrum filtered(Spectrum spectrum, const Butterworth& filter);

}  // namespace pcl_fft_ground::core
