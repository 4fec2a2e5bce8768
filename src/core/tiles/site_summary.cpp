#include "pcl_fft_ground/core/tiles/site_summary.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "pcl_fft_ground/core/scan/convex_hull.h"
#include "pcl_fft_ground/core/scan/far_points.h"
#include "scan/hull_filter.h"
#include "scan/in_parts.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

}  // namespace

SiteBounds::SiteBounds(RawPoints sample) : within_(reachOfScan(usablePoints(std::move(sample)).points)) {}

PointUse SiteBounds::useOf(const Eigen::Vector3f& point) const {
  if (!point.allFinite()) return PointUse::UNUSABLE;
  const Eigen::Array3d p = point.cast<double>();
  return (p < within_.low).any() || (p > within_.high).any() ? PointUse::FAR : PointUse::USED;
}

Points SiteBounds::usedOf(const RawPoints& part) const {
  Points used(3, part.cols());
  Eigen::Index count = 0;
  for (Eigen::Index n = 0; n < part.cols(); ++n)
    if (useOf(part.col(n)) == PointUse::USED) used.col(count++) = part.col(n);
  used.conservativeResize(Eigen::NoChange, count);
  return used;
}

void BoundsInParts::add(const PointsView& part) {
  if (part.cols() == 0) return;
  const Bounds bounds = boundsOf(part);
  if (points_ == 0) bounds_ = bounds;
  bounds_.low = bounds_.low.min(bounds.low);
  bounds_.high = bounds_.high.max(bounds.high);
  points_ += part.cols();
}

StatisticsInParts::StatisticsInParts(const BoundsInParts& bounds)
    : moments_(std::make_unique<MomentsInParts>(bounds.bounds(), bounds.points())) {}

StatisticsInParts::~StatisticsInParts() = default;

void StatisticsInParts::add(const PointsView& part) {
  moments_->add(part);
}

PointStatistics StatisticsInParts::statistics() const {
  return moments_->statistics();
}

LevelFrameInParts::LevelFrameInParts(const PointStatistics& statistics, const Eigen::Vector3d& up)
    : statistics_(statistics), up_(up), lowest_(INFINITE), highest_(-INFINITE) {}

void LevelFrameInParts::add(const PointsView& part) {
  if (part.cols() == 0) return;
  const Eigen::Isometry3d level = levelFrame(statistics_, up_, 0);
  const HorizontalProjection projection{level.linear().topRows<2>(), statistics_.mean};
  Points candidates(3, outermost_.cols() + part.cols());
  candidates << outermost_, part;
  hull_ = convexHull(outermostPoints(candidates, projection));
  std::vector<Eigen::Index> corners;
  for (const Eigen::Index n : HullFilter(hull_, projection).outside(candidates)) {
    const Eigen::Vector2d place = projection(candidates.col(n));
    if (std::find(hull_.begin(), hull_.end(), place) != hull_.end()) corners.push_back(n);
  }
  outermost_ = Points(candidates(Eigen::all, corners));
  for (Eigen::Index n = 0; n < part.cols(); ++n) {
    const double height = level.linear().row(2).dot(part.col(n).cast<double>()) + level.translation().z();
    lowest_ = std::min(lowest_, height);
    highest_ = std::max(highest_, height);
  }
}

LevelFrameInParts::Result LevelFrameInParts::result(Yaw yaw) const {
  const double angle = yawOf(yaw, statistics_, up_, hull_);
  Result result{levelFrame(statistics_, up_, angle), {}};
  if (hull_.empty()) return result;
  result.bounds = boundsOf(transformed(outermost_, result.frame_from_input));
  result.bounds.low.z() = static_cast<double>(static_cast<float>(lowest_));
  result.bounds.high.z() = static_cast<double>(static_cast<float>(highest_));
  return result;
}

}  // namespace pcl_fft_ground::core
