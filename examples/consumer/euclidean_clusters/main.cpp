// Takes the ground out of a scan and counts the objects on it with PCL's own clustering.
#include "../scene.h"

#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl_fft_ground/fft_ground_segmentation.h>

#include <cstdlib>
#include <iostream>
#include <vector>

int main() {
  const auto scan = makeScene();

  pcl_fft_ground::FFTGroundSegmentation<pcl::PointXYZ> segmentation;
  segmentation.setMaximumObjectSize(1.0);
  segmentation.setHeightTolerance(0.1);
  segmentation.setInputCloud(scan);
  const auto objects = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  segmentation.filter(*objects);

  // The search tree is given explicitly: for an organised cloud PCL would choose a search that needs a
  // camera's image.
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> clustering;
  clustering.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  clustering.setClusterTolerance(0.05);
  clustering.setMinClusterSize(100);
  clustering.setInputCloud(objects);
  std::vector<pcl::PointIndices> segments;
  clustering.extract(segments);

  std::cout << segments.size() << " segments in " << objects->size() << " of " << scan->size() << " points\n";
  return segments.size() == 2 ? EXIT_SUCCESS : EXIT_FAILURE;
}
