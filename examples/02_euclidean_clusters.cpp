// Feeds the objects to pcl::EuclideanClusterExtraction, and to VoxelClusterExtraction, which does the same
// faster.

#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>

#include <iostream>

#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/simulation/simulation.h"
#include "pcl_fft_ground/voxel_cluster_extraction.h"

using Point = pcl::PointXYZ;

pcl::PointCloud<Point>::Ptr simulatePipes() {
  pcl_fft_ground::core::SimulationParameters parameters;
  parameters.scene = pcl_fft_ground::core::SceneKind::PIPES;
  parameters.points = 100000;
  pcl::PointCloud<Point>::Ptr scan(new pcl::PointCloud<Point>);
  const Eigen::Matrix3Xf points = pcl_fft_ground::core::simulateScan(parameters).points;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    scan->push_back({points(0, i), points(1, i), points(2, i)});
  return scan;
}

int main() {
  const pcl::PointCloud<Point>::Ptr scan = simulatePipes();
  pcl_fft_ground::FFTGroundSegmentation<Point> filter;
  filter.setInputCloud(scan);
  filter.setMaximumObjectSize(1.0);
  pcl::IndicesPtr objects(new pcl::Indices);
  filter.filter(*objects);

  pcl::EuclideanClusterExtraction<Point> by_distance;
  by_distance.setInputCloud(scan);
  by_distance.setIndices(objects);
  by_distance.setSearchMethod(pcl::search::KdTree<Point>::Ptr(new pcl::search::KdTree<Point>));
  by_distance.setClusterTolerance(0.03);
  by_distance.setMinClusterSize(100);
  std::vector<pcl::PointIndices> clusters;
  by_distance.extract(clusters);
  std::cout << clusters.size() << " clusters by distance\n";

  pcl_fft_ground::VoxelClusterExtraction<Point> by_contact;
  by_contact.setInputCloud(scan);
  by_contact.setIndices(objects);
  by_contact.setLeafSize(0.02);
  by_contact.setMinClusterSize(100);
  std::vector<pcl::PointIndices> segments;
  by_contact.extract(segments);
  std::cout << segments.size() << " segments by contact of voxels; the largest has "
            << segments.front().indices.size() << " points\n";
  return clusters.empty() || segments.empty() ? 1 : 0;
}
