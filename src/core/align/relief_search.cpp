#include "align/relief_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace pcl_fft_ground::core {
namespace {

constexpr double PI = 3.14159265358979323846;

constexpr double FINE = 0.6;          // deviation of the Gaussian that takes the noise of a cell away [cells]
constexpr double COARSE = 1.7;        // of the one whose result is taken away [cells]
constexpr double COVERED = 0.75;      // share of the wider one that must have heights
constexpr double CLIPPED = 3;         // heights beyond so many robust deviations count as these
constexpr double LEAST_SHARE = 0.12;  // of the smaller scan that must overlap
constexpr double LEAST_PATCHES = 4;   // that the overlap must hold: a correlation of fewer says nothing
constexpr double NEARLY_ALL = 0.95;   // of the points, for the lever arm
constexpr double LEAST_VARIANCE = 1e-6;  // of the heights in the overlap, as a share of all: flat ground
constexpr double BEST_CORRELATION = 0.9999;
constexpr std::size_t PER_HEADING = 12;  // peaks that are kept

std::vector<double> gaussian(double deviation) {
  const int reach = static_cast<int>(std::ceil(3 * deviation));
  std::vector<double> weights;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k) {
    weights.push_back(std::exp(-0.5 * k * k / (deviation * deviation)));
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Beyond the border there is nothing.
Eigen::ArrayXXd smoothed(const Eigen::ArrayXXd& values, const std::vector<double>& weights) {
  const auto reach = static_cast<Eigen::Index>(weights.size() / 2);
  const Eigen::Index rows = values.rows(), cols = values.cols();
  Eigen::ArrayXXd along = Eigen::ArrayXXd::Zero(rows, cols), result = Eigen::ArrayXXd::Zero(rows, cols);
  for (Eigen::Index k = -reach; k <= reach; ++k) {
    const Eigen::Index count = rows - std::abs(k);
    if (count <= 0) continue;
    along.middleRows(std::max<Eigen::Index>(0, -k), count) +=
        weights[static_cast<std::size_t>(k + reach)] * values.middleRows(std::max<Eigen::Index>(0, k), count);
  }
  for (Eigen::Index k = -reach; k <= reach; ++k) {
    const Eigen::Index count = cols - std::abs(k);
    if (count <= 0) continue;
    result.middleCols(std::max<Eigen::Index>(0, -k), count) +=
        weights[static_cast<std::size_t>(k + reach)] * along.middleCols(std::max<Eigen::Index>(0, k), count);
  }
  return result;
}

/// Heights beyond a few robust deviations, on walls and things, are not to speak for all.
void clip(Eigen::ArrayXXd& heights, const Eigen::ArrayXXd& mask) {
  std::vector<double> sizes;
  for (Eigen::Index n = 0; n < heights.size(); ++n)
    if (mask(n) > 0) sizes.push_back(std::abs(heights(n)));
  if (sizes.empty()) return;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const double most = CLIPPED * 1.48 * *middle;
  heights = heights.max(-most).min(most);
}

Eigen::AlignedBox2d grown(Eigen::AlignedBox2d box, double by) {
  if (box.isEmpty()) return box;
  box.min().array() -= by;
  box.max().array() += by;
  return box;
}

Eigen::ArrayXXd crossCorrelation(const Spectrum& reference, const Spectrum& moving) {
  return inverseTransform({reference.rows, reference.half * moving.half.conjugate()});
}

/// Sum over all bins of the product of two power spectra, the conjugate half included.
double sharedPower(const Spectrum& a, const Spectrum& b) {
  double sum = 0;
  for (Eigen::Index k = 0; k < a.half.rows(); ++k) {
    const double times = k == 0 || 2 * k == a.rows ? 1 : 2;
    sum += times * (a.half.row(k).abs2() * b.half.row(k).abs2()).sum();
  }
  return sum;
}

double power(const Spectrum& a) {
  double sum = 0;
  for (Eigen::Index k = 0; k < a.half.rows(); ++k)
    sum += (k == 0 || 2 * k == a.rows ? 1 : 2) * a.half.row(k).abs2().sum();
  return sum;
}

/// Area in which the heights of both are alike [cells]: the sum of the product of their autocorrelations.
double alikeArea(const Spectrum& a, const Spectrum& b) {
  const auto cells = static_cast<double>(a.rows * a.cols());
  return std::max(1.0, cells * sharedPower(a, b) / std::max(1e-300, power(a) * power(b)));
}

double leastVariance(const ReliefGrid& relief) {
  return LEAST_VARIANCE * relief.heights.square().sum() / std::max(1.0, relief.mask.sum());
}

struct LeastVariances {
  double reference, moving;
};

/// Sums over what both grids have in common, for each shift.
struct OverlapSums {
  OverlapSums(const ReliefSpectra& r, const ReliefSpectra& m)
      : count(crossCorrelation(r.mask, m.mask)),
        product(crossCorrelation(r.heights, m.heights)),
        reference(crossCorrelation(r.heights, m.mask)),
        moving(crossCorrelation(r.mask, m.heights)),
        reference_squares(crossCorrelation(r.squares, m.mask)),
        moving_squares(crossCorrelation(r.mask, m.squares)) {}

  /// 0 where either is flat.
  double correlation(Eigen::Index i, Eigen::Index j, const LeastVariances& least) const {
    const double n = count(i, j), mean_r = reference(i, j) / n, mean_m = moving(i, j) / n;
    const double var_r = reference_squares(i, j) / n - mean_r * mean_r;
    const double var_m = moving_squares(i, j) / n - mean_m * mean_m;
    if (!(var_r > least.reference && var_m > least.moving)) return 0;
    return (product(i, j) / n - mean_r * mean_m) / std::sqrt(var_r * var_m);
  }

  Eigen::ArrayXXd count, product, reference, moving, reference_squares, moving_squares;
};

bool isBetter(const ReliefPeak& a, const ReliefPeak& b) {
  return a.agreement.evidence > b.agreement.evidence;
}

double logLikelihood(double correlation, double independent) {
  const double r = std::clamp(correlation, 0.0, BEST_CORRELATION);
  return -0.5 * independent * std::log(1 - r * r);
}

/// Offset of a parabola's top from the middle of three values.
double topOf(double before, double middle, double after) {
  const double bend = before - 2 * middle + after;
  return bend < 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
}

}  // namespace

ReliefSearch::ReliefSearch(const Points& moving, const Points& reference, const ReliefBounds& bounds,
                           double cell_size)
    : moving_(moving), bounds_(bounds) {
  constexpr double MARGIN = 2;  // beyond the bounds, so that a peak at the bound has neighbours [cells]
  std::vector<double> radii;
  Eigen::AlignedBox2d reference_box, moving_box;
  for (Eigen::Index n = 0; n < reference.cols(); ++n)
    reference_box.extend(Eigen::Vector2d(reference.col(n).head<2>().cast<double>()));
  for (Eigen::Index n = 0; n < moving.cols(); ++n) {
    const Eigen::Vector2d place = moving.col(n).head<2>().cast<double>();
    moving_box.extend(place);
    radii.push_back((place - bounds.pivot).norm());
  }
  const auto far =
      radii.begin() + static_cast<std::ptrdiff_t>(NEARLY_ALL * static_cast<double>(radii.size()));
  std::nth_element(radii.begin(), far, radii.end());
  const double margin = bounds.shift + MARGIN * cell_size;
  reach_ = static_cast<Eigen::Index>(std::ceil(margin / cell_size));
  step_ = 0.5 * cell_size / std::max(cell_size, *far);
  turns_ = std::ceil(std::min(bounds.turn, PI) / step_);
  const double swing =
      2 * std::sin(0.5 * std::min(bounds.turn + step_, PI)) * *std::max_element(radii.begin(), radii.end());
  const Eigen::AlignedBox2d box =
      grown(reference_box, margin).intersection(grown(moving_box, margin + swing));
  geometry_.cell_size = cell_size;
  if (box.isEmpty()) return;
  geometry_ = gridAround({{box.min().x(), box.min().y(), 0}, {box.max().x(), box.max().y(), 0}}, cell_size);
  padded_rows_ = smoothLength(geometry_.rows + reach_);
  padded_cols_ = smoothLength(geometry_.cols + reach_);
  reference_ = reliefOf(reference, Eigen::Isometry3d::Identity());
  spectra_ = spectraOf(reference_);
}

ReliefGrid ReliefSearch::reliefOf(const Points& points, const Eigen::Isometry3d& correction) const {
  Eigen::ArrayXXd sum = Eigen::ArrayXXd::Zero(geometry_.rows, geometry_.cols), count = sum;
  const Eigen::Matrix3f turn = correction.linear().cast<float>();
  const Eigen::Vector3f shift = correction.translation().cast<float>();
  const Eigen::Vector2f origin = geometry_.origin.cast<float>();
  const auto per_cell = static_cast<float>(1 / geometry_.cell_size);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Eigen::Vector3f point = turn * points.col(n) + shift;
    const float u = (point.x() - origin.x()) * per_cell, v = (point.y() - origin.y()) * per_cell;
    if (!(u >= 0 && v >= 0 && u < static_cast<float>(geometry_.rows) &&
          v < static_cast<float>(geometry_.cols)))
      continue;
    const auto i = static_cast<Eigen::Index>(u), j = static_cast<Eigen::Index>(v);
    sum(i, j) += static_cast<double>(point.z());
    count(i, j) += 1;
  }
  const Eigen::ArrayXXd mask = (count > 0).cast<double>();
  sum /= count.max(1);
  static const std::vector<double> fine = gaussian(FINE), coarse = gaussian(COARSE);
  const Eigen::ArrayXXd covered = smoothed(mask, coarse), near = smoothed(mask, fine);
  ReliefGrid relief;
  relief.mask = (covered > COVERED && near > 0.05).cast<double>();
  relief.heights =
      relief.mask * (smoothed(sum, fine) / near.max(1e-9) - smoothed(sum, coarse) / covered.max(1e-9));
  clip(relief.heights, relief.mask);
  return relief;
}

