#pragma once

#include <Eigen/Core>
#include <complex>
#include <memory>
#include <vector>

#include "pcl_fft_ground/core/export.h"

namespace pcl_fft_ground::core {

/// The smallest length of at least `length` whose only prime factors are 2, 3 and 5: one that is transformed
/// fast. Users have it from core/ground/spectrum.h.
PCL_FFT_GROUND_CORE_EXPORT Eigen::Index smoothLength(Eigen::Index length);

/** Complex Fourier transform of one length: the only place where the project meets an FFT library.
 *
 * Eigen's unsupported/Eigen/FFT computes it, on its bundled kissfft or, with PCL_FFT_GROUND_WITH_FFTW, on
 * FFTW. Lengths with a prime factor above 31 go through Bluestein's chirp transform, so that every length
 * takes O(n log n). An object holds its plans and scratch space: one per thread.
 */
class Fft {
 public:
  using Complex = std::complex<double>;

  explicit Fft(int length);
  ~Fft();

  /// out[k] = sum_j in[j] exp(-2 pi i j k / length); `in` and `out` must not overlap.
  void forward(const Complex* in, Complex* out);

  /// in[j] = 1 / length sum_k out[k] exp(2 pi i j k / length); the two must not overlap.
  void inverse(const Complex* in, Complex* out);

 private:
  struct Engine;
  void chirpTransform(const Complex* in, Complex* out);

  int length_;
  std::unique_ptr<Engine> engine_;
  std::vector<Complex> chirp_;  // exp(-pi i k^2 / length); empty if the engine does the length itself
  std::vector<Complex> chirp_spectrum_;  // of the conjugate chirp, wrapped to the padded length
  std::vector<Complex> padded_, scratch_;
};

}  // namespace pcl_fft_ground::core
