#include "scan/radix_sort.h"

#include <array>
#include <cstddef>
#include <cstring>

namespace pcl_fft_ground::core {
namespace {

constexpr unsigned DIGIT_BITS = 11, DIGITS = 3;
constexpr std::size_t DIGIT_VALUES = std::size_t{1} << DIGIT_BITS;
constexpr std::uint32_t SIGN = 0x80000000U;

/// An integer that is ordered as the value is.
std::uint32_t keyOf(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return (bits & SIGN) != 0 ? ~bits : bits | SIGN;
}

float valueOf(std::uint32_t key) {
  const std::uint32_t bits = (key & SIGN) != 0 ? key & ~SIGN : ~key;
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

std::size_t digitOf(std::uint32_t key, unsigned digit) {
  return (key >> (digit * DIGIT_BITS)) % DIGIT_VALUES;
}

}  // namespace

void RadixSort::operator()(std::vector<float>& values) {
  keys_.resize(values.size());
  sorted_.resize(values.size());
  std::array<std::array<std::uint32_t, DIGIT_VALUES>, DIGITS> places{};
  for (std::size_t n = 0; n < values.size(); ++n) {
    keys_[n] = keyOf(values[n]);
    for (unsigned digit = 0; digit < DIGITS; ++digit) ++places[digit][digitOf(keys_[n], digit)];
  }
  for (unsigned digit = 0; digit < DIGITS; ++digit) {
    std::uint32_t begin = 0;
    for (std::uint32_t& place : places[digit]) {
      const std::uint32_t count = place;
      place = begin;
      begin += count;
    }
    for (const std::uint32_t key : keys_) sorted_[places[digit][digitOf(key, digit)]++] = key;
    keys_.swap(sorted_);
  }
  for (std::size_t n = 0; n < values.size(); ++n) values[n] = valueOf(keys_[n]);
}

}  // namespace pcl_fft_ground::core
