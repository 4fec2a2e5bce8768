#pragma once

#include <pcl/exceptions.h>

#include <Eigen/Geometry>
#include <stdexcept>

#include <pcl/impl/pcl_base.hpp>

#include "pcl_fft_ground/core/scan/prepare.h"
#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/impl/indexed_points.hpp"
#include "pcl_fft_ground/scan_describer.h"

namespace pcl_fft_ground {
namespace impl {

/// The usable points of a cloud, columns being places in the list of indices; none where an index lies beyond
/// it.
template <typename PointT>
core::UsablePoints usablePointsOf(const pcl::PointCloud<PointT>& cloud, const pcl::Indices* indices) {
  const IndexedPoints<PointT> listed(cloud, indices);
  return listed.areValid() ? core::usablePoints(listed.rawPoints()) : core::UsablePoints();
}

/// A label for each usable point.
template <typename PointT>
core::Labels labelsOf(const IndexedPoints<PointT>& listed, std::size_t cloud_size,
                      const core::UsablePoints& usable, const pcl::PointIndices& objects) {
  std::vector<bool> is_object(cloud_size, false);
  for (const pcl::index_t n : objects.indices) is_object[static_cast<std::size_t>(n)] = true;
  core::Labels labels;
  for (Eigen::Index n = 0; n < usable.points.cols(); ++n) {
    const pcl::index_t point = listed.index(static_cast<std::size_t>(usable.column(n)));
    labels.push_back(is_object[static_cast<std::size_t>(point)] ? core::Label::OBJECT : core::Label::GROUND);
  }
  return labels;
}

/// The columns of the usable points that belong to each cluster.
template <typename PointT>
std::vector<std::vector<Eigen::Index>> columnsOf(const IndexedPoints<PointT>& listed, std::size_t cloud_size,
                                                 const core::UsablePoints& usable,
                                                 const std::vector<pcl::PointIndices>& clusters) {
  std::vector<Eigen::Index> column_of(cloud_size, -1);
  for (Eigen::Index n = 0; n < usable.points.cols(); ++n)
    column_of[static_cast<std::size_t>(listed.index(static_cast<std::size_t>(usable.column(n))))] = n;
  std::vector<std::vector<Eigen::Index>> result;
  for (const pcl::PointIndices& cluster : clusters) {
    std::vector<Eigen::Index>& columns = result.emplace_back();
    for (const pcl::index_t n : cluster.indices) {
      if (n < 0 || static_cast<std::size_t>(n) >= cloud_size)
        throw std::invalid_argument("the indices of a segment reach beyond its cloud");
      const Eigen::Index column = column_of[static_cast<std::size_t>(n)];
      if (column >= 0) columns.push_back(column);
    }
  }
  return result;
}

}  // namespace impl

template <typename PointT>
void ScanDescriber<PointT>::setSegmentParameters(const core::SegmentParameters& parameters) {
  try {
    core::validate(parameters);
  } catch (const std::invalid_argument& error) {
    throw pcl::PCLException(std::string("ScanDescriber: ") + error.what());
  }
  parameters_ = parameters;
}

template <typename PointT>
void ScanDescriber<PointT>::setUpDirection(const Eigen::Vector3d& up) {
  const double length = up.stableNorm();
  if (!up.allFinite() || !(length > 0))
    throw pcl::PCLException("ScanDescriber: length of the up direction is " + std::to_string(length) +
                            ", must be a finite number above 0");
  up_direction_ = up.stableNormalized();
}

template <typename PointT>
void ScanDescriber<PointT>::setSensorPosition(const std::optional<Eigen::Vector3d>& position) {
  if (position && !position->allFinite())
    throw pcl::PCLException("ScanDescriber: the sensor position is not finite");
  sensor_position_ = position;
}

template <typename PointT>
Eigen::Matrix3d ScanDescriber<PointT>::levelFromInput() const {
  return Eigen::Quaterniond::FromTwoVectors(up_direction_, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

template <typename PointT>
double ScanDescriber<PointT>::voxelSizeFor(const pcl::PointCloud<PointT>& cloud,
                                           const pcl::Indices* indices) const {
  return parameters_.voxel_size ? *parameters_.voxel_size
                                : core::voxelSizeFor(impl::usablePointsOf(cloud, indices).points);
}

template <typename PointT>
template <typename Describe>
core::ScanSegments ScanDescriber<PointT>::describeOrSayWhy(const pcl::PointCloud<PointT>& cloud,
                                                           const pcl::Indices* indices, double voxel_size,
                                                           const Describe& describe) {
  error_.clear();
  try {
    if (!impl::IndexedPoints<PointT>(cloud, indices).areValid())
      throw std::invalid_argument("an index lies beyond the cloud");
    core::UsablePoints usable = impl::usablePointsOf(cloud, indices);
    if (usable.points.cols() == 0)
      throw std::invalid_argument("none of its points is finite; at least one has to be");
    usable.points = (levelFromInput().template cast<float>() * usable.points).eval();
    core::SegmentParameters parameters = parameters_;
    if (voxel_size > 0) parameters.voxel_size = voxel_size;
    core::ScanSegments scan = describe(usable, parameters);
    if (sensor_position_) scan.sensor = levelFromInput() * *sensor_position_;
    return scan;
  } catch (const std::exception& error) {
    error_ = error.what();
    return {};
  }
}

template <typename PointT>
pcl::PointIndices ScanDescriber<PointT>::findObjects(const PointCloudConstPtr& cloud,
                                                     const pcl::IndicesConstPtr& indices) {
  typename GroundSegmentation<PointT>::Ptr ground = ground_;
  if (!ground) {
    ground.reset(new FFTGroundSegmentation<PointT>);
    ground->setUpDirection(up_direction_);
  }
  if (sensor_position_) ground->setSensorPosition(*sensor_position_);
  ground->setInputCloud(cloud);
  // Null for all points: PCLBase copies constant indices.
  ground->setIndices(indices ? pcl::IndicesPtr(new pcl::Indices(*indices)) : pcl::IndicesPtr());
  pcl::PointIndices below, objects;
  ground->segment(below, objects);
  if (!ground->getError().empty()) throw std::runtime_error(ground->getError());
  return objects;
}

template <typename PointT>
core::ScanSegments ScanDescriber<PointT>::describe(const PointCloudConstPtr& cloud,
                                                   const pcl::IndicesConstPtr& indices, double voxel_size) {
  return describeOrSayWhy(
      *cloud, indices.get(), voxel_size,
      [&](const core::UsablePoints& usable, const core::SegmentParameters& parameters) {
        const impl::IndexedPoints<PointT> listed(*cloud, indices.get());
        const auto from = [&](const Clusters& clusters) {
          return core::describeScan(usable.points, impl::columnsOf(listed, cloud->size(), usable, clusters),
                                    parameters);
        };
        if (!clusters_.empty()) return from(clusters_);
        const pcl::PointIndices objects = findObjects(cloud, indices);
        if (clusterer_)
          return from(clusterer_(cloud, pcl::IndicesConstPtr(new pcl::Indices(objects.indices))));
        return core::describeScan(usable.points, impl::labelsOf(listed, cloud->size(), usable, objects),
                                  parameters);
      });
}

template <typename PointT>
core::ScanSegments ScanDescriber<PointT>::describeAsGround(const PointCloudConstPtr& cloud,
                                                           const pcl::IndicesConstPtr& indices,
                                                           double voxel_size) {
  return describeOrSayWhy(*cloud, indices.get(), voxel_size,
                          [](const core::UsablePoints& usable, const core::SegmentParameters& parameters) {
                            const core::Labels labels(static_cast<std::size_t>(usable.points.cols()),
                                                      core::Label::GROUND);
                            return core::describeScan(usable.points, labels, parameters);
                          });
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_ScanDescriber(T) \
  template class PCL_FFT_GROUND_REGISTRATION_EXPORT pcl_fft_ground::ScanDescriber<T>;
