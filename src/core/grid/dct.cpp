#include "grid/dct.h"

#include <algorithm>
#include <cmath>

namespace pcl_fft_ground::core {
namespace {

/// A length so short is not halved any more: summing it up is faster.
constexpr Eigen::Index LARGEST_EVEN_BASE = 4;

/// cos(pi numerator / denominator), the numerator brought into one period first.
double cosineOf(Eigen::Index numerator, Eigen::Index denominator) {
  return std::cos(M_PI * static_cast<double>(numerator % (2 * denominator)) /
                  static_cast<double>(denominator));
}

}  // namespace

template <typename Number>
Dct<Number>::Dct(Eigen::Index length)
    : length_(length),
      base_(length),
      scales_(Line::Constant(length, static_cast<Number>(std::sqrt(2.0 / static_cast<double>(length))))),
      cosines_(length),
      sines_(length) {
  scales_[0] = static_cast<Number>(std::sqrt(1.0 / static_cast<double>(length)));
  while (base_ % 2 == 0 && base_ > LARGEST_EVEN_BASE) base_ /= 2;
  for (Eigen::Index n = length; n > base_; n /= 2)
    for (Eigen::Index i = 0; i < n / 2; ++i) {
      cosines_[n / 2 + i] = static_cast<Number>(cosineOf(2 * i + 1, 4 * n));
      sines_[n / 2 + i] = static_cast<Number>(cosineOf(2 * n - 2 * i - 1, 4 * n));
    }
  second_.resize(base_, base_);
  fourth_.resize(base_, base_);
  for (Eigen::Index k = 0; k < base_; ++k)
    for (Eigen::Index i = 0; i < base_; ++i) {
      second_(i, k) = static_cast<Number>(cosineOf((2 * i + 1) * k, 2 * base_));
      fourth_(i, k) = static_cast<Number>(cosineOf((2 * i + 1) * (2 * k + 1), 4 * base_));
    }
}

/// The sums of mirrored values give the even coefficients, their differences the odd ones.
template <typename Number>
void Dct<Number>::secondOfBase(Lanes* values, Lanes* scratch) const {
  const Eigen::Index half = base_ / 2, rest = base_ - half;
  for (Eigen::Index i = 0; i < half; ++i) {
    scratch[i] = values[i] + values[base_ - 1 - i];
    scratch[rest + i] = values[i] - values[base_ - 1 - i];
  }
  if (rest > half) scratch[half] = values[half];
  for (Eigen::Index k = 0; k < base_; ++k) {
    const Lanes* part = k % 2 == 0 ? scratch : scratch + rest;
    Lanes sum = Lanes::Zero();
    for (Eigen::Index i = 0; i < (k % 2 == 0 ? rest : half); ++i) sum += part[i] * second_(i, k);
    values[k] = sum;
  }
}

template <typename Number>
void Dct<Number>::secondOfBaseTransposed(Lanes* values, Lanes* scratch) const {
  for (Eigen::Index i = 0; i < (base_ + 1) / 2; ++i) {
    Lanes even = values[0], odd = Lanes::Zero();
    for (Eigen::Index k = 1; k < base_; k += 2) odd += values[k] * second_(i, k);
    for (Eigen::Index k = 2; k < base_; k += 2) even += values[k] * second_(i, k);
    scratch[base_ - 1 - i] = even - odd;
    scratch[i] = even + odd;
  }
  std::copy(scratch, scratch + base_, values);
}

template <typename Number>
void Dct<Number>::fourthOfBase(Lanes* values, Lanes* scratch) const {
  for (Eigen::Index k = 0; k < base_; ++k) {
    Lanes sum = values[0] * fourth_(0, k);
    for (Eigen::Index i = 1; i < base_; ++i) sum += values[i] * fourth_(i, k);
    scratch[k] = sum;
  }
  std::copy(scratch, scratch + base_, values);
}

/// The even coefficients are the transform of the sums of mirrored values, the odd ones the DCT-IV of their
/// differences.
template <typename Number>
void Dct<Number>::second(Lanes* values, Lanes* scratch, Eigen::Index length) const {
  if (length == base_) return secondOfBase(values, scratch);
  const Eigen::Index half = length / 2;
  Lanes* const other = scratch + half;
  for (Eigen::Index i = 0; i < half; ++i) {
    const Lanes first = values[i], last = values[length - 1 - i];
    scratch[i] = first + last;
    other[i] = first - last;
  }
  second(scratch, values, half);
  fourth(other, values, half);
  for (Eigen::Index k = 0; k < half; ++k) {
    values[2 * k] = scratch[k];
    values[2 * k + 1] = other[k];
  }
}

/// The steps of second() transposed, the last one first; the DCT-IV is symmetric.
template <typename Number>
void Dct<Number>::secondTransposed(Lanes* values, Lanes* scratch, Eigen::Index length) const {
  if (length == base_) return secondOfBaseTransposed(values, scratch);
  const Eigen::Index half = length / 2;
  Lanes* const other = scratch + half;
  for (Eigen::Index k = 0; k < half; ++k) {
    scratch[k] = values[2 * k];
    other[k] = values[2 * k + 1];
  }
  secondTransposed(scratch, values, half);
  fourth(other, values, half);
  for (Eigen::Index i = 0; i < half; ++i) {
    values[i] = scratch[i] + other[i];
    values[length - 1 - i] = scratch[i] - other[i];
  }
}

/// DCT-IV, sum_i values_i cos(pi (2 i + 1) (2 k + 1) / (4 n)): mirrored values rotated, then the sums and
/// differences of two transforms of half the length.
template <typename Number>
void Dct<Number>::fourth(Lanes* values, Lanes* scratch, Eigen::Index length) const {
  if (length == base_) return fourthOfBase(values, scratch);
  const Eigen::Index half = length / 2;
  const Number *cosines = cosines_.data() + half, *sines = sines_.data() + half;
  Lanes* const other = scratch + half;
  for (Eigen::Index i = 0; i < half; ++i) {
    const Lanes first = values[i], last = values[length - 1 - i];
    const Number sign = i % 2 == 0 ? Number(1) : Number(-1);
    scratch[i] = first * cosines[i] + last * sines[i];
    other[i] = last * (sign * cosines[i]) - first * (sign * sines[i]);
  }
  second(scratch, values, half);
  second(other, values, half);
  values[0] = scratch[0];
  for (Eigen::Index k = 1; k < half; ++k) {
    values[2 * k - 1] = scratch[k] - other[half - k];
    values[2 * k] = scratch[k] + other[half - k];
  }
  values[length - 1] = -other[0];
}

template <typename Number>
void Dct<Number>::forward(Lanes* values, Lanes* scratch) const {
  second(values, scratch, length_);
  for (Eigen::Index k = 0; k < length_; ++k) values[k] *= scales_[k];
}

template <typename Number>
void Dct<Number>::inverse(Lanes* values, Lanes* scratch) const {
  for (Eigen::Index k = 0; k < length_; ++k) values[k] *= scales_[k];
  secondTransposed(values, scratch, length_);
}

template class Dct<float>;
template class Dct<double>;

}  // namespace pcl_fft_ground::core
