#pragma once

#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "pcl_fft_ground/core/scan/point_statistics.h"
#include "pcl_fft_ground/core/scan/prepare.h"
#include "pcl_fft_ground/core/scan/threads.h"
#include "pcl_fft_ground/impl/cloud_view.hpp"

namespace pcl_fft_ground::impl {

/// The finite ones of some points.
struct FinitePoints {
  core::Points points;
  std::vector<std::size_t> positions;  ///< where they stand among all; empty if all are finite

  /// Where the n-th finite point stands.
  std::size_t position(Eigen::Index n) const {
    return positions.empty() ? static_cast<std::size_t>(n) : positions[static_cast<std::size_t>(n)];
  }
};

/// The points of a cloud that are to be worked on: those of an index list or, without one, all.
template <typename PointT>
class IndexedPoints {
 public:
  using Cloud = typename CloudView<PointT>::Cloud;

  /// \param indices may be null: all points
  IndexedPoints(const Cloud& cloud, const pcl::Indices* indices) : cloud_(cloud), indices_(indices) {}

  std::size_t size() const { return indices_ ? indices_->size() : cloud_.size(); }
  pcl::index_t index(std::size_t n) const { return indices_ ? (*indices_)[n] : static_cast<pcl::index_t>(n); }
  Eigen::Vector3d place(std::size_t n) const { return cloud_.place(position(n)); }

  /// True if x, y and z of a point are finite, whatever `is_dense` claims.
  bool isFinite(std::size_t n) const { return cloud_.isFinite(position(n)); }

  /// True if the cloud can be read and every index lies within it.
  bool areValid() const { return cloud_.problem().empty() && !isBeyond(); }

  /// Why the points are not valid; empty if they are.
  std::string problem() const {
    if (!cloud_.problem().empty()) return std::string(cloud_.problem());
    if (!isBeyond()) return "";
    return "the indices reach beyond the cloud of " + std::to_string(cloud_.size()) + " points";
  }

  /// What is to be subtracted from the points, or a float would not hold their details: core::wholeOrigin()
  /// of coordinates in double, zero of others, which have lost what a float does not hold.
  Eigen::Vector3d origin() const {
    if (!cloud_.isDouble()) return Eigen::Vector3d::Zero();
    std::array<std::vector<double>, 3> xyz;
    for (std::vector<double>& values : xyz) values.reserve(size());
    for (std::size_t n = 0; n < size(); ++n) {
      const Eigen::Vector3d p = place(n);
      for (std::size_t axis = 0; axis < 3; ++axis) xyz[axis].push_back(p[static_cast<Eigen::Index>(axis)]);
    }
    return {core::wholeOrigin(std::move(xyz[0])), core::wholeOrigin(std::move(xyz[1])),
            core::wholeOrigin(std::move(xyz[2]))};
  }

  /// All points in the order of the list, finite or not, less an origin: that of origin().
  core::RawPoints rawPoints(const Eigen::Vector3d& origin = Eigen::Vector3d::Zero()) const {
    core::RawPoints points(3, static_cast<Eigen::Index>(size()));
    core::forEachRange(points.cols(), core::POINTS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
      for (Eigen::Index n = begin; n < end; ++n)
        points.col(n) = cloud_.local(position(static_cast<std::size_t>(n)), origin);
    });
    return points;
  }

  /// The finite points in the order of the list, and where they stand in it.
  FinitePoints finite() const {
    FinitePoints result{core::Points(3, static_cast<Eigen::Index>(size())), {}};
    std::size_t count = 0;
    for (std::size_t n = 0; n < size(); ++n) {
      result.points.col(static_cast<Eigen::Index>(count)) =
          cloud_.local(position(n), Eigen::Vector3d::Zero());
      if (isFinite(n)) {
        if (count++ < n) result.positions.push_back(n);
      } else if (count == n) {  // the first one
        result.positions.resize(n);
        std::iota(result.positions.begin(), result.positions.end(), std::size_t{0});
      }
    }
    if (count < size()) result.points.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(count));
    return result;
  }

 private:
  std::size_t position(std::size_t n) const { return static_cast<std::size_t>(index(n)); }

  bool isBeyond() const {
    return indices_ && std::any_of(indices_->begin(), indices_->end(), [this](pcl::index_t i) {
             return i < 0 || static_cast<std::size_t>(i) >= cloud_.size();
           });
  }

  CloudView<PointT> cloud_;
  const pcl::Indices* indices_;
};

}  // namespace pcl_fft_ground::impl
