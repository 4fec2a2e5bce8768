#pragma once

#include <Eigen/Core>

#include "grid/dct.h"

namespace pcl_fft_ground::core {

/// The band limit of a surface: the Butterworth filter of eq. (1), written as a penalty.
struct BandLimit {
  double wavelength = 1;         ///< at the cut-off [m], > 0
  unsigned order = 2;            ///< n of eq. (1), >= 1
  double passband_ripple = 3.0;  ///< A of eq. (1) [dB], > 0
};

/** P_k = eps^2 (d / d_c)^(2n) of every coefficient of the cosine transform of a grid, at most 1e12.
 * \param cell_size [m]
 */
Eigen::ArrayXXd penaltyOf(const BandLimit& limit, Eigen::Index rows, Eigen::Index cols, double cell_size);

/** Fits a band-limited surface to weighted heights: minimises
 *
 *     sum_i w_i (y_i - s_i)^2 + sum_k P_k |s^_k|^2,    s^ the cosine transform of s.
 *
 * With all weights 1 this is the Butterworth power response, s^_k = y^_k / (1 + P_k). Otherwise it is solved
 * for s^ by conjugate gradients, preconditioned with 1 / (mean weight + P_k): two transforms a step. The
 * corrections to the surface are computed in float, which is all that they need; the surface itself is kept
 * in double. An object serves one grid and one penalty and allocates nothing after its construction.
 */
class PenalisedFit {
 public:
  PenalisedFit(Eigen::Index rows, Eigen::Index cols, double cell_size, const BandLimit& limit);

  /// When improve() is done: a step below `precision` [m] anywhere, or so many steps.
  struct Effort {
    int steps = 30;
    double precision = 1e-4;
  };

  /// Takes a surface [m] to go on from; until then it is 0.
  void startFrom(const Eigen::ArrayXXd& surface);

  /** Goes from the present surface towards the fit.
   * \param weights w, >= 0, not all 0
   * \param weighted_residuals w (y - s) of the present surface s [m]
   */
  void improve(const Eigen::ArrayXXd& weights, const Eigen::ArrayXXd& weighted_residuals,
               const Effort& effort);

  /// The present surface [m].
  const Eigen::ArrayXXd& surface() const { return surface_; }

  /// The fit for weights of 1 everywhere, in place.
  void lowPass(Eigen::ArrayXXd& heights);

 private:
  Dct2d<double> transform_;
  Dct2d<float> step_transform_;
  Eigen::ArrayXXd surface_, coefficients_;  // and its cosine transform
  Eigen::ArrayXXf penalty_, weights_, preconditioner_;
  Eigen::ArrayXXf residual_, direction_, image_;  // cosine transforms
  Eigen::ArrayXXf step_;
};

}  // namespace pcl_fft_ground::core
