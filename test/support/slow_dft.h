#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <vector>

namespace pcl_fft_ground::test {

/// exp(sign 2 pi i n / length) for n = 0 .. length - 1.
inline std::vector<std::complex<double>> rootsOfUnity(Eigen::Index length, int sign) {
  std::vector<std::complex<double>> roots;
  for (Eigen::Index n = 0; n < length; ++n)
    roots.push_back(std::polar(1.0, sign * 2 * M_PI * static_cast<double>(n) / static_cast<double>(length)));
  return roots;
}

/// Sum over the first axis of in(i, j) exp(sign 2 pi i k i / rows), term by term.
inline Eigen::ArrayXXcd slowTransformOfColumns(const Eigen::ArrayXXcd& in, int sign) {
  const std::vector<std::complex<double>> roots = rootsOfUnity(in.rows(), sign);
  Eigen::ArrayXXcd out = Eigen::ArrayXXcd::Zero(in.rows(), in.cols());
  for (Eigen::Index j = 0; j < in.cols(); ++j)
    for (Eigen::Index k = 0; k < in.rows(); ++k)
      for (Eigen::Index i = 0; i < in.rows(); ++i)
        out(k, j) += in(i, j) * roots[static_cast<std::size_t>(i * k % in.rows())];
  return out;
}

/// All bins of the discrete Fourier transform, by its definition: O(n^2) for an axis of n cells.
inline Eigen::ArrayXXcd slowDft(const Eigen::ArrayXXcd& grid) {
  const Eigen::ArrayXXcd columns = slowTransformOfColumns(grid, -1);
  return slowTransformOfColumns(columns.transpose(), -1).transpose();
}

/// The grid of which these are all bins.
inline Eigen::ArrayXXcd slowInverseDft(const Eigen::ArrayXXcd& bins) {
  const Eigen::ArrayXXcd columns = slowTransformOfColumns(bins, 1);
  const Eigen::ArrayXXcd sums = slowTransformOfColumns(columns.transpose(), 1).transpose();
  return sums / static_cast<double>(bins.size());
}

/// Cycles per cell of a bin as a ratio of Nyquist's: bins beyond the middle are negative frequencies.
inline double nyquistRatio(Eigen::Index bin, Eigen::Index length) {
  const Eigen::Index signed_bin = 2 * bin > length ? bin - length : bin;
  return 2.0 * static_cast<double>(signed_bin) / static_cast<double>(length);
}

}  // namespace pcl_fft_ground::test
