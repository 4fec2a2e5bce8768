#include "ground/robust_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl_fft_ground::core {
namespace {

/// What to expect of the land between two places.
struct Departure {
  double distance, deviation;  // of the middle from either place, from the line between them [m]
};

/// h(x) - (h(x - d) + h(x + d)) / 2 along both axes, where the surface is known at all three places.
std::vector<float> departuresAt(const Eigen::ArrayXXd& surface, const Mask& known, Eigen::Index lag) {
  std::vector<float> departures;
  const auto addAlong = [&](Eigen::Index di, Eigen::Index dj) {
    for (Eigen::Index j = dj; j + dj < surface.cols(); ++j)
      for (Eigen::Index i = di; i + di < surface.rows(); ++i)
        if (known(i, j) && known(i - di, j - dj) && known(i + di, j + dj))
          departures.push_back(
              static_cast<float>(surface(i, j) - 0.5 * (surface(i - di, j - dj) + surface(i + di, j + dj))));
  };
  addAlong(lag, 0);
  addAlong(0, lag);
  return departures;
}

/// By growing distance, which doubles, as far as there are enough of them; deviations that do not fall.
std::vector<Departure> departuresOf(const Eigen::ArrayXXd& surface, const Mask& known, double cell_size) {
  constexpr std::size_t FEWEST = 50;  // of which two or three are beyond the deviation
  std::vector<Departure> found{{0, 0}};
  for (Eigen::Index lag = 1; 2 * lag < std::max(surface.rows(), surface.cols()); lag *= 2) {
    std::vector<float> departures = departuresAt(surface, known, lag);
    if (departures.size() < FEWEST) break;
    found.push_back(
        {static_cast<double>(lag) * cell_size, std::max(found.back().deviation, deviationOf(departures))});
  }
  return found;
}

/// Linear between the distances, and beyond the last as steep as before it.
double deviationAt(const std::vector<Departure>& departures, double distance) {
  if (departures.size() < 2) return 0;
  std::size_t next = 1;
  while (next + 1 < departures.size() && departures[next].distance < distance) ++next;
  const Departure &a = departures[next - 1], &b = departures[next];
  return a.deviation + (b.deviation - a.deviation) * (distance - a.distance) / (b.distance - a.distance);
}

/// How wide the gap is at each cell [cells], from one known cell to the next: the shortest way across along
/// rows, columns and diagonals. A way that ends at the border of the grid counts twice, as nothing is known
/// behind it; 0 where there is no gap.
Eigen::ArrayXXd widthsOfGaps(const Mask& known) {
  const Eigen::Index rows = known.rows(), cols = known.cols();
  Eigen::ArrayXXd widths = Eigen::ArrayXXd::Constant(rows, cols, 2.0 * static_cast<double>(rows + cols));
  const auto isInside = [&](Eigen::Index i, Eigen::Index j) {
    return i >= 0 && i < rows && j >= 0 && j < cols;
  };
  const auto follow = [&](Eigen::Index i, Eigen::Index j, Eigen::Index di, Eigen::Index dj, double step) {
    while (isInside(i, j)) {
      const Eigen::Index begin_i = i, begin_j = j;
      Eigen::Index length = 0;
      for (; isInside(i, j) && !known(i, j); i += di, j += dj) ++length;
      const bool ends_at_border = !isInside(i, j) || !isInside(begin_i - di, begin_j - dj);
      const double width = (ends_at_border ? 2 : 1) * step * static_cast<double>(length + 1);
      for (Eigen::Index n = 0; n < length; ++n) {
        double& shortest = widths(begin_i + n * di, begin_j + n * dj);
        shortest = std::min(shortest, width);
      }
      for (; isInside(i, j) && known(i, j); i += di, j += dj) widths(i, j) = 0;
    }
  };
  for (Eigen::Index j = 0; j < cols; ++j) {
    follow(0, j, 1, 0, 1);
    follow(0, j, 1, 1, M_SQRT2);
    follow(0, j, 1, -1, M_SQRT2);
  }
  for (Eigen::Index i = 0; i < rows; ++i) {
    follow(i, 0, 0, 1, 1);
    if (i == 0) continue;
    follow(i, 0, 1, 1, M_SQRT2);
    follow(i, cols - 1, 1, -1, M_SQRT2);
  }
  return widths;
}

}  // namespace

double deviationOf(std::vector<float>& values) {
  constexpr double COVERED = 0.95, DEVIATIONS = 1.96;
  if (values.empty()) return 0;
  for (float& value : values) value = std::abs(value);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(COVERED * static_cast<double>(values.size()));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at) / DEVIATIONS;
}

Eigen::ArrayXXd surfaceUncertainty(const Eigen::ArrayXXd& surface, const Eigen::ArrayXXd& distance,
                                   double cell_size, double seen_within, double spread) {
  const Mask known = distance <= seen_within;
  const std::vector<Departure> departures = departuresOf(surface, known, cell_size);
  // From ground to ground: what is known reaches into the gap from both sides.
  const Eigen::ArrayXXd widths = 2 * seen_within + cell_size * widthsOfGaps(known);
  return distance.binaryExpr(widths, [&](double near, double width) {
    const double far = std::max(width - near, near);
    return std::hypot(spread, deviationAt(departures, std::sqrt(near * far)));
  });
}

}  // namespace pcl_fft_ground::core
