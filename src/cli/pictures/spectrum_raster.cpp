#include "pictures/spectrum_raster.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace pcl_fft_ground::cli {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::Vector2d;

/// Bin n of a periodic axis.
Index wrapped(Index n, Index size) {
  return ((n % size) + size) % size;
}

/// The ratios of all bins of an axis.
Eigen::ArrayXd ratiosOf(Index size) {
  return Eigen::ArrayXd::NullaryExpr(size, [size](Index bin) { return ratioOf(bin, size); });
}

/// The bins from `first` on that one pixel shows.
struct Bins {
  Index first;
  Index count;
};

/// The bins of each of `pixels` pixels along an axis from `low` to `high`, ratios of Nyquist.
std::vector<Bins> binsOf(double low, double high, Index pixels, Index size) {
  const auto edge = [&](Index pixel) {
    const double ratio = low + (high - low) * static_cast<double>(pixel) / static_cast<double>(pixels);
    return static_cast<Index>(std::floor(0.5 * ratio * static_cast<double>(size) + 0.5));
  };
  std::vector<Bins> bins;
  for (Index pixel = 0; pixel < pixels; ++pixel)
    bins.push_back({edge(pixel), std::max<Index>(1, edge(pixel + 1) - edge(pixel))});
  return bins;
}

}  // namespace

double ratioOf(Index bin, Index size) {
  const Index positive = wrapped(bin, size);
  const Index frequency = 2 * positive >= size + size % 2 ? positive - size : positive;
  return 2.0 * static_cast<double>(frequency) / static_cast<double>(size);
}

double decibel(double magnitude, double reference) {
  return magnitude > 0.0 ? 20.0 * std::log10(magnitude / reference)
                         : -std::numeric_limits<double>::infinity();
}

double referenceOf(const ArrayXXd& magnitudes) {
  double largest = 0.0;
  for (Index k = 1; k < magnitudes.size(); ++k)
    if (std::isfinite(magnitudes.data()[k])) largest = std::max(largest, magnitudes.data()[k]);
  return largest > 0.0 ? largest : 1.0;
}

double floorDecibel(const ArrayXXd& before, double reference) {
  const std::optional<ValueRange> range = robustRange(before, 0.02);
  const double low = range ? decibel(range->low, reference) - 10.0 : -60.0;
  return std::clamp(10.0 * std::floor(low / 10.0), -120.0, -60.0);
}

Pixels spectrumPixels(const ArrayXXd& magnitudes, double span, Index side, double reference,
                      const ColourScale& scale) {
  const std::vector<Bins> along_x = binsOf(-span, span, side, magnitudes.rows());
  const std::vector<Bins> along_y = binsOf(-span, span, side, magnitudes.cols());
  const auto largest = [&](const Bins& x, const Bins& y) {
    double value = 0.0;
    for (Index j = y.first; j < y.first + y.count; ++j)
      for (Index i = x.first; i < x.first + x.count; ++i)
        value = std::max(value, magnitudes(wrapped(i, magnitudes.rows()), wrapped(j, magnitudes.cols())));
    return value;
  };
  Pixels pixels(side, side);
  for (Index j = 0; j < side; ++j)
    for (Index i = 0; i < side; ++i)
      pixels(i, j) = packed(scale.colour(decibel(
          largest(along_x[static_cast<std::size_t>(i)], along_y[static_cast<std::size_t>(j)]), reference)));
  return pixels;
}

std::vector<Vector2d> radialProfile(const ArrayXXd& magnitudes, const Axis& radii, double reference) {
  constexpr Index kRings = 110;
  Eigen::ArrayXd power = Eigen::ArrayXd::Zero(kRings);
  Eigen::ArrayXd bins = Eigen::ArrayXd::Zero(kRings);
  const Eigen::ArrayXd x_squared = ratiosOf(magnitudes.rows()).square();
  const Eigen::ArrayXd y_squared = ratiosOf(magnitudes.cols()).square();
  // The spectrum of real heights is symmetric: half the plane has every ring.
  const Index half = std::min(magnitudes.cols(), magnitudes.cols() / 2 + 1);
  for (Index j = 0; j < half; ++j)
    for (Index i = 0; i < magnitudes.rows(); ++i) {
      const double radius = std::sqrt(x_squared(i) + y_squared(j));
      if (radius <= 0.0 || !std::isfinite(magnitudes(i, j))) continue;
      const auto ring = static_cast<Index>(radii.share(radius) * static_cast<double>(kRings));
      if (ring < 0 || ring >= kRings) continue;
      power(ring) += magnitudes(i, j) * magnitudes(i, j);
      bins(ring) += 1.0;
    }
  std::vector<Vector2d> profile;
  for (Index ring = 0; ring < kRings; ++ring) {
    if (bins(ring) == 0.0) continue;  // at low frequency the rings lie closer than the bins
    const double share = (static_cast<double>(ring) + 0.5) / static_cast<double>(kRings);
    const double level = decibel(std::sqrt(power(ring) / bins(ring)), reference);
    profile.emplace_back(radii.low * std::pow(radii.high / radii.low, share), std::max(level, -400.0));
  }
  return profile;
}

}  // namespace pcl_fft_ground::cli
