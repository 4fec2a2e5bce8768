#include "pictures/raster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pcl_fft_ground::cli {
namespace {

using Eigen::ArrayXXd;
using Eigen::ArrayXXi;
using Eigen::Index;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Calls `merge(block of source cells)` for each cell of a grid of at most max_x x max_y cells.
template <typename Array, typename Merge>
Array reduced(const Array& source, Index max_x, Index max_y, const Merge& merge) {
  Array result(std::min(source.rows(), max_x), std::min(source.cols(), max_y));
  if (result.rows() == source.rows() && result.cols() == source.cols()) return source;
  for (Index j = 0; j < result.cols(); ++j) {
    const CellBlock y = cellBlock(j, result.cols(), source.cols());
    for (Index i = 0; i < result.rows(); ++i) {
      const CellBlock x = cellBlock(i, result.rows(), source.rows());
      result(i, j) = merge(source.block(x.begin, y.begin, x.count, y.count));
    }
  }
  return result;
}

/// The value below which `share` of the given ones lie; reorders them. Needs at least one.
double quantile(std::vector<double>& values, double share) {
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

/// Every n-th finite value, such that there are at most about a million.
std::vector<double> finiteSample(const ArrayXXd& values) {
  constexpr Index kMost = 1'000'000;
  const Index step = values.size() / kMost + 1;
  std::vector<double> sample;
  sample.reserve(static_cast<std::size_t>(values.size() / step + 1));
  for (Index k = 0; k < values.size(); k += step)
    if (std::isfinite(values.data()[k])) sample.push_back(values.data()[k]);
  if (sample.empty() && step > 1)  // the few known cells may lie between the samples
    std::copy_if(values.data(), values.data() + values.size(), std::back_inserter(sample),
                 [](double value) { return std::isfinite(value); });
  return sample;
}

/// Slope at the middle of three heights `spacing` apart, from those that are known.
double slope(double before, double here, double after, double spacing) {
  const bool has_before = std::isfinite(before);
  const bool has_after = std::isfinite(after);
  if (has_before && has_after) return (after - before) / (2.0 * spacing);
  if (has_after) return (after - here) / spacing;
  return has_before ? (here - before) / spacing : 0.0;
}

/// How fast the terrain rises when walking towards the light, NaN where it is not known.
ArrayXXd riseTowardsLight(const ArrayXXd& heights, const Eigen::Vector2d& spacing) {
  const auto at = [&](Index i, Index j) {
    const bool inside = i >= 0 && j >= 0 && i < heights.rows() && j < heights.cols();
    return inside ? heights(i, j) : kUnknown;
  };
  ArrayXXd rise = ArrayXXd::Constant(heights.rows(), heights.cols(), kUnknown);
  for (Index j = 0; j < heights.cols(); ++j)
    for (Index i = 0; i < heights.rows(); ++i) {
      if (!std::isfinite(heights(i, j))) continue;
      const double along_x = slope(at(i - 1, j), heights(i, j), at(i + 1, j), spacing.x());
      const double along_y = slope(at(i, j - 1), heights(i, j), at(i, j + 1), spacing.y());
      rise(i, j) = (along_y - along_x) * std::sqrt(0.5);
    }
  return rise;
}

}  // namespace

CellBlock cellBlock(Index k, Index blocks, Index cells) {
  const Index begin = k * cells / blocks;
  return {begin, (k + 1) * cells / blocks - begin};
}

ArrayXXd reducedMean(const ArrayXXd& values, Index max_x, Index max_y) {
  return reduced(values, max_x, max_y, [](const auto& block) {
    const auto known = block.isFinite();
    return known.select(block, 0.0).sum() / static_cast<double>(known.count());  // 0 / 0 is NaN: unknown
  });
}

ArrayXXi reducedMode(const ArrayXXi& classes, Index max_x, Index max_y) {
  std::vector<int> present;
  return reduced(classes, max_x, max_y, [&present](const auto& block) {
    present.clear();
    for (Index j = 0; j < block.cols(); ++j)
      for (Index i = 0; i < block.rows(); ++i)
        if (block(i, j) >= 0) present.push_back(block(i, j));
    std::sort(present.begin(), present.end());
    int winner = -1;
    std::ptrdiff_t votes = 0;
    for (auto first = present.begin(); first != present.end();) {
      const auto last = std::upper_bound(first, present.end(), *first);
      if (last - first >= votes) {
        votes = last - first;
        winner = *first;
      }
      first = last;
    }
    return winner;
  });
}

ArrayXXd hillShade(const ArrayXXd& heights, const Eigen::Vector2d& spacing) {
  constexpr double kGentlest = 0.02;  // slopes below this are not blown up to full contrast
  // The light's side of a hill falls away towards the light, hence the sign.
  const ArrayXXd brightness = -riseTowardsLight(heights, spacing);
  std::vector<double> sample = finiteSample(brightness);
  if (sample.empty()) return ArrayXXd::Zero(heights.rows(), heights.cols());
  const double middle = quantile(sample, 0.5);
  const double spread = std::max(quantile(sample, 0.95) - middle, middle - quantile(sample, 0.05));
  const ArrayXXd light = (brightness - middle) / (1.5 * std::max(spread, kGentlest));
  return light.isNaN().select(0.0, light.max(-1.0).min(1.0));
}

std::optional<ValueRange> robustRange(const ArrayXXd& values, double tail) {
  std::vector<double> sample = finiteSample(values);
  if (sample.empty()) return std::nullopt;
  const double low = quantile(sample, tail);
  const double high = quantile(sample, 1.0 - tail);
  const double least = 1e-9 * std::max(1.0, std::abs(low));  // below it, differences are rounding
  if (high - low > least) return ValueRange{low, high};
  const double half_width = 0.05 * std::max(1.0, std::abs(low));
  return ValueRange{low - half_width, low + half_width};
}

}  // namespace pcl_fft_ground::cli
