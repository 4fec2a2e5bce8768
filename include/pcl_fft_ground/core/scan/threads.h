#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "pcl_fft_ground/core/export.h"

namespace pcl_fft_ground::core {

/** Lets the functions of this library use several threads while the object lives, where the thread that made
 * it calls them; without one they use that thread alone.
 *
 * Threads are started when there is enough for them to do and end with the object. Results are the same, bit
 * for bit, for every number. Of two objects in one thread the younger one counts, unless its number is 1;
 * what a started thread calls does not start others.
 */
class PCL_FFT_GROUND_CORE_EXPORT Threads {
 public:
  /// \param number 0: one for each core; 1: no more than an older object of this thread gives; fewer are used
  /// where the system does not give as many
  explicit Threads(unsigned number);
  ~Threads();
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  class Pool;
  friend PCL_FFT_GROUND_CORE_EXPORT void forEachPart(Eigen::Index parts,
                                                     const std::function<void(Eigen::Index)>& work);

  std::unique_ptr<Pool> pool_;
  Pool* outer_;
};

/** Calls work(0) to work(parts - 1), in any order and at the same time where there are threads.
 * \throws what a call throws: of several the first one
 */
PCL_FFT_GROUND_CORE_EXPORT void forEachPart(Eigen::Index parts,
                                            const std::function<void(Eigen::Index)>& work);

/// Calls work(begin, end) for parts of [0, count). Where they begin depends on nothing but these two numbers.
/// \param grain length of a part, > 0: so long that a thread's waking up does not matter
template <typename Work>
void forEachRange(Eigen::Index count, Eigen::Index grain, const Work& work) {
  const Eigen::Index parts = (count + grain - 1) / grain;
  if (parts == 1)
    work(Eigen::Index{0}, count);
  else
    forEachPart(parts, [&](Eigen::Index part) { work(part * grain, std::min((part + 1) * grain, count)); });
}

/// What work(begin, end) returns for parts of [0, count), in their order: see forEachRange().
template <typename Work>
auto resultsOfRanges(Eigen::Index count, Eigen::Index grain, const Work& work) {
  std::vector<decltype(work(count, count))> results(static_cast<std::size_t>((count + grain - 1) / grain));
  forEachRange(count, grain, [&](Eigen::Index begin, Eigen::Index end) {
    results[static_cast<std::size_t>(begin / grain)] = work(begin, end);
  });
  return results;
}

/// Points that a thread works on at a time.
constexpr Eigen::Index POINTS_AT_A_TIME = 1 << 15;

}  // namespace pcl_fft_ground::core
