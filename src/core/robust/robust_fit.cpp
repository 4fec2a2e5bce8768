#include "robust/robust_fit.h"

#include <algorithm>
#include <cmath>

namespace pcl_fft_ground::core {

Eigen::ArrayXXd penaltyOf(const BandLimit& limit, Eigen::Index rows, Eigen::Index cols, double cell_size) {
  // Coefficient k of an axis of N cells has k / (2 N cell) cycles per metre.
  const auto ratios = [&](Eigen::Index n) -> Eigen::ArrayXd {
    const double step = limit.wavelength / (2 * static_cast<double>(n) * cell_size);
    return (Eigen::ArrayXd::LinSpaced(n, 0, static_cast<double>(n - 1)) * step).square();
  };
  const double epsilon_squared = std::pow(10.0, limit.passband_ripple / 10) - 1;
  const Eigen::ArrayXXd squared_ratio =
      ratios(rows).replicate(1, cols) + ratios(cols).transpose().replicate(rows, 1);
  return epsilon_squared * squared_ratio.pow(static_cast<int>(limit.order));
}

PenalisedFit::PenalisedFit(Eigen::Index rows, Eigen::Index cols, double cell_size, const BandLimit& limit)
    : transform_(rows, cols),
      penalty_(penaltyOf(limit, rows, cols, cell_size)),
      surface_(Eigen::ArrayXXd::Zero(rows, cols)),
      coefficients_(surface_),
      residual_(rows, cols),
      preconditioner_(rows, cols),
      direction_(rows, cols),
      step_(rows, cols),
      image_(rows, cols) {}

void PenalisedFit::startFrom(const Eigen::ArrayXXd& surface) {
  surface_ = surface;
  coefficients_ = surface;
  transform_.forward(coefficients_);
}

void PenalisedFit::improve(const Eigen::ArrayXXd& weights, const Eigen::ArrayXXd& weighted_residuals,
                           const Effort& effort) {
  residual_ = weighted_residuals;
  transform_.forward(residual_);
  residual_ -= penalty_ * coefficients_;
  preconditioner_ = 1 / (std::max(weights.mean(), 0.05) + penalty_);
  direction_ = preconditioner_ * residual_;
  double product = (residual_ * direction_).sum();
  for (int n = 0; n < effort.steps && product > 0; ++n) {
    step_ = direction_;
    transform_.inverse(step_);
    image_ = weights * step_;
    transform_.forward(image_);
    image_ += penalty_ * direction_;
    const double length = product / (direction_ * image_).sum();
    coefficients_ += length * direction_;
    surface_ += length * step_;
    if (length * step_.abs().maxCoeff() < effort.precision) break;
    residual_ -= length * image_;
    const double next = (preconditioner_ * residual_.square()).sum();
    direction_ = preconditioner_ * residual_ + next / product * direction_;
    product = next;
  }
}

void PenalisedFit::lowPass(Eigen::ArrayXXd& heights) {
  transform_.forward(heights);
  heights /= 1 + penalty_;
  transform_.inverse(heights);
}

}  // namespace pcl_fft_ground::core
