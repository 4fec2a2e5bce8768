#include "ground/robust_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "ground/robust_steps.h"
#include "pcl_fft_ground/core/scan/threads.h"

namespace pcl_fft_ground::core {
namespace {

constexpr float GROUND_SCALES = 3;   // above the ground's median, in its scales, where the weight is 1/2
constexpr float OUTLIER_SCALES = 8;  // below it, where the weight is 1/4

/// How often the weights are updated at most, the solver's steps between (warm-started: more are wasted while
/// the weights still change), and the change of all weights, as a share of them, that ends it.
struct Schedule {
  int updates, steps;
  double settled;
};
constexpr Schedule COARSE{30, 6, 5e-4};  // cheap, and what grows here decides
constexpr Schedule FINE{30, 3, 5e-3};

/// Points that a scale looks at, for each cell of its grid.
constexpr double SAMPLES_PER_CELL = 6, SAMPLES_PER_CELL_AT_START = 40;

/// Weight of a residual, in scales from the ground's median.
float weightOf(float deviation) {
  const float t = std::min(std::max(GROUND_SCALES + 0.5F - deviation, 0.0F), 1.0F);
  const float above = t * t * (3 - 2 * t);
  const float depth = std::min(deviation, 0.0F) / OUTLIER_SCALES;
  const float below = 1 / (1 + depth * depth);
  return above * below * below;
}

}  // namespace

RobustSurface::RobustSurface(CellPoints points, const GridGeometry& cells, const BandLimit& filter,
                             const ScaleFloors& floors, double precision)
    : points_(std::move(points)),
      cells_(cells),
      filter_(filter),
      floors_(floors),
      precision_(precision),
      grid_(cells) {}

void RobustSurface::changeScale(double wavelength) {
  filter_.wavelength = wavelength;
  grid_ = BilinearGrid(scaleGeometry(cells_, wavelength));
  const GridGeometry& grid = grid_.geometry();
  fit_.emplace(grid.rows, grid.cols, grid.cell_size, filter_);
  sums_.resize(2, grid.rows * grid.cols);
  takeSamples(SAMPLES_PER_CELL);
}

/// A share of the points, evenly spread (Fibonacci hashing), where they are many more than the grid's cells.
void RobustSurface::takeSamples(double per_cell) {
  const double cells_per_sample = std::pow(grid_.geometry().cell_size / cells_.cell_size, 2);
  const double share = std::min(per_cell / cells_per_sample, 1.0);
  const auto threshold = static_cast<std::uint32_t>(share * 4294967295.0);
  samples_.clear();
  for (std::uint32_t n = 0; n < points_.positions.size(); ++n)
    if (n * 2654435769U <= threshold) samples_.push_back(points_.positions[n]);
  findFootings();
}

template <typename Work>
void RobustSurface::forEachSample(const Work& work) const {
  constexpr Eigen::Index SAMPLES_AT_A_TIME = 1 << 13;
  forEachRange(static_cast<Eigen::Index>(samples_.size()), SAMPLES_AT_A_TIME,
               [&](Eigen::Index begin, Eigen::Index end) {
                 for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
                   work(n);
               });
}

void RobustSurface::findFootings() {
  footings_.resize(samples_.size());
  forEachSample([&](std::size_t n) { footings_[n] = grid_.at(samples_[n].x(), samples_[n].y()); });
}

void RobustSurface::findResiduals() {
  residuals_.resize(static_cast<Eigen::Index>(samples_.size()));
  forEachSample([&](std::size_t n) {
    residuals_[static_cast<Eigen::Index>(n)] =
        static_cast<float>(samples_[n].z() - grid_.value(heights(), footings_[n]));
  });
}

void RobustSurface::startBelowObjects(double wavelength) {
  changeScale(wavelength);
  takeSamples(SAMPLES_PER_CELL_AT_START);
  fit_->startFrom(lowerEnvelope(samples_, grid_.geometry(), wavelength, *fit_));
  findResiduals();
  spread_ = lowestMode({residuals_.begin(), residuals_.end()}, 0.5 * wavelength);
  // Where objects cover whole blocks the envelope lies on them, and what lies below it is no noise.
  constexpr double MOST_FLOORS = 1.3;
  const double floor = std::max(floors_.least, floors_.slope * wavelength / GROUND_SCALES);
  spread_.scale = std::clamp(spread_.scale, floor, MOST_FLOORS * floor);
  takeSamples(SAMPLES_PER_CELL);
}

void RobustSurface::refit(const std::vector<bool>& ground) {
  constexpr int ROUNDS = 4, STEPS = 5;
  samples_ = points_.positions;
  findFootings();
  findResiduals();
  weights_.resize(residuals_.size());
  std::copy(ground.begin(), ground.end(), weights_.begin());
  for (int n = 0; n < ROUNDS; ++n) fit(STEPS);
  const double least = std::max(floors_.least, floors_.slope * filter_.wavelength / GROUND_SCALES);
  estimateSpread(least, std::numeric_limits<double>::infinity());
}

void RobustSurface::estimateSpread(double least, double most) {
  constexpr Eigen::Index ENOUGH = 4096;
  const Eigen::Index one_in = std::max<Eigen::Index>(residuals_.size() / ENOUGH, 1);
  ground_residuals_.clear();
  for (Eigen::Index n = 0; n < residuals_.size(); n += one_in)
    if (weights_[n] > 0.5F) ground_residuals_.push_back(residuals_[n]);
  spread_ = medianSpread(ground_residuals_, sort_);
  spread_.scale = std::clamp(spread_.scale, least, most);
}

/// \return by how much the weights changed, as a share of them
double RobustSurface::updateWeights() {
  weights_.swap(last_weights_);
  weights_.resize(residuals_.size());
  const auto centre = static_cast<float>(spread_.centre), per_scale = static_cast<float>(1 / spread_.scale);
  forEachSample([&](std::size_t n) {
    const auto k = static_cast<Eigen::Index>(n);
    weights_[k] = weightOf((residuals_[k] - centre) * per_scale);
  });
  const float sum = last_weights_.sum();
  return sum > 0 ? static_cast<double>((weights_ - last_weights_).abs().sum() / sum) : 1;
}

/// The residuals are spread on to the grid and added to the surface there: a slope within a coarse cell does
/// no harm. (Lumped normal equations; repeated, they converge to those of the interpolated surface.)
void RobustSurface::fit(int steps) {
  sums_.setZero();
  for (std::size_t n = 0; n < footings_.size(); ++n) {
    const auto k = static_cast<Eigen::Index>(n);
    const auto weight = static_cast<double>(weights_[k]), residual = static_cast<double>(residuals_[k]);
    if (weight > 0) grid_.add(sums_, footings_[n], {weight, weight * residual});
  }
  const GridGeometry& grid = grid_.geometry();
  const double points_per_sample =
      static_cast<double>(points_.positions.size()) / static_cast<double>(samples_.size());
  const double per_cell = points_per_sample * std::pow(cells_.cell_size / grid.cell_size, 2);
  cell_weights_ = per_cell * sums_.row(0).reshaped(grid.rows, grid.cols);
  cell_residuals_ = per_cell * sums_.row(1).reshaped(grid.rows, grid.cols);
  fit_->improve(cell_weights_, cell_residuals_, {steps, precision_});
  findResiduals();
}

void RobustSurface::refine(double wavelength) {
  const double last_wavelength = filter_.wavelength;
  const double annealed = wavelength < last_wavelength ? spread_.scale * wavelength / last_wavelength : 0;
  const double floor = std::max({floors_.least, annealed, floors_.slope * wavelength / GROUND_SCALES});
  const double ceiling = std::max(spread_.scale, floor);  // or it would climb on to objects, step by step
  if (wavelength != last_wavelength) {
    const Eigen::ArrayXXd coarse = heights();
    const BilinearGrid coarse_grid = grid_;
    changeScale(wavelength);
    fit_->startFrom(resampled(coarse, coarse_grid, grid_.geometry()));
  }
  findResiduals();
  weights_.setZero(residuals_.size());
  updateWeights();
  const Schedule schedule = grid_.geometry().cell_size > 1.5 * cells_.cell_size ? COARSE : FINE;
  for (int n = 0; n < schedule.updates; ++n) {
    estimateSpread(floor, ceiling);
    const double change = updateWeights();
    if (n > 0 && change < schedule.settled) return;
    fit(schedule.steps);
  }
}

void RobustSurface::fitTo(const CellPoints& points) {
  constexpr int STEPS = 3;
  points_ = points;
  samples_ = points_.positions;
  findFootings();
  findResiduals();
  weights_.setOnes(residuals_.size());
  fit(STEPS);
}

}  // namespace pcl_fft_ground::core
