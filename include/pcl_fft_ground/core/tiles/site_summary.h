#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/scan/frame.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"
#include "pcl_fft_ground/core/scan/prepare.h"

/// What prepare() finds out about a scan that is whole, for a site whose points come in parts, one after the
/// other, and are never held together.
namespace pcl_fft_ground::core {

/// Which points of a site can be worked with.
enum class PointUse {
  USED,
  FAR,      ///< finite, but too far from all others to belong to the site
  UNUSABLE  ///< not finite
};

/// Tells the points of a site that can be worked with from those that cannot, each by itself.
class PCL_FFT_GROUND_CORE_EXPORT SiteBounds {
 public:
  /// \param sample points of the site, evenly taken: they tell what is far from all others
  explicit SiteBounds(RawPoints sample);

  /// \param within coordinates beyond these are far [m]
  explicit SiteBounds(const Bounds& within) : within_(within) {}

  const Bounds& within() const { return within_; }
  PointUse useOf(const Eigen::Vector3f& point) const;

  /// The points that are used, in their order.
  Points usedOf(const RawPoints& part) const;

 private:
  Bounds within_;
};

/// Bounds and number of points that come in parts.
class PCL_FFT_GROUND_CORE_EXPORT BoundsInParts {
 public:
  void add(const PointsView& part);
  Eigen::Index points() const { return points_; }
  const Bounds& bounds() const { return bounds_; }

 private:
  Eigen::Index points_ = 0;
  Bounds bounds_;
};

class MomentsInParts;

/// summarise() for points that come in parts, bit for bit.
class PCL_FFT_GROUND_CORE_EXPORT StatisticsInParts {
 public:
  /// \param bounds of all points, and how many there are
  explicit StatisticsInParts(const BoundsInParts& bounds);
  ~StatisticsInParts();
  void add(const PointsView& part);

  /// Of all points, once they are all added.
  PointStatistics statistics() const;

 private:
  std::unique_ptr<MomentsInParts> moments_;
};

/// The level frame of points that come in parts, and their bounds in it.
class PCL_FFT_GROUND_CORE_EXPORT LevelFrameInParts {
 public:
  /// \param statistics of all points
  /// \param up a unit vector in the frame of the points
  LevelFrameInParts(const PointStatistics& statistics, const Eigen::Vector3d& up);
  void add(const PointsView& part);

  struct Result {
    Eigen::Isometry3d frame_from_input;
    Bounds bounds;  ///< of the points in that frame, as floats
  };
  Result result(Yaw yaw) const;

 private:
  PointStatistics statistics_;
  Eigen::Vector3d up_;
  Points outermost_;                   // those points among which are the corners of the hull
  std::vector<Eigen::Vector2d> hull_;  // seen along up, before it is turned about it
  double lowest_, highest_;
};

}  // namespace pcl_fft_ground::core
