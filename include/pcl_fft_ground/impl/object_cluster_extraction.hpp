#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "pcl_fft_ground/core/scan/frame.h"
#include "pcl_fft_ground/impl/cluster_extraction.hpp"
#include "pcl_fft_ground/object_cluster_extraction.h"

namespace pcl_fft_ground {

template <typename PointT>
void ObjectClusterExtraction<PointT>::setMinimumObjectSize(double size) {
  this->require(std::isfinite(size) && size > 0, "minimum object size", size,
                "a finite number of metres above 0");
  minimum_object_size_ = size;
}

template <typename PointT>
void ObjectClusterExtraction<PointT>::setUpDirection(const Eigen::Vector3d& up) {
  const double length = up.stableNorm();
  this->require(up.allFinite() && length > 0, "length of the up direction", length,
                "a finite number above 0");
  up_ = (up / up.cwiseAbs().maxCoeff()).normalized();
}

template <typename PointT>
std::string ObjectClusterExtraction<PointT>::problem(std::size_t count) const {
  if (heights_.empty() || heights_.size() == input_->size() || heights_.size() == count) return "";
  return std::to_string(heights_.size()) + " heights for " + std::to_string(count) + " points";
}

template <typename PointT>
std::vector<std::vector<Eigen::Index>> ObjectClusterExtraction<PointT>::clustersOf(
    core::Points points) const {
  Eigen::Isometry3d level = Eigen::Isometry3d::Identity();
  level.linear() = Eigen::Quaterniond::FromTwoVectors(up_, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  // Creases look the same from a little aside: then the voxels are those of VoxelClusterExtraction.
  constexpr double LEVEL = 0.985;  // cosine of 10 degrees
  if (up_.z() < LEVEL) points = core::transformed(std::move(points), level);
  return core::objectClusters(points, {this->getLeafSize(), getMinimumObjectSize()});
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_ObjectClusterExtraction(T) \
  template class PCL_FFT_GROUND_FILTERS_EXPORT pcl_fft_ground::ObjectClusterExtraction<T>;
