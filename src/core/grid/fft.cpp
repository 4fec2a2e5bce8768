#include "grid/fft.h"

#ifdef PCL_FFT_GROUND_WITH_FFTW
#define EIGEN_FFTW_DEFAULT
#endif
#include <algorithm>
#include <cmath>
#include <mutex>
#include <unsupported/Eigen/FFT>

namespace pcl_fft_ground::core {
namespace {

/// Above this prime factor the generic butterflies cost more than a chirp transform.
constexpr int LARGEST_DIRECT_FACTOR = 31;

int largestPrimeFactor(int n) {
  int largest = 1;
  for (int p = 2; p * p <= n; ++p)
    for (; n % p == 0; n /= p) largest = p;
  return std::max(largest, n);
}

/// FFTW makes its plans at the first call with a length, and its planner must not run in two threads at once.
[[maybe_unused]] std::mutex& plannerMutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

Eigen::Index smoothLength(Eigen::Index length) {
  for (Eigen::Index n = std::max<Eigen::Index>(length, 1);; ++n) {
    Eigen::Index rest = n;
    for (const Eigen::Index p : {2, 3, 5})
      while (rest % p == 0) rest /= p;
    if (rest == 1) return n;
  }
}

struct Fft::Engine {
  Eigen::FFT<double> fft;

  // Kissfft writes to a null pointer at length 1, where there is nothing to do.
  void forward(const Complex* in, Complex* out, int length) {
    if (length == 1) {
      *out = *in;
      return;
    }
#ifdef PCL_FFT_GROUND_WITH_FFTW
    const std::lock_guard<std::mutex> lock(plannerMutex());
#endif
    fft.fwd(out, in, length);
  }
  void inverse(const Complex* in, Complex* out, int length) {
    if (length == 1) {
      *out = *in;
      return;
    }
#ifdef PCL_FFT_GROUND_WITH_FFTW
    const std::lock_guard<std::mutex> lock(plannerMutex());
#endif
    fft.inv(out, in, length);
  }
};

Fft::Fft(int length) : length_(length), engine_(std::make_unique<Engine>()) {
#ifndef PCL_FFT_GROUND_WITH_FFTW  // FFTW does every length in O(n log n)
  if (largestPrimeFactor(length) <= LARGEST_DIRECT_FACTOR) return;
  const auto n = static_cast<std::size_t>(length);
  chirp_.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double turns = static_cast<double>(k * k % (2 * n)) / (2.0 * length);  // reduced while still exact
    chirp_[k] = std::polar(1.0, -2 * M_PI * turns);
  }
  const auto padded_length = static_cast<std::size_t>(smoothLength(2 * length - 1));
  padded_.assign(padded_length, 0.0);
  for (std::size_t k = 0; k < n; ++k)
    padded_[k] = padded_[(padded_length - k) % padded_length] = std::conj(chirp_[k]);
  chirp_spectrum_.resize(padded_length);
  scratch_.resize(padded_length);
  engine_->forward(padded_.data(), chirp_spectrum_.data(), static_cast<int>(padded_length));
#endif
}

Fft::~Fft() = default;

/// Bluestein: j k = (j^2 + k^2 - (k - j)^2) / 2 turns the transform into a convolution with a chirp.
void Fft::chirpTransform(const Complex* in, Complex* out) {
  const auto n = static_cast<std::size_t>(length_);
  const int padded_length = static_cast<int>(padded_.size());
  std::transform(in, in + n, chirp_.begin(), padded_.begin(), std::multiplies<>());
  std::fill(padded_.begin() + length_, padded_.end(), 0.0);
  engine_->forward(padded_.data(), scratch_.data(), padded_length);
  std::transform(scratch_.begin(), scratch_.end(), chirp_spectrum_.begin(), scratch_.begin(),
                 std::multiplies<>());
  engine_->inverse(scratch_.data(), padded_.data(), padded_length);
  std::transform(chirp_.begin(), chirp_.end(), padded_.begin(), out, std::multiplies<>());
}

void Fft::forward(const Complex* in, Complex* out) {
  if (chirp_.empty())
    engine_->forward(in, out, length_);
  else
    chirpTransform(in, out);
}

void Fft::inverse(const Complex* in, Complex* out) {
  if (chirp_.empty()) {
    engine_->inverse(in, out, length_);
    return;
  }
  // The inverse is the conjugate of the forward transform of the conjugate.
  std::vector<Complex> conjugate(in, in + length_);
  for (Complex& value : conjugate) value = std::conj(value);
  chirpTransform(conjugate.data(), out);
  for (int k = 0; k < length_; ++k) out[k] = std::conj(out[k]) / static_cast<double>(length_);
}

}  // namespace pcl_fft_ground::core
