#include "ground/robust_clearance.h"
#include "pcl_fft_ground/core/ground/robust_ground.h"
#include "pcl_fft_ground/core/scan/threads.h"

namespace pcl_fft_ground::core {

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

}  // namespace pcl_fft_ground::core
