// Counts and measures the objects of a scan: ground out, touching objects told apart, each of them measured.

#include <pcl/point_types.h>

#include <iostream>
#include <vector>

#include "pcl_fft_ground/core/segments/object_properties.h"
#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/object_cluster_extraction.h"
#include "pcl_fft_ground/simulation/simulation.h"

using Point = pcl::PointXYZ;
namespace core = pcl_fft_ground::core;

constexpr double LARGEST_OBJECT = 1.0;  // [m]

pcl::PointCloud<Point>::Ptr simulatePipes() {
  core::SimulationParameters parameters;
  parameters.scene = core::SceneKind::PIPES;
  parameters.object_share = 0.3;
  parameters.points = 100000;
  pcl::PointCloud<Point>::Ptr scan(new pcl::PointCloud<Point>);
  const Eigen::Matrix3Xf points = core::simulateScan(parameters).points;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    scan->push_back({points(0, i), points(1, i), points(2, i)});
  return scan;
}

core::ObjectProperties measure(const pcl::PointCloud<Point>& scan, const std::vector<double>& heights,
                               const pcl::Indices& indices, double leaf_size) {
  core::Points points(3, static_cast<Eigen::Index>(indices.size()));
  std::vector<double> own_heights;
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const auto n = static_cast<std::size_t>(indices[k]);
    points.col(static_cast<Eigen::Index>(k)) = scan[n].getVector3fMap();
    own_heights.push_back(heights[n]);
  }
  core::ObjectView view;
  view.leaf_size = leaf_size;
  return core::measureObject(points, own_heights, view);
}

int main() {
  const pcl::PointCloud<Point>::Ptr scan = simulatePipes();
  pcl_fft_ground::FFTGroundSegmentation<Point> filter;
  filter.setInputCloud(scan);
  filter.setMaximumObjectSize(LARGEST_OBJECT);
  pcl::IndicesPtr objects(new pcl::Indices);
  filter.filter(*objects);
  const std::vector<double> heights = filter.getHeightAboveGround();

  pcl_fft_ground::ObjectClusterExtraction<Point> extraction;
  extraction.setInputCloud(scan);
  extraction.setIndices(objects);
  extraction.setLeafSize(filter.getCellSize());
  extraction.setMinimumObjectSize(core::MINIMUM_OBJECT_SHARE * LARGEST_OBJECT);
  extraction.setHeightAboveGround(heights);
  extraction.setMinClusterSize(100);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);

  std::cout << clusters.size() << " objects\n";
  for (const pcl::PointIndices& cluster : clusters) {
    const core::ObjectProperties object = measure(*scan, heights, cluster.indices, filter.getCellSize());
    std::cout << object.lengths.x() << " m long, " << object.height << " m high, " << 1000 * object.volume
              << " l";
    if (object.body) std::cout << ", round: radius " << object.body->radius << " m";
    std::cout << '\n';
  }
  return clusters.empty() ? 1 : 0;
}
