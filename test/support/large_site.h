#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pcl_fft_ground::test {

/** A square site of any size whose points are computed one by one, so that nobody has to hold them all:
 * rolling ground with a terrace every 11 m, boulders up to 0.9 m long strewn over it, alone and in piles.
 * Everything follows from the seed and the number of the point.
 */
class LargeSite {
 public:
  struct Point {
    Eigen::Vector3f place;  ///< [m]
    bool is_object;         ///< of a boulder, higher above the ground than four times the noise
  };

  /// \param side [m]
  /// \param noise standard deviation of the heights [m]
  LargeSite(double side, std::uint32_t seed, double noise = 0.003)
      : side_(side), seed_(seed), noise_(noise) {}

  /// The n-th point; they are scattered over the site in no order.
  Point point(std::uint64_t n) const {
    const double x = side_ * share(n, 1), y = side_ * share(n, 2);
    const double above = boulderAt(x, y);
    // The sum of four even distributions is close to a normal one.
    double error = -2;
    for (std::uint32_t k = 3; k < 7; ++k) error += share(n, k);
    const double z = groundAt(x, y) + above + noise_ * std::sqrt(3.0) * error;
    return {Eigen::Vector3d(x, y, z).cast<float>(), above > 4 * noise_};
  }

  /// Height of the ground [m].
  static double groundAt(double x, double y) {
    const double rolling = 0.25 * std::sin(0.7 * x) + 0.2 * std::cos(0.55 * y + 0.3 * x) + 0.01 * x;
    const double bank = (y - 5 - 0.8 * std::sin(0.6 * x)) / TERRACE_WIDTH;  // terraces passed
    const double within = bank - std::floor(bank);
    return rolling + TERRACE_HEIGHT * (std::floor(bank) + std::min(within * TERRACE_WIDTH / BANK_WIDTH, 1.0));
  }

  /// Height of what stands on the ground [m], 0 for nothing.
  double boulderAt(double x, double y) const {
    const auto i = static_cast<std::int64_t>(std::floor(x / SPACING));
    const auto j = static_cast<std::int64_t>(std::floor(y / SPACING));
    double height = 0;
    for (std::int64_t l = j - 1; l <= j + 1; ++l)
      for (std::int64_t k = i - 1; k <= i + 1; ++k) height = std::max(height, heightInCell(k, l, x, y));
    return height;
  }

 private:
  static constexpr double TERRACE_WIDTH = 11, TERRACE_HEIGHT = 0.6, BANK_WIDTH = 0.2, SPACING = 1.3;

  /// A half ellipsoid, or four of them piled up, in some of the cells of a coarse grid.
  double heightInCell(std::int64_t i, std::int64_t j, double x, double y) const {
    const std::uint64_t cell =
        static_cast<std::uint64_t>(i + 1000000) * 4000037U + static_cast<std::uint64_t>(j + 1000000);
    const double kind = share(cell, 11);
    if (kind > 0.45) return 0;
    const int stones = kind < 0.1 ? 4 : 1;
    double height = 0;
    for (int s = 0; s < stones; ++s) {
      const auto salt = static_cast<std::uint32_t>(20 + 8 * s);
      const double around = stones > 1 ? 0.35 : 0.8;
      const double cx = (static_cast<double>(i) + 0.5 + around * (share(cell, salt) - 0.5)) * SPACING;
      const double cy = (static_cast<double>(j) + 0.5 + around * (share(cell, salt + 1) - 0.5)) * SPACING;
      const double a = 0.12 + 0.33 * share(cell, salt + 2), b = 0.1 + 0.2 * share(cell, salt + 3);
      const double c = 0.1 + 0.3 * share(cell, salt + 4), yaw = M_PI * share(cell, salt + 5);
      const double u = ((x - cx) * std::cos(yaw) + (y - cy) * std::sin(yaw)) / a;
      const double v = ((y - cy) * std::cos(yaw) - (x - cx) * std::sin(yaw)) / b;
      if (u * u + v * v < 1) height = std::max(height, c * std::sqrt(1 - u * u - v * v));
    }
    return height;
  }

  /// An even share of [0, 1) that belongs to a number and a purpose (SplitMix64).
  double share(std::uint64_t n, std::uint32_t purpose) const {
    std::uint64_t bits =
        n * 0x9e3779b97f4a7c15U + (static_cast<std::uint64_t>(seed_) << 32U) + purpose * 0xd1342543de82ef95U;
    bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
    bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
    return static_cast<double>((bits ^ (bits >> 31U)) >> 11U) * 0x1p-53;
  }

  double side_;
  std::uint32_t seed_;
  double noise_;
};

}  // namespace pcl_fft_ground::test
