#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_fft_ground::fuzz {

/// Takes values off the front of any bytes; zeros when they are used up.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : rest_(bytes) {}

  template <typename Value>
  Value take() {
    Value value{};
    const std::size_t count = std::min(sizeof value, rest_.size());
    if (count > 0) std::memcpy(&value, rest_.data(), count);
    rest_.remove_prefix(count);
    return value;
  }
  bool empty() const { return rest_.empty(); }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

/// What is promised of any bytes: it throws, crashes or takes forever where the promise is broken.
struct Target {
  std::string name;
  void (*promise)(Bytes bytes);
};

/// Files, tables and command lines. \param folder an empty one to work in
std::vector<Target> readerTargets();
/// Points, segments and alignments.
std::vector<Target> scanTargets();

/// \throws std::logic_error, which nothing catches, unless it is so
inline void require(bool is_so, const std::string& promise) {
  if (!is_so) throw std::logic_error("not so: " + promise);
}

}  // namespace pcl_fft_ground::fuzz
