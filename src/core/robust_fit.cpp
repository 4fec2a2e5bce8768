#include "robust_fit.h"

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
      residual_(rows, cols),
      preconditioned_(rows, cols),
      direction_(rows, cols),
      image_(rows, cols) {}

void PenalisedFit::precondition(double mean_weight) {
  preconditioned_ = residual_;
  transform_.forward(preconditioned_);
  preconditioned_ /= mean_weight + penalty_;
  transform_.inverse(preconditioned_);
}

void PenalisedFit::solve(const Eigen::ArrayXXd& weights, const Eigen::ArrayXXd& weighted_heights,
                         const Effort& effort, Eigen::ArrayXXd& surface) {
  const auto apply = [&](const Eigen::ArrayXXd& in) {  // (W + C' P C) in
    image_ = in;
    transform_.forward(image_);
    image_ *= penalty_;
    transform_.inverse(image_);
    image_ += weights * in;
  };
  const double mean_weight = std::max(weights.mean(), 0.05);
  apply(surface);
  residual_ = weighted_heights - image_;
  precondition(mean_weight);
  direction_ = preconditioned_;
  double product = (residual_ * preconditioned_).sum();
  for (int i = 0; i < effort.iterations && product > 0; ++i) {
    apply(direction_);
    const double step = product / (direction_ * image_).sum();
    surface += step * direction_;
    if (step * direction_.abs().maxCoeff() < effort.precision) break;
    residual_ -= step * image_;
    precondition(mean_weight);
    const double next = (residual_ * preconditioned_).sum();
    direction_ = preconditioned_ + next / product * direction_;
    product = next;
  }
}

void PenalisedFit::lowPass(Eigen::ArrayXXd& heights) {
  transform_.forward(heights);
  heights /= 1 + penalty_;
  transform_.inverse(heights);
}

}  // namespace pcl_fft_ground::core
