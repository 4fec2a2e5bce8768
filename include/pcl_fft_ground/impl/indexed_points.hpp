#pragma once

#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "pcl_fft_ground/core/scan/prepare.h"

namespace pcl_fft_ground::impl {

/// The points of a cloud that are to be worked on: those of an index list or, without one, all.
template <typename PointT>
class IndexedPoints {
 public:
  /// \param indices may be null: all points
  IndexedPoints(const pcl::PointCloud<PointT>& cloud, const pcl::Indices* indices)
      : cloud_(cloud), indices_(indices) {}

  std::size_t size() const { return indices_ ? indices_->size() : cloud_.size(); }
  pcl::index_t index(std::size_t n) const { return indices_ ? (*indices_)[n] : static_cast<pcl::index_t>(n); }
  const PointT& operator[](std::size_t n) const { return cloud_[static_cast<std::size_t>(index(n))]; }

  /// True if x, y and z of a point are finite, whatever `is_dense` claims.
  bool isFinite(std::size_t n) const {
    const PointT& p = (*this)[n];
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  }

  /// True if every index lies within the cloud.
  bool areValid() const {
    if (!indices_) return true;
    for (const pcl::index_t i : *indices_)
      if (i < 0 || static_cast<std::size_t>(i) >= cloud_.size()) return false;
    return true;
  }

  /// All points in the order of the list, finite or not.
  core::RawPoints rawPoints() const {
    core::RawPoints points(3, static_cast<Eigen::Index>(size()));
    for (std::size_t n = 0; n < size(); ++n) {
      const PointT& p = (*this)[n];
      points.col(static_cast<Eigen::Index>(n)) =
          Eigen::Vector3f(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
    }
    return points;
  }

  /// The finite points in the order of the list.
  core::Points finitePoints() const {
    core::Points points(3, static_cast<Eigen::Index>(size()));
    Eigen::Index count = 0;
    for (std::size_t n = 0; n < size(); ++n) {
      const PointT& p = (*this)[n];
      points.col(count) =
          Eigen::Vector3f(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
      if (isFinite(n)) ++count;
    }
    if (count < points.cols()) points.conservativeResize(Eigen::NoChange, count);
    return points;
  }

  /// Where in the list the finite points stand; empty if all of them are finite.
  /// \param finite_count how many are
  std::vector<std::size_t> finitePositions(std::size_t finite_count) const {
    if (finite_count == size()) return {};
    std::vector<std::size_t> positions;
    positions.reserve(finite_count);
    for (std::size_t n = 0; n < size(); ++n)
      if (isFinite(n)) positions.push_back(n);
    return positions;
  }

 private:
  const pcl::PointCloud<PointT>& cloud_;
  const pcl::Indices* indices_;
};

}  // namespace pcl_fft_ground::impl
