#include "robust_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "robust_start.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double GROUND_SCALES = 3;   // above the ground's median, in its scales, where the weight is 1/2
constexpr double OUTLIER_SCALES = 8;  // below it, where the weight is 1/4
constexpr double STEEPNESS = 6;       // of the weight around its 1/2, per scale
constexpr double SETTLED = 5e-4;      // change of all weights, as a share of them
constexpr int SOLVER_STEPS = 5;       // warm-started: more are wasted while the weights still change

/// Weight of a residual, in scales from the ground's median.
double weightOf(double deviation) {
  if (deviation > 2 * GROUND_SCALES) return 0;
  const double above = 1 / (1 + std::exp(STEEPNESS * (deviation - GROUND_SCALES)));
  if (deviation >= 0) return above;
  const double depth = deviation / OUTLIER_SCALES;
  const double below = 1 / (1 + depth * depth);
  return below * below;
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

void RobustSurface::startBelowObjects(double wavelength) {
  grid_ = BilinearGrid(scaleGeometry(cells_, wavelength));
  wavelength_ = wavelength;
  surface_ = lowerEnvelope(points_, grid_.geometry(), limitAt(wavelength));
  findFootings();
  findResiduals();
  spread_ = lowestMode(residuals_, 0.5 * wavelength);
  spread_.scale = std::max({spread_.scale, floors_.least, floors_.slope * wavelength / GROUND_SCALES});
  weights_.assign(residuals_.size(), 0.0);
  updateWeights();
}

void RobustSurface::startFrom(const std::vector<bool>& ground, double wavelength) {
  grid_ = BilinearGrid(scaleGeometry(cells_, wavelength));
  wavelength_ = wavelength;
  surface_ = blockMeans(points_, ground, grid_.geometry());
  findFootings();
  weights_.assign(ground.begin(), ground.end());
  PenalisedFit fit(surface_.rows(), surface_.cols(), grid_.geometry().cell_size, limitAt(wavelength));
  for (int n = 0; n < 4; ++n) {
    findResiduals();
    solve(fit);
  }
  findResiduals();
}

void RobustSurface::changeGrid(double wavelength) {
  const BilinearGrid finer(scaleGeometry(cells_, wavelength));
  surface_ = resampled(surface_, grid_, finer.geometry());
  grid_ = finer;
  wavelength_ = wavelength;
}

void RobustSurface::findFootings() {
  footings_.clear();
  footings_.reserve(points_.positions.size());
  for (const Eigen::Vector3d& p : points_.positions) footings_.push_back(grid_.at(p.x(), p.y()));
}

void RobustSurface::findResiduals() {
  residuals_.resize(footings_.size());
  for (std::size_t n = 0; n < footings_.size(); ++n)
    residuals_[n] = points_.positions[n].z() - grid_.value(surface_, footings_[n]);
}

void RobustSurface::estimateSpread(double floor) {
  ground_residuals_.clear();
  for (std::size_t n = 0; n < residuals_.size(); ++n)
    if (weights_[n] > 0.5) ground_residuals_.push_back(residuals_[n]);
  spread_ = medianSpread(ground_residuals_);
  spread_.scale = std::max(spread_.scale, floor);
}

/// \return by how much the weights changed, as a share of them
double RobustSurface::updateWeights() {
  double change = 0, sum = 0;
  for (std::size_t n = 0; n < weights_.size(); ++n) {
    const double weight = weightOf((residuals_[n] - spread_.centre) / spread_.scale);
    change += std::abs(weight - weights_[n]);
    sum += weights_[n];
    weights_[n] = weight;
  }
  return sum > 0 ? change / sum : 1;
}

/// The residuals are spread on to the grid and added to the surface there: a slope within a coarse cell does
/// no harm. (Lumped normal equations; repeated, they converge to those of the interpolated surface.)
void RobustSurface::solve(PenalisedFit& fit) {
  cell_weights_.setZero(surface_.rows(), surface_.cols());
  weighted_heights_.setZero(surface_.rows(), surface_.cols());
  for (std::size_t n = 0; n < weights_.size(); ++n) {
    if (weights_[n] == 0) continue;
    grid_.add(cell_weights_, footings_[n], weights_[n]);
    grid_.add(weighted_heights_, footings_[n], weights_[n] * residuals_[n]);
  }
  const double per_cell = std::pow(cells_.cell_size / grid_.geometry().cell_size, 2);
  cell_weights_ *= per_cell;
  weighted_heights_ = weighted_heights_ * per_cell + cell_weights_ * surface_;
  fit.solve(cell_weights_, weighted_heights_, {SOLVER_STEPS, precision_}, surface_);
}

void RobustSurface::refine(double wavelength, int iterations) {
  const double annealed = wavelength < wavelength_ ? spread_.scale * wavelength / wavelength_ : 0;
  const double floor = std::max({floors_.least, annealed, floors_.slope * wavelength / GROUND_SCALES});
  if (wavelength != wavelength_) changeGrid(wavelength);
  findFootings();
  PenalisedFit fit(surface_.rows(), surface_.cols(), grid_.geometry().cell_size, limitAt(wavelength));
  for (int n = 0; n < iterations; ++n) {
    findResiduals();
    estimateSpread(floor);
    const double change = updateWeights();
    solve(fit);
    if (change < SETTLED) break;
  }
}

void RobustSurface::fitTo(const CellPoints& points) {
  points_ = points;
  weights_.assign(points_.positions.size(), 1.0);
  findFootings();
  PenalisedFit fit(surface_.rows(), surface_.cols(), grid_.geometry().cell_size, limitAt(wavelength_));
  for (int n = 0; n < 2; ++n) {
    findResiduals();
    solve(fit);
  }
}

}  // namespace pcl_fft_ground::core
