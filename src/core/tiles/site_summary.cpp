#include "pcl_fft_ground/core/tiles/site_summary.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "pcl_fft_ground/core/scan/convex_hull.h"
#include "pcl_fft_ground/core/scan/far_points.h"
#include "scan/hull_filter.h"
#include "scan/level_frame.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

/// The values as the coordinates of points hold them.
Eigen::Array3d asFloats(const Eigen::Array3d& values) {
  return values.cast<float>().cast<double>();
}

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

void StatisticsInParts::add(const PointsView& part) {
  if (part.cols() == 0) return;
  const Bounds bounds = boundsOf(part);
  if (points_ == 0) {
    bounds_ = bounds;
    first_ = part.col(0).cast<double>();
  }
  bounds_.low = bounds_.low.min(bounds.low);
  bounds_.high = bounds_.high.max(bounds.high);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (Eigen::Index n = 0; n < part.cols(); ++n) {
    const Eigen::Vector3d d = part.col(n).cast<double>() - first_;
    sum += d;
    products += d * d.transpose();
  }
  sum_ += sum;
  products_ += products;
  points_ += part.cols();
}

PointStatistics StatisticsInParts::statistics() const {
  PointStatistics result;
  if (points_ == 0) return result;
  const auto count = static_cast<double>(points_);
  const Eigen::Vector3d mean = sum_ / count;
  result.bounds = bounds_;
  result.mean = first_ + mean;
  result.covariance = products_ / count - mean * mean.transpose();
  return result;
}

LevelFrameInParts::LevelFrameInParts(const PointStatistics& statistics, const Eigen::Vector3d& up)
    : statistics_(statistics), up_(up), lowest_(INFINITE), highest_(-INFINITE) {}

void LevelFrameInParts::add(const PointsView& part) {
  if (part.cols() == 0) return;
  const Eigen::Isometry3d level = levelFrame(statistics_, up_, 0);
  const HorizontalProjection projection{level.linear().topRows<2>(), statistics_.mean};
  std::vector<Eigen::Vector2d> candidates = outermostPoints(part, projection);
  candidates.insert(candidates.end(), hull_.begin(), hull_.end());
  hull_ = convexHull(std::move(candidates));
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
  const Eigen::Rotation2Dd turned(-angle);
  Eigen::Array2d low = Eigen::Array2d::Constant(INFINITE), high = -low;
  for (const Eigen::Vector2d& corner : hull_) {
    const Eigen::Array2d p = turned * corner;
    low = low.min(p);
    high = high.max(p);
  }
  result.bounds.low = asFloats({low.x(), low.y(), lowest_});
  result.bounds.high = asFloats({high.x(), high.y(), highest_});
  return result;
}

}  // namespace pcl_fft_ground::core