ReliefSpectra ReliefSearch::spectraOf(const ReliefGrid& relief) const {
  const auto padded = [this](const auto& values) {
    Eigen::ArrayXXd grid = Eigen::ArrayXXd::Zero(padded_rows_, padded_cols_);
    grid.topLeftCorner(geometry_.rows, geometry_.cols) = values;
    return forwardTransform(grid);
  };
  return {padded(relief.mask), padded(relief.heights), padded(relief.heights.square())};
}

double ReliefSearch::logTrials() const {
  const auto cells = static_cast<double>(reach_);
  return std::log(std::max(1.0, PI * cells * cells * headings() / area_));
}

void ReliefSearch::searchHeading(double turn, std::vector<ReliefPeak>& found) {
  const Eigen::Vector3d pivot(bounds_.pivot.x(), bounds_.pivot.y(), 0);
  const Eigen::Isometry3d turned = Eigen::Translation3d(pivot) *
                                   Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) *
                                   Eigen::Translation3d(-pivot);
  const ReliefGrid moving = reliefOf(moving_, turned);
  const ReliefSpectra spectra = spectraOf(moving);
  const double area = alikeArea(spectra_.heights, spectra.heights);
  area_ += area / headings();
  const OverlapSums sums(spectra_, spectra);
  const double least_count =
      std::max(LEAST_SHARE * std::min(reference_.mask.sum(), moving.mask.sum()), LEAST_PATCHES * area);
  const LeastVariances least{leastVariance(reference_), leastVariance(moving)};
  const Eigen::Index size = 2 * reach_ + 1;
  Eigen::ArrayXXd correlations = Eigen::ArrayXXd::Zero(size, size), likelihoods = correlations;
  for (Eigen::Index b = 0; b < size; ++b)
    for (Eigen::Index a = 0; a < size; ++a) {
      const Eigen::Index x = a - reach_, y = b - reach_;
      const Eigen::Index i = (x + padded_rows_) % padded_rows_, j = (y + padded_cols_) % padded_cols_;
      if (x * x + y * y > reach_ * reach_ || sums.count(i, j) < least_count) continue;
      correlations(a, b) = sums.correlation(i, j, least);
      likelihoods(a, b) = logLikelihood(correlations(a, b), sums.count(i, j) / area);
    }
  const std::vector<ReliefPeak> peaks = peaksOf(correlations, likelihoods, turned);
  found.insert(found.end(), peaks.begin(), peaks.end());
}

