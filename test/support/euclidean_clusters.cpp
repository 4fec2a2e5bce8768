#include "euclidean_clusters.h"

#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>

namespace pcl_fft_ground::test {

std::vector<pcl::PointIndices> euclideanClusters(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud,
                                                 const pcl::IndicesConstPtr& indices, double tolerance,
                                                 pcl::uindex_t min_size) {
  // Left to itself, PCL takes OrganizedNeighbor for an organised cloud, which finds no neighbours here.
  const pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>);
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setInputCloud(cloud);
  if (indices) extraction.setIndices(indices);
  extraction.setSearchMethod(tree);
  extraction.setClusterTolerance(tolerance);
  extraction.setMinClusterSize(min_size);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);
  return clusters;
}

}  // namespace pcl_fft_ground::test
