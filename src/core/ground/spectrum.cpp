#include "pcl_fft_ground/core/ground/spectrum.h"

#include <algorithm>
#include <cmath>

#include "grid/fft.h"

namespace pcl_fft_ground::core {
namespace {

using Complex = std::complex<double>;
using Line = Eigen::ArrayXcd;

constexpr Complex I(0.0, 1.0);

/// The other bin of a conjugate pair along one axis.
Eigen::Index mirrored(Eigen::Index bin, Eigen::Index length) {
  return bin == 0 ? 0 : length - bin;
}

/// Transforms along x, two real columns at a time: one is the real, the other the imaginary part of a complex
/// line.
void transformColumns(const Eigen::ArrayXXd& grid, Eigen::ArrayXXcd& half) {
  const Eigen::Index rows = grid.rows();
  Fft fft(static_cast<int>(rows));
  Line line(rows), bins(rows);
  for (Eigen::Index j = 0; j < grid.cols(); j += 2) {
    const bool pair = j + 1 < grid.cols();
    line.real() = grid.col(j);
    if (pair)
      line.imag() = grid.col(j + 1);
    else
      line.imag().setZero();
    fft.forward(line.data(), bins.data());
    for (Eigen::Index k = 0; k < half.rows(); ++k) {
      const Complex here = bins[k], there = std::conj(bins[mirrored(k, rows)]);
      half(k, j) = 0.5 * (here + there);
      if (pair) half(k, j + 1) = -0.5 * I * (here - there);
    }
  }
}

/// Undoes transformColumns().
void inverseTransformColumns(const Eigen::ArrayXXcd& half, Eigen::ArrayXXd& grid) {
  const Eigen::Index rows = grid.rows();
  Fft fft(static_cast<int>(rows));
  Line line(rows), bins(rows);
  for (Eigen::Index j = 0; j < grid.cols(); j += 2) {
    const bool pair = j + 1 < grid.cols();
    for (Eigen::Index k = 0; k < half.rows(); ++k) {
      const Complex first = half(k, j), second = pair ? half(k, j + 1) : 0.0;
      bins[mirrored(k, rows)] = std::conj(first) + I * std::conj(second);
      bins[k] = first + I * second;
    }
    fft.inverse(bins.data(), line.data());
    grid.col(j) = line.real();
    if (pair) grid.col(j + 1) = line.imag();
  }
}

/// Transforms every row of the half spectrum along y in place, some rows at a time to go easy on the cache.
template <typename Transform>
void transformRows(Eigen::ArrayXXcd& half, const Transform& transform) {
  constexpr Eigen::Index BLOCK = 8;
  Eigen::ArrayXXcd lines(half.cols(), BLOCK), bins(half.cols(), BLOCK);
  for (Eigen::Index k = 0; k < half.rows(); k += BLOCK) {
    const Eigen::Index count = std::min(BLOCK, half.rows() - k);
    lines.leftCols(count) = half.middleRows(k, count).transpose();
    for (Eigen::Index b = 0; b < count; ++b) transform(lines.col(b).data(), bins.col(b).data());
    half.middleRows(k, count) = bins.leftCols(count).transpose();
  }
}

}  // namespace

double binRadius(Eigen::Index k, Eigen::Index l, Eigen::Index rows, Eigen::Index cols) {
  const double x = 2.0 * static_cast<double>(std::min(k, rows - k)) / static_cast<double>(rows);
  const double y = 2.0 * static_cast<double>(std::min(l, cols - l)) / static_cast<double>(cols);
  return std::hypot(x, y);
}

Spectrum forwardTransform(const Eigen::ArrayXXd& grid) {
  Spectrum spectrum{grid.rows(), Eigen::ArrayXXcd(grid.rows() / 2 + 1, grid.cols())};
  if (grid.size() == 0) return {};
  transformColumns(grid, spectrum.half);
  Fft fft(static_cast<int>(grid.cols()));
  transformRows(spectrum.half, [&](const Complex* in, Complex* out) { fft.forward(in, out); });
  return spectrum;
}

Eigen::ArrayXXd inverseTransform(Spectrum spectrum) {
  if (spectrum.half.size() == 0) return Eigen::ArrayXXd(spectrum.rows, spectrum.cols());
  Fft fft(static_cast<int>(spectrum.cols()));
  transformRows(spectrum.half, [&](const Complex* in, Complex* out) { fft.inverse(in, out); });
  Eigen::ArrayXXd grid(spectrum.rows, spectrum.cols());
  inverseTransformColumns(spectrum.half, grid);
  return grid;
}

Eigen::ArrayXXd magnitude(const Spectrum& spectrum) {
  const Eigen::Index rows = spectrum.rows, cols = spectrum.cols();
  Eigen::ArrayXXd result(rows, cols);
  for (Eigen::Index l = 0; l < cols; ++l)
    for (Eigen::Index k = 0; k < spectrum.half.rows(); ++k)
      result(k, l) = result(mirrored(k, rows), mirrored(l, cols)) = std::sqrt(std::norm(spectrum.half(k, l)));
  return result;
}

}  // namespace pcl_fft_ground::core
