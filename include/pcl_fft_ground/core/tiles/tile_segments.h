#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pcl_fft_ground/core/export.h"

namespace pcl_fft_ground::core {

/// When parts of segments in neighbouring tiles are one segment.
enum class SeamRule {
  ANY,  ///< one common point is enough: what touches
  MOST  ///< at least half of the smaller part, near the seam, is common: objects that touch stay apart
};

/// The numbers that one point near a seam has by the segments of two tiles.
struct SeamPoint {
  std::uint32_t one = 0;    ///< of a segment of the first tile
  std::uint32_t other = 0;  ///< of one of the second
};

/** Segments of tiles, all numbered from 0, of which some are parts of one.
 *
 * Each tile tells segments within what is seen of it, the margin included; so a segment that crosses a seam
 * is seen from both sides, and there its points have a number in both tiles.
 */
class PCL_FFT_GROUND_CORE_EXPORT TileSegments {
 public:
  /// \param points of each segment, those within the segment's own tile only
  explicit TileSegments(std::vector<std::uint64_t> points);

  /// Joins segments of two tiles. \param seam all points near the seam that both have seen
  void join(std::vector<SeamPoint> seam, SeamRule rule);

  /** Numbers the joined segments from 1 by falling size, equal ones by their first part.
   * \param least,most points of a segment; others get the number 0
   * \return of each segment of a tile the number
   */
  std::vector<std::int32_t> numbers(std::uint64_t least, std::uint64_t most);

 private:
  std::uint32_t rootOf(std::uint32_t segment);
  void unite(std::uint32_t a, std::uint32_t b);

  std::vector<std::uint64_t> points_;
  std::vector<std::uint32_t> parent_;  // of a root itself; the root of joined segments is the lowest
};

}  // namespace pcl_fft_ground::core
