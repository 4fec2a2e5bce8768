#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include "ground/robust_clearance.h"
#include "pcl_fft_ground/core/ground/robust_ground.h"
#include "pcl_fft_ground/core/scan/threads.h"

namespace pcl_fft_ground::core {
namespace {

/// The points in steps above the surface, 0 the first, and below it, -1 the first.
class HeightCounts {
 public:
  static constexpr long END = ClearanceCounts::STEPS;

  explicit HeightCounts(const ClearanceCounts& counts) : counts_(counts) {}

  double at(long step) const {
    if (step < -END || step >= END) return 0;
    return static_cast<double>(step < 0 ? counts_.below[static_cast<std::size_t>(-1 - step)]
                                        : counts_.above[static_cast<std::size_t>(step)]);
  }

  /// The border of steps about which the points within one spread [steps] lie evenly: the middle of the
  /// ground.
  long centre(double spread) const {
    const long within = std::clamp(std::lround(std::min(spread, 1.0 * END)), 1L, END);
    long best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (long centre = -within; centre <= within; ++centre) {
      double above = 0, below = 0;
      for (long step = 0; step < within; ++step) above += at(centre + step), below += at(centre - 1 - step);
      const double uneven = std::abs(above - below) / std::max(above + below, 1.0);
      if (uneven < least) least = uneven, best = centre;
    }
    return best;
  }

 private:
  const ClearanceCounts& counts_;
};

/// Consecutive steps of one share.
struct Pool {
  double ground, all;
  std::size_t steps;

  double share() const { return all > 0 ? std::min(1.0, ground / all) : 0.0; }
  void add(const Pool& other) { ground += other.ground, all += other.all, steps += other.steps; }
};

/// Shares that fall with the height; where the counts do not, neighbouring steps have one share.
template <typename GroundAt>
GroundShares fallingShares(const HeightCounts& heights, const GroundAt& groundAt) {
  std::vector<Pool> pools;
  for (long step = 0; step < HeightCounts::END; ++step) {
    pools.push_back({groundAt(step), heights.at(step), 1});
    while (pools.size() > 1 && !(pools.back().share() < pools[pools.size() - 2].share())) {
      const Pool last = pools.back();
      pools.pop_back();
      pools.back().add(last);
    }
  }
  GroundShares shares;
  auto next = shares.begin();
  for (const Pool& pool : pools) next = std::fill_n(next, pool.steps, static_cast<float>(pool.share()));
  return shares;
}

}  // namespace

RobustLabels labelRobust(const PointsView& points, const RobustGround& ground) {
  RobustLabels result{Labels(static_cast<std::size_t>(points.cols()), Label::GROUND), 0};
  if (ground.surface.height.size() == 0) return result;
  const Clearance clearance(ground, points);
  const auto highest = static_cast<float>(ground.tolerance);
  const auto deepest = static_cast<float>(ground.depth_tolerance);
  const auto labelPart = [&](const PointsView& part, Label* labels) {
    Clearance::Block block;
    std::size_t count_below = 0;
    for (std::size_t begin = 0; begin < static_cast<std::size_t>(part.cols()); begin += block.count) {
      clearance.read(part, begin, block);
      for (std::size_t n = 0; n < block.count; ++n) {
        const bool below = block.below[n] > deepest;
        labels[begin + n] = (below | (block.above[n] > highest)) ? Label::OBJECT : Label::GROUND;
        count_below += below ? 1 : 0;
      }
    }
    return count_below;
  };
  for (const std::size_t below :
       resultsOfRanges(points.cols(), POINTS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
         return labelPart(points.middleCols(begin, end - begin), result.labels.data() + begin);
       }))
    result.below += below;
  return result;
}

GroundShares groundShares(const ClearanceCounts& counts, const RobustGround& ground) {
  constexpr float FOOT = 0.1F;  // where the ground is rarer its points are objects as they are further up
  if (!(ground.depth_tolerance > 0)) return {};
  const HeightCounts heights(counts);
  const long centre = heights.centre(ground.scale * ClearanceCounts::STEPS / ground.depth_tolerance);
  const auto mirrored = [&](long step) { return heights.at(2 * centre - 1 - step); };
  const GroundShares least = fallingShares(heights, mirrored);
  const long foot = std::distance(
      least.begin(), std::find_if(least.begin(), least.end(), [](float share) { return share < FOOT; }));
  const long end = std::min(2 * foot - centre, HeightCounts::END);
  double objects = 0;
  for (long step = foot; step < end; ++step) objects += heights.at(step) - mirrored(step);
  if (end > foot) objects /= static_cast<double>(end - foot);
  return fallingShares(heights, [&](long step) {
    return step < foot && end > foot ? std::max(mirrored(step), heights.at(step) - objects) : mirrored(step);
  });
}

std::vector<float> groundProbability(const PointsView& points, const RobustGround& ground) {
  std::vector<float> result(static_cast<std::size_t>(points.cols()), 1.0F);
  if (ground.surface.height.size() == 0 || !(ground.depth_tolerance > 0)) return result;
  const Clearance clearance(ground, points);
  const auto deepest = static_cast<float>(ground.depth_tolerance);
  const auto per_metre = static_cast<float>(ClearanceCounts::STEPS / ground.depth_tolerance);
  forEachRange(points.cols(), POINTS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
    Clearance::Block block;
    for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end);) {
      clearance.read(points.leftCols(end), n, block);
      for (std::size_t k = 0; k < block.count; ++k, ++n) {
        const float step = std::max(block.above[k], 0.0F) * per_metre;
        const bool is_near = step < ClearanceCounts::STEPS && !(block.below[k] > deepest);
        result[n] = !is_near             ? 0.0F
                    : block.above[k] > 0 ? ground.shares[static_cast<std::size_t>(step)]
                                         : 1.0F;
      }
    }
  });
  return result;
}

}  // namespace pcl_fft_ground::core