/// The best of the places that are better than their neighbours, to parts of a cell.
std::vector<ReliefPeak> ReliefSearch::peaksOf(const Eigen::ArrayXXd& correlations,
                                              const Eigen::ArrayXXd& likelihoods,
                                              const Eigen::Isometry3d& turned) const {
  std::vector<ReliefPeak> peaks;
  for (Eigen::Index b = 1; b + 1 < likelihoods.cols(); ++b)
    for (Eigen::Index a = 1; a + 1 < likelihoods.rows(); ++a) {
      const double here = likelihoods(a, b);
      if (!(here > 0) || here < likelihoods.block(a - 1, b - 1, 3, 3).maxCoeff()) continue;
      const double x =
          static_cast<double>(a - reach_) + topOf(likelihoods(a - 1, b), here, likelihoods(a + 1, b));
      const double y =
          static_cast<double>(b - reach_) + topOf(likelihoods(a, b - 1), here, likelihoods(a, b + 1));
      peaks.push_back({Eigen::Translation3d(x * geometry_.cell_size, y * geometry_.cell_size, 0) * turned,
                       {correlations(a, b), here}});
    }
  std::stable_sort(peaks.begin(), peaks.end(), isBetter);
  peaks.resize(std::min(peaks.size(), PER_HEADING));
  return peaks;
}

