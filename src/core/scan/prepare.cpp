#include "pcl_fft_ground/core/scan/prepare.h"

#include <algorithm>
#include <utility>

#include "pcl_fft_ground/core/scan/far_points.h"
#include "pcl_fft_ground/core/scan/threads.h"

namespace pcl_fft_ground::core {
namespace {

/// Keeps the columns of a scan that a list names, in its order.
void keepColumns(Points& points, const std::vector<Eigen::Index>& kept) {
  for (std::size_t n = 0; n < kept.size(); ++n)
    points.col(static_cast<Eigen::Index>(n)) = points.col(kept[n]);
  points.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(kept.size()));
}

/// True if no coordinate is infinite, NaN or beyond a measure.
bool areMeasurable(const Points& points, float beyond) {
  const std::vector<char> parts =
      resultsOfRanges(points.cols(), POINTS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) -> char {
        const auto part = points.middleCols(begin, end - begin).array();
        // Faster than a look at each: nothing times a number that is not finite is NaN.
        return (part * 0.0F).sum() == 0.0F && part.maxCoeff() <= beyond && part.minCoeff() >= -beyond;
      });
  return std::all_of(parts.begin(), parts.end(), [](char is) { return is != 0; });
}

/// Leaves out what is not finite, and what is beyond all measure.
void keepMeasurable(UsablePoints& usable) {
  constexpr float BEYOND_MEASURE = 1e18F;
  Points& points = usable.points;
  const auto is_measurable = [&](Eigen::Index n) {  // false for NaN, too
    return (points.col(n).array().abs() <= BEYOND_MEASURE).all();
  };
  if (areMeasurable(points, BEYOND_MEASURE)) return;
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    if (is_measurable(n))
      usable.columns.push_back(n);
    else if (points.col(n).allFinite())
      usable.far.push_back(n);
  }
  keepColumns(points, usable.columns);
}

/// Leaves out the points that lie far from all others.
void keepNear(UsablePoints& usable, const std::vector<Eigen::Index>& far) {
  std::vector<Eigen::Index> near, columns, far_columns;
  auto next = far.begin();
  for (Eigen::Index n = 0; n < usable.points.cols(); ++n) {
    if (next != far.end() && *next == n) {
      far_columns.push_back(usable.column(n));
      ++next;
    } else {
      near.push_back(n);
      columns.push_back(usable.column(n));
    }
  }
  keepColumns(usable.points, near);
  usable.columns = std::move(columns);
  std::vector<Eigen::Index> all_far(usable.far.size() + far_columns.size());
  std::merge(usable.far.begin(), usable.far.end(), far_columns.begin(), far_columns.end(), all_far.begin());
  usable.far = std::move(all_far);
}

}  // namespace

UsablePoints usablePoints(RawPoints scan) {
  UsablePoints usable;
  usable.points = std::move(scan);
  keepMeasurable(usable);
  usable.statistics = summarise(usable.points);
  const std::vector<Eigen::Index> far = findFarPoints(usable.points, usable.statistics);
  if (far.empty()) return usable;
  keepNear(usable, far);
  usable.statistics = summarise(usable.points);
  return usable;
}

PreparedScan prepare(RawPoints scan, const FrameParameters& parameters) {
  PreparedScan prepared{usablePoints(std::move(scan)), {}};
  UsablePoints& usable = prepared.usable;
  prepared.up = estimateUp(usable.points, usable.statistics, parameters);
  prepared.frame_from_input = levelFrame(usable.points, usable.statistics, prepared.up.axis, parameters.yaw);
  usable.points = transformed(std::move(usable.points), prepared.frame_from_input);
  return prepared;
}

}  // namespace pcl_fft_ground::core
