#include "pcl_fft_ground/core/ground/cutoff.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "pcl_fft_ground/core/ground/spectrum.h"

namespace pcl_fft_ground::core {
namespace {

// Magnitudes below these shares of the largest beside DC, and of DC, are rounding errors.
constexpr double ROUNDING = 1e-9, ROUNDING_OF_DC = 1e-13;

/// Places of the other bins of a window, nearest first: nearly every bin loses against a near one.
std::vector<Eigen::Array2i> windowOffsets(int half_window, Eigen::Index rows, Eigen::Index cols) {
  // Beyond half a period the window only repeats itself.
  const int k_most = static_cast<int>(std::min<Eigen::Index>(half_window, rows / 2));
  const int l_most = static_cast<int>(std::min<Eigen::Index>(half_window, cols / 2));
  std::vector<Eigen::Array2i> offsets;
  for (int l = -l_most; l <= l_most; ++l)
    for (int k = -k_most; k <= k_most; ++k)
      if (k != 0 || l != 0) offsets.emplace_back(k, l);
  std::stable_sort(offsets.begin(), offsets.end(), [](const auto& a, const auto& b) {
    return a.matrix().squaredNorm() < b.matrix().squaredNorm();
  });
  return offsets;
}

Eigen::Index wrapped(Eigen::Index bin, Eigen::Index length) {
  return bin < 0 ? bin + length : bin >= length ? bin - length : bin;
}

/// The magnitudes that eq. (3) compares: rounding errors are zero, DC is below everything.
Eigen::ArrayXXd comparable(Eigen::ArrayXXd m) {
  const double dc = m(0, 0);
  m(0, 0) = -1;
  const double smallest = std::max(ROUNDING * m.maxCoeff(), ROUNDING_OF_DC * dc);
  m = (m < smallest).select(0.0, m);
  m(0, 0) = -std::numeric_limits<double>::infinity();
  return m;
}

/// True if the bin exceeds all others of its window, its own conjugate left out.
bool isPeak(const Eigen::ArrayXXd& m, Eigen::Index k, Eigen::Index l,
            const std::vector<Eigen::Array2i>& window, double threshold) {
  const Eigen::Index rows = m.rows(), cols = m.cols();
  return std::all_of(window.begin(), window.end(), [&](const Eigen::Array2i& offset) {
    const Eigen::Index k2 = wrapped(k + offset[0], rows), l2 = wrapped(l + offset[1], cols);
    if (m(k, l) > m(k2, l2) + threshold) return true;
    const bool itself = k2 == k && l2 == l;
    const bool conjugate = k2 == wrapped(rows - k, rows) && l2 == wrapped(cols - l, cols);
    return itself || conjugate;
  });
}

/// True if a neighbour along x exceeds the bin: a quick answer for most bins, those at the border left out.
bool isBeaten(const Eigen::ArrayXXd& m, Eigen::Index k, Eigen::Index l, double threshold) {
  const bool may_be_conjugate = k == 0 || 2 * k + 1 >= m.rows();
  return !may_be_conjugate && !(m(k, l) > std::max(m(k - 1, l), m(k + 1, l)) + threshold);
}

}  // namespace

std::vector<SpectrumPeak> findSpectrumPeaks(Eigen::ArrayXXd magnitude, const PeakParameters& parameters) {
  if (magnitude.size() == 0) return {};
  const Eigen::Index rows = magnitude.rows(), cols = magnitude.cols();
  const Eigen::ArrayXXd m = comparable(std::move(magnitude));
  const int half_window = static_cast<int>(std::min<unsigned>(parameters.half_window, 1U << 20));
  const std::vector<Eigen::Array2i> window = windowOffsets(half_window, rows, cols);

  std::vector<SpectrumPeak> peaks;
  for (Eigen::Index l = 0; l < cols; ++l)
    for (Eigen::Index k = 0; k <= rows / 2; ++k) {
      if (!(m(k, l) > 0) || isBeaten(m, k, l, parameters.threshold)) continue;
      if (!isPeak(m, k, l, window, parameters.threshold)) continue;
      const SpectrumPeak peak{k, l, binRadius(k, l, rows, cols), m(k, l)};
      peaks.push_back(peak);
      // The magnitudes are symmetric: the other half of the plane holds the conjugates of the peaks.
      if (k != 0 && 2 * k != rows)
        peaks.push_back({rows - k, wrapped(cols - l, cols), peak.radius, peak.magnitude});
    }
  std::sort(peaks.begin(), peaks.end(), [](const SpectrumPeak& a, const SpectrumPeak& b) {
    return std::tie(a.radius, a.l, a.k) < std::tie(b.radius, b.l, b.k);
  });
  return peaks;
}

double largestObject(double cutoff, double cell_size) {
  return 2 * cell_size / cutoff;
}

Cutoff selectCutoff(const std::vector<SpectrumPeak>& peaks, double cell_size, double max_object_size) {
  const auto peak = std::find_if(peaks.begin(), peaks.end(), [&](const SpectrumPeak& p) {
    return largestObject(p.radius, cell_size) <= max_object_size;
  });
  if (peak != peaks.end())
    return {peak->radius, largestObject(peak->radius, cell_size), *peak, CutoffSource::PEAK};
  const double fallback = std::min(M_SQRT2, 2 * cell_size / max_object_size);
  return {fallback, largestObject(fallback, cell_size), std::nullopt, CutoffSource::FALLBACK};
}

}  // namespace pcl_fft_ground::core
