#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "fft.h"

namespace pcl_fft_ground::core {

/** Orthonormal cosine transform (DCT-II) of real lines of one length, and its inverse (DCT-III).
 *
 * Coefficient k of a line x is c_k sum_i x_i cos(pi (2 i + 1) k / (2 N)), c_0 = sqrt(1 / N), c_k = sqrt(2 /
 * N): the line continues evenly beyond its ends, without wrap-around. Two lines at a time go through one
 * complex FFT of their length (Makhoul 1980): O(N log N) for every N. An object holds its scratch space: one
 * per thread.
 */
class Dct {
 public:
  explicit Dct(Eigen::Index length);

  /// Transforms every column of `lines` in place.
  void forward(Eigen::ArrayXXd& lines);

  /// Undoes forward().
  void inverse(Eigen::ArrayXXd& lines);

 private:
  using Complex = std::complex<double>;

  void forwardPair(double* first, double* second);
  void inversePair(double* first, double* second);

  Eigen::Index length_;
  Fft fft_;
  std::vector<Complex> twiddles_;  // c_k exp(-pi i k / (2 N))
  std::vector<Complex> line_, bins_;
  std::vector<double> unused_;  // partner of the last line of an odd number
};

/// Orthonormal cosine transform of grids of one size, in place.
class Dct2d {
 public:
  Dct2d(Eigen::Index rows, Eigen::Index cols);

  /// Coefficient (k, l) belongs to k half waves along the rows and l along the columns.
  void forward(Eigen::ArrayXXd& grid);

  /// Undoes forward().
  void inverse(Eigen::ArrayXXd& coefficients);

 private:
  Dct along_rows_, along_cols_;
  Eigen::ArrayXXd transposed_;
};

}  // namespace pcl_fft_ground::core
