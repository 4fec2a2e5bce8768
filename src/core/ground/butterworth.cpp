#include "pcl_fft_ground/core/ground/butterworth.h"

#include <algorithm>
#include <cmath>

namespace pcl_fft_ground::core {

namespace {

double integerPower(double base, unsigned exponent) {
  double result = 1;
  for (; exponent > 0; exponent /= 2, base *= base)
    if (exponent % 2 == 1) result *= base;
  return result;
}

/// (2 k / length)^2 of every bin of an axis, see binRadius().
Eigen::ArrayXd squaredRatios(Eigen::Index bins, Eigen::Index length) {
  Eigen::ArrayXd result(bins);
  for (Eigen::Index k = 0; k < bins; ++k) result[k] = std::pow(binRadius(k, 0, length, 1), 2);
  return result;
}

/// eps^2 of eq. (1).
double squaredBandEdge(const Butterworth& filter) {
  return std::pow(10.0, filter.passband_ripple / 10) - 1;
}

}  // namespace

double Butterworth::response(double radius) const {
  const double ratio = radius / cutoff;
  return 1 / std::sqrt(1 + squaredBandEdge(*this) * integerPower(ratio * ratio, order));
}

Spectrum filtered(Spectrum spectrum, const Butterworth& filter) {
  constexpr double LEAST_CUTOFF = 1e-150;  // has a square
  const double squared_cutoff = std::pow(std::max(filter.cutoff, LEAST_CUTOFF), 2);
  const Eigen::ArrayXd x = squaredRatios(spectrum.half.rows(), spectrum.rows) / squared_cutoff;
  const Eigen::ArrayXd y = squaredRatios(spectrum.cols(), spectrum.cols()) / squared_cutoff;
  const double band_edge = squaredBandEdge(filter);
  for (Eigen::Index l = 0; l < spectrum.cols(); ++l)
    for (Eigen::Index k = 0; k < spectrum.half.rows(); ++k)
      spectrum.half(k, l) /= std::sqrt(1 + band_edge * integerPower(x[k] + y[l], filter.order));
  return spectrum;
}

}  // namespace pcl_fft_ground::core
