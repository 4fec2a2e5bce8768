#pragma once

#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <vector>

namespace pcl_fft_ground::test {

/// The clusters that pcl::EuclideanClusterExtraction finds with an explicit search tree.
/// \param indices the points to cluster; null for all
std::vector<pcl::PointIndices> euclideanClusters(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud,
                                                 const pcl::IndicesConstPtr& indices, double tolerance,
                                                 pcl::uindex_t min_size);

}  // namespace pcl_fft_ground::test
