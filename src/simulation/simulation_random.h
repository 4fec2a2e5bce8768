#pragma once

#include <cstdint>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>

namespace pcl_fft_ground::core {

/// Independent uses of one seed: a longer scan must not move the objects.
enum class RandomStream : std::uint32_t {
  TERRAIN = 1,
  OBJECTS,
  SURVEYING,
  GAPS,
  RAYS,
  SELECTION,
  NOISE,
  OUTLIERS,
  ROUTE,
  NAVIGATION
};

/** \brief Random numbers that repeat across compilers: Boost's distributions, never the standard library's.
 *
 * Draw into named locals: the order in which arguments of a call are evaluated is the compiler's choice.
 */
class Random {
 public:
  Random(std::uint32_t seed, RandomStream stream)
      : generator_(mixed(seed, static_cast<std::uint32_t>(stream))) {}

  double uniform(double low, double high) {
    return boost::random::uniform_real_distribution<double>(low, high)(generator_);
  }
  double normal(double deviation) { return deviation * normal_(generator_); }
  std::uint32_t bits() { return generator_(); }
  std::size_t below(std::size_t count) {
    return boost::random::uniform_int_distribution<std::size_t>(0, count - 1)(generator_);
  }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }

 private:
  /// Scatters neighbouring seeds and streams (the finaliser of MurmurHash3).
  static std::uint32_t mixed(std::uint32_t seed, std::uint32_t stream) {
    std::uint32_t h = seed + 0x9e3779b9U * stream;
    h = (h ^ (h >> 16)) * 0x85ebca6bU;
    h = (h ^ (h >> 13)) * 0xc2b2ae35U;
    return h ^ (h >> 16);
  }

  boost::random::mt19937 generator_;
  boost::random::normal_distribution<double> normal_;
};

}  // namespace pcl_fft_ground::core
