#include "dct.h"

#include <cmath>

namespace pcl_fft_ground::core {

Dct::Dct(Eigen::Index length)
    : length_(length),
      fft_(static_cast<int>(length)),
      twiddles_(static_cast<std::size_t>(length)),
      line_(twiddles_.size()),
      bins_(twiddles_.size()),
      unused_(twiddles_.size()) {
  const auto n = static_cast<double>(length);
  for (std::size_t k = 0; k < twiddles_.size(); ++k)
    twiddles_[k] = std::polar(std::sqrt((k == 0 ? 1.0 : 2.0) / n), -0.5 * M_PI * static_cast<double>(k) / n);
}

void Dct::forward(Eigen::ArrayXXd& lines) {
  for (Eigen::Index j = 0; j < lines.cols(); j += 2)
    forwardPair(lines.col(j).data(), j + 1 < lines.cols() ? lines.col(j + 1).data() : unused_.data());
}

void Dct::inverse(Eigen::ArrayXXd& lines) {
  for (Eigen::Index j = 0; j < lines.cols(); j += 2)
    inversePair(lines.col(j).data(), j + 1 < lines.cols() ? lines.col(j + 1).data() : unused_.data());
}

/// Even samples in order, then odd ones backwards: the DFT of that line, turned by a quarter sample, is the
/// DCT. One line is the real, the other the imaginary part.
void Dct::forwardPair(double* first, double* second) {
  const auto n = static_cast<std::size_t>(length_);
  for (std::size_t i = 0; 2 * i < n; ++i) line_[i] = {first[2 * i], second[2 * i]};
  for (std::size_t i = 0; 2 * i + 1 < n; ++i) line_[n - 1 - i] = {first[2 * i + 1], second[2 * i + 1]};
  fft_.forward(line_.data(), bins_.data());
  for (std::size_t k = 0; k < n; ++k) {
    const Complex here = bins_[k], there = bins_[k == 0 ? 0 : n - k], t = twiddles_[k];
    const double sum_re = 0.5 * (here.real() + there.real()), sum_im = 0.5 * (here.imag() + there.imag());
    const double gap_re = 0.5 * (here.real() - there.real()), gap_im = 0.5 * (here.imag() - there.imag());
    first[k] = t.real() * sum_re - t.imag() * gap_im;
    second[k] = t.real() * sum_im + t.imag() * gap_re;
  }
}

/// Of a real line the turned bin k is coefficient k - i coefficient (N - k).
void Dct::inversePair(double* first, double* second) {
  const auto n = static_cast<std::size_t>(length_);
  const double scale = static_cast<double>(n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t mirrored = k == 0 ? 0 : n - k;
    const double a = first[k], b = second[k];
    const double c = k == 0 ? 0 : first[mirrored], d = k == 0 ? 0 : second[mirrored];
    // |twiddle|^2 is 2 / N (1 / N for k = 0); the plain bin is the coefficient over c_k.
    const double weight = k == 0 ? scale : 0.5 * scale;
    const double re = weight * twiddles_[k].real(), im = -weight * twiddles_[k].imag();
    bins_[k] = {re * (a + d) - im * (b - c), re * (b - c) + im * (a + d)};
  }
  fft_.inverse(bins_.data(), line_.data());
  for (std::size_t i = 0; 2 * i < n; ++i) first[2 * i] = line_[i].real(), second[2 * i] = line_[i].imag();
  for (std::size_t i = 0; 2 * i + 1 < n; ++i)
    first[2 * i + 1] = line_[n - 1 - i].real(), second[2 * i + 1] = line_[n - 1 - i].imag();
}

Dct2d::Dct2d(Eigen::Index rows, Eigen::Index cols)
    : along_rows_(rows), along_cols_(cols), transposed_(cols, rows) {}

void Dct2d::forward(Eigen::ArrayXXd& grid) {
  along_rows_.forward(grid);
  transposed_ = grid.transpose();
  along_cols_.forward(transposed_);
  grid = transposed_.transpose();
}

void Dct2d::inverse(Eigen::ArrayXXd& coefficients) {
  transposed_ = coefficients.transpose();
  along_cols_.inverse(transposed_);
  coefficients = transposed_.transpose();
  along_rows_.inverse(coefficients);
}

}  // namespace pcl_fft_ground::core
