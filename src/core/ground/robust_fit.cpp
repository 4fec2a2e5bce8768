#include "ground/robust_fit.h"

#include <algorithm>
#include <cmath>

namespace pcl_fft_ground::core {

namespace {

/// A coefficient that is suppressed so much is none. Higher ones overflow at high orders.
constexpr double STRONGEST_PENALTY = 1e12;

}  // namespace

Eigen::ArrayXXd penaltyOf(const BandLimit& limit, Eigen::Index rows, Eigen::Index cols, double cell_size) {
  // Coefficient k of an axis of N cells has k / (2 N cell) cycles per metre.
  const auto ratios = [&](Eigen::Index n) -> Eigen::ArrayXd {
    const double step = limit.wavelength / (2 * static_cast<double>(n) * cell_size);
    return (Eigen::ArrayXd::LinSpaced(n, 0, static_cast<double>(n - 1)) * step).square();
  };
  const double epsilon_squared = std::pow(10.0, limit.passband_ripple / 10) - 1;
  const Eigen::ArrayXXd squared_ratio =
      ratios(rows).replicate(1, cols) + ratios(cols).transpose().replicate(rows, 1);
  Eigen::ArrayXXd power = squared_ratio;  // many times faster than pow()
  for (unsigned n = 1; n < limit.order; ++n) power *= squared_ratio;
  return (epsilon_squared * power).min(STRONGEST_PENALTY);
}

PenalisedFit::PenalisedFit(Eigen::Index rows, Eigen::Index cols, double cell_size, const BandLimit& limit)
    : transform_(rows, cols),
      step_transform_(rows, cols),
      surface_(Eigen::ArrayXXd::Zero(rows, cols)),
      coefficients_(surface_),
      penalty_(penaltyOf(limit, rows, cols, cell_size).cast<float>()),
      weights_(rows, cols),
      preconditioner_(rows, cols),
      residual_(rows, cols),
      direction_(rows, cols),
      image_(rows, cols),
      step_(rows, cols) {}

void PenalisedFit::startFrom(const Eigen::ArrayXXd& surface) {
  surface_ = surface;
  coefficients_ = surface;
  transform_.forward(coefficients_);
}

void PenalisedFit::improve(const Eigen::ArrayXXd& weights, const Eigen::ArrayXXd& weighted_residuals,
                           const Effort& effort) {
  weights_ = weights.cast<float>();
  residual_ = weighted_residuals.cast<float>();
  step_transform_.forward(residual_);
  residual_ -= penalty_ * coefficients_.cast<float>();
  preconditioner_ = 1 / (std::max(weights_.mean(), 0.05F) + penalty_);
  direction_ = preconditioner_ * residual_;
  float product = (residual_ * direction_).sum();
  for (int n = 0; n < effort.steps && product > 0; ++n) {
    step_ = direction_;
    step_transform_.inverse(step_);
    image_ = weights_ * step_;
    step_transform_.forward(image_);
    image_ += penalty_ * direction_;
    const float curvature = (direction_ * image_).sum();
    const float length = product / curvature;
    if (!(curvature > 0) || !std::isfinite(length)) break;  // squares beyond the range of float: no step then
    coefficients_ += (length * direction_).cast<double>();
    surface_ += (length * step_).cast<double>();
    if (n + 1 == effort.steps) break;  // what follows prepares the next step
    if (length * step_.abs().maxCoeff() < static_cast<float>(effort.precision)) break;
    residual_ -= length * image_;
    image_ = preconditioner_ * residual_;
    const float next = (image_ * residual_).sum();
    direction_ = image_ + next / product * direction_;
    product = next;
  }
}

void PenalisedFit::lowPass(Eigen::ArrayXXd& heights) {
  transform_.forward(heights);
  heights /= 1 + penalty_.cast<double>();
  transform_.inverse(heights);
}

}  // namespace pcl_fft_ground::core