std::vector<ReliefPeak> ReliefSearch::peaks(std::size_t count) {
  std::vector<ReliefPeak> found, kept;
  if (geometry_.rows == 0) return kept;
  area_ = 0;
  const int turns = static_cast<int>(turns_);
  for (int n = -turns; n <= turns; ++n) searchHeading(n * step_, found);
  std::stable_sort(found.begin(), found.end(), isBetter);
  const double apart = std::max(1.5, std::sqrt(area_)) * geometry_.cell_size;
  const Eigen::Vector3d pivot(bounds_.pivot.x(), bounds_.pivot.y(), 0);
  for (const ReliefPeak& peak : found) {
    const auto near = [&](const ReliefPeak& other) {
      const Eigen::Isometry3d between = peak.correction.inverse() * other.correction;
      const double lever = 0.5 * geometry_.cell_size / step_;
      return (between * pivot - pivot).norm() + Eigen::AngleAxisd(between.linear()).angle() * lever < apart;
    };
    if (std::any_of(kept.begin(), kept.end(), near)) continue;
    kept.push_back(peak);
    if (kept.size() == count) break;
  }
  for (ReliefPeak& peak : kept) peak.agreement.evidence -= logTrials();
  return kept;
}

ReliefAgreement ReliefSearch::at(const Eigen::Isometry3d& correction) const {
  if (geometry_.rows == 0) return {};
  const ReliefGrid moving = reliefOf(moving_, correction);
  const Eigen::ArrayXXd both = reference_.mask * moving.mask;
  const double n = both.sum();
  if (n < LEAST_PATCHES * area_) return {0, -logTrials()};
  const double mean_r = (both * reference_.heights).sum() / n, mean_m = (both * moving.heights).sum() / n;
  const double var_r = (both * reference_.heights.square()).sum() / n - mean_r * mean_r;
  const double var_m = (both * moving.heights.square()).sum() / n - mean_m * mean_m;
  const double product = (both * reference_.heights * moving.heights).sum() / n - mean_r * mean_m;
  if (!(var_r > 0 && var_m > 0)) return {0, -logTrials()};
  const double r = product / std::sqrt(var_r * var_m);
  return {r, logLikelihood(r, n / area_) - logTrials()};
}

}  // namespace pcl_fft_ground::core
