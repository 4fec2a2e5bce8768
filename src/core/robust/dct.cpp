#include "robust/dct.h"

#include <algorithm>
#include <cmath>

namespace pcl_fft_ground::core {
namespace {

/// A length so short is not halved any more: summing it up is faster.
constexpr Eigen::Index LARGEST_EVEN_BASE = 4;

}  // namespace

Dct::Dct(Eigen::Index length)
    : length_(length),
      base_(length),
      scales_(static_cast<std::size_t>(length), std::sqrt(2.0 / static_cast<double>(length))),
      scratch_(scales_.size()) {
  scales_.front() = std::sqrt(1.0 / static_cast<double>(length));
  while (base_ % 2 == 0 && base_ > LARGEST_EVEN_BASE) base_ /= 2;
  secants_.resize(scales_.size());
  for (Eigen::Index n = length; n > base_; n /= 2)
    for (Eigen::Index i = 0; i < n / 2; ++i)
      secants_[static_cast<std::size_t>(n / 2 + i)] =
          0.5 / std::cos(M_PI * static_cast<double>(2 * i + 1) / static_cast<double>(2 * n));
  cosines_.resize(base_, base_);
  for (Eigen::Index i = 0; i < base_; ++i)
    for (Eigen::Index k = 0; k < base_; ++k)
      cosines_(k, i) = std::cos(M_PI * static_cast<double>((2 * i + 1) * k % (4 * base_)) /
                                static_cast<double>(2 * base_));
}

/// Sums and scaled differences of mirrored values; the transform of those, halved in length, are the even
/// coefficients and, two neighbours added, the odd ones.
void Dct::transform(Lanes* values, Lanes* scratch, Eigen::Index length) const {
  if (length == base_) {
    for (Eigen::Index k = 0; k < base_; ++k) {
      scratch[k] = values[0] * cosines_(k, 0);
      for (Eigen::Index i = 1; i < base_; ++i) scratch[k] += values[i] * cosines_(k, i);
    }
    std::copy(scratch, scratch + base_, values);
    return;
  }
  const Eigen::Index half = length / 2;
  const double* secants = secants_.data() + half;
  Lanes* const other = scratch + half;
  for (Eigen::Index i = 0; i < half; ++i) {
    const Lanes first = values[i], last = values[length - 1 - i];
    scratch[i] = first + last;
    other[i] = (first - last) * secants[i];
  }
  transform(scratch, values, half);
  transform(other, values, half);
  for (Eigen::Index k = 0; k < half; ++k) {
    values[2 * k] = scratch[k];
    values[2 * k + 1] = k + 1 < half ? Lanes(other[k] + other[k + 1]) : other[k];
  }
}

/// The steps of transform() transposed, the last one first.
void Dct::transposed(Lanes* values, Lanes* scratch, Eigen::Index length) const {
  if (length == base_) {
    for (Eigen::Index i = 0; i < base_; ++i) {
      scratch[i] = values[0];
      for (Eigen::Index k = 1; k < base_; ++k) scratch[i] += values[k] * cosines_(k, i);
    }
    std::copy(scratch, scratch + base_, values);
    return;
  }
  const Eigen::Index half = length / 2;
  const double* secants = secants_.data() + half;
  Lanes* const other = scratch + half;
  for (Eigen::Index k = 0; k < half; ++k) {
    scratch[k] = values[2 * k];
    other[k] = k > 0 ? Lanes(values[2 * k + 1] + values[2 * k - 1]) : values[1];
  }
  transposed(scratch, values, half);
  transposed(other, values, half);
  for (Eigen::Index i = 0; i < half; ++i) {
    const Lanes base_part = other[i] * secants[i];
    values[i] = scratch[i] + base_part;
    values[length - 1 - i] = scratch[i] - base_part;
  }
}

void Dct::forward(Lanes* values) {
  transform(values, scratch_.data(), length_);
  for (std::size_t k = 0; k < scales_.size(); ++k) values[k] *= scales_[k];
}

void Dct::inverse(Lanes* values) {
  for (std::size_t k = 0; k < scales_.size(); ++k) values[k] *= scales_[k];
  transposed(values, scratch_.data(), length_);
}

Dct2d::Dct2d(Eigen::Index rows, Eigen::Index cols)
    : along_rows_(rows),
      along_cols_(cols),
      lines_(static_cast<std::size_t>(std::max(rows, cols)), Dct::Lanes::Zero()) {}

void Dct2d::eachColumn(Eigen::ArrayXXd& grid, Transform transform) {
  for (Eigen::Index j = 0; j < grid.cols(); j += Dct::Lanes::SizeAtCompileTime) {
    const Eigen::Index lanes = std::min<Eigen::Index>(Dct::Lanes::SizeAtCompileTime, grid.cols() - j);
    Eigen::Map<Eigen::ArrayXXd> lines(lines_.data()->data(), Dct::Lanes::SizeAtCompileTime, grid.rows());
    lines.topRows(lanes) = grid.middleCols(j, lanes).transpose();
    (along_rows_.*transform)(lines_.data());
    grid.middleCols(j, lanes) = lines.topRows(lanes).transpose();
  }
}

void Dct2d::eachRow(Eigen::ArrayXXd& grid, Transform transform) {
  for (Eigen::Index i = 0; i < grid.rows(); i += Dct::Lanes::SizeAtCompileTime) {
    const Eigen::Index lanes = std::min<Eigen::Index>(Dct::Lanes::SizeAtCompileTime, grid.rows() - i);
    Eigen::Map<Eigen::ArrayXXd> lines(lines_.data()->data(), Dct::Lanes::SizeAtCompileTime, grid.cols());
    lines.topRows(lanes) = grid.middleRows(i, lanes);
    (along_cols_.*transform)(lines_.data());
    grid.middleRows(i, lanes) = lines.topRows(lanes);
  }
}

void Dct2d::forward(Eigen::ArrayXXd& grid) {
  eachColumn(grid, &Dct::forward);
  eachRow(grid, &Dct::forward);
}

void Dct2d::inverse(Eigen::ArrayXXd& coefficients) {
  eachRow(coefficients, &Dct::inverse);
  eachColumn(coefficients, &Dct::inverse);
}

Eigen::Index fastDctLength(Eigen::Index length) {
  constexpr Eigen::Index LARGEST_ODD_FACTOR = 15;
  Eigen::Index step = 1;
  while (length > (LARGEST_ODD_FACTOR + 1) * step) step *= 2;
  return (length + step - 1) / step * step;
}

}  // namespace pcl_fft_ground::core
