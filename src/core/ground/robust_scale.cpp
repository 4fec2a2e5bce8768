#include "ground/robust_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl_fft_ground::core {
namespace {

constexpr double NORMAL_FROM_MEDIAN = 1.4826;
constexpr int BINS = 256;
using Histogram = std::array<double, BINS>;

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double quantile(std::vector<double>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Smoothed with a Hann window of 17 bins.
Histogram smoothed(const Histogram& counts) {
  constexpr int HALF = 8;
  Histogram result{};
  for (int i = 0; i < BINS; ++i)
    for (int k = std::max(-HALF, -i); k <= std::min(HALF, BINS - 1 - i); ++k) {
      const int near = i + k;
      result[static_cast<std::size_t>(i)] +=
          (0.5 + 0.5 * std::cos(M_PI * k / HALF)) * counts[static_cast<std::size_t>(near)];
    }
  return result;
}

/// The lowest peak of at least a third of the highest one.
std::size_t lowestPeak(const Histogram& counts) {
  constexpr double SIGNIFICANT = 0.35;
  const auto highest = std::max_element(counts.begin(), counts.end());
  for (std::size_t i = 1; i + 1 < counts.size(); ++i)
    if (counts[i] >= counts[i - 1] && counts[i] > counts[i + 1] && counts[i] > SIGNIFICANT * *highest)
      return i;
  return static_cast<std::size_t>(highest - counts.begin());
}

}  // namespace

Spread medianSpread(std::vector<float>& values, RadixSort& sort) {
  if (values.empty()) return {};
  sort(values);
  const std::size_t half = values.size() / 2;
  const float centre = values[half];
  // The nearer half of the sorted values is the window about the centre that reaches least far from it.
  float distance = std::numeric_limits<float>::infinity();
  for (std::size_t n = 0; n + half < values.size(); ++n)
    distance = std::min(distance, std::max(centre - values[n], values[n + half] - centre));
  return {static_cast<double>(centre), NORMAL_FROM_MEDIAN * static_cast<double>(distance)};
}

Spread lowestMode(const std::vector<double>& values, double reach) {
  constexpr double TAIL = 0.005;
  std::vector<double> sorted = values;
  const double low = std::max(quantile(sorted, TAIL), -reach);
  const double high = std::min(quantile(sorted, 1 - TAIL), reach);
  if (!(high > low)) return {low, 0};
  const double bin = (high - low) / BINS;
  Histogram counts{};
  for (const double value : values)
    if (value >= low && value <= high)
      ++counts[static_cast<std::size_t>(std::min((value - low) / bin, BINS - 1.0))];
  const double mode = low + (static_cast<double>(lowestPeak(smoothed(counts))) + 0.5) * bin;

  std::vector<double> depths;
  for (const double value : values)
    if (value >= low && value < mode) depths.push_back(mode - value);
  return {mode, depths.empty() ? 0 : NORMAL_FROM_MEDIAN * median(depths)};
}

}  // namespace pcl_fft_ground::core
