#pragma once

#include <Eigen/Core>

#include "pcl_fft_ground/core/export.h"

namespace pcl_fft_ground::core {

/** Discrete Fourier transform of a real grid of `rows` x `cols` cells.
 *
 * Bin (k, l) holds sum_ij y_ij exp(-2 pi i (i k / rows + j l / cols)). As the grid is real, bin (rows - k,
 * cols - l) is the conjugate of bin (k, l), and only the bins k = 0 .. rows / 2 are stored.
 */
struct Spectrum {
  Eigen::Index rows = 0;  ///< length of the grid along x
  Eigen::ArrayXXcd half;  ///< bins [0, rows / 2] x [0, cols) [m]
  Eigen::Index cols() const { return half.cols(); }
};

/** Distance from DC of a bin as a ratio of the Nyquist range (eq. 2 with f_c = 1): sqrt((2 k / rows)^2 + (2 l
 * / cols)^2).
 *
 * \param k,l bin, in [0, rows) and [0, cols); bins beyond the middle count from the other end
 * \return ratio in [0, sqrt 2]
 */
PCL_FFT_GROUND_CORE_EXPORT double binRadius(Eigen::Index k, Eigen::Index l, Eigen::Index rows,
                                            Eigen::Index cols);

/// Discrete Fourier transform of a grid. O(cells log(cells)) for every size, primes included.
PCL_FFT_GROUND_CORE_EXPORT Spectrum forwardTransform(const Eigen::ArrayXXd& grid);

/// The grid that has this spectrum. A spectrum that is moved in serves as work space.
PCL_FFT_GROUND_CORE_EXPORT Eigen::ArrayXXd inverseTransform(Spectrum spectrum);

/// Magnitudes of all bins, the conjugate half included: rows x cols, DC at (0, 0).
PCL_FFT_GROUND_CORE_EXPORT Eigen::ArrayXXd magnitude(const Spectrum& spectrum);

/// The smallest length of at least `length` whose only prime factors are 2, 3 and 5.
PCL_FFT_GROUND_CORE_EXPORT Eigen::Index smoothLength(Eigen::Index length);

}  // namespace pcl_fft_ground::core
