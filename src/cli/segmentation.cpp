#include "segmentation.h"

#include <algorithm>
#include <cmath>

#include "errors.h"
#include "pcl_fft_ground/voxel_cluster_extraction.h"

namespace pcl_fft_ground::cli {
namespace {

core::Labels labelsOf(std::size_t count, const pcl::PointIndices& ground, const pcl::PointIndices& objects) {
  core::Labels labels(count, core::Label::NEITHER);
  for (const pcl::index_t n : ground.indices) labels[static_cast<std::size_t>(n)] = core::Label::GROUND;
  for (const pcl::index_t n : objects.indices) labels[static_cast<std::size_t>(n)] = core::Label::OBJECT;
  return labels;
}

void requireFinitePoint(const std::string& path, const pcl::PointCloud<Point>& points) {
  const auto finite = [](const Point& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  if (std::none_of(points.begin(), points.end(), finite))
    throw WorkError(path + ": none of its " + std::to_string(points.size()) +
                    " points is finite; at least one has to be");
}

}  // namespace

Segmentation segmentCloud(const std::string& path, const Cloud& cloud, Segmenter& segmenter) {
  requireFinitePoint(path, *cloud.points);
  Segmentation result;
  segmenter.filter->setInputCloud(cloud.points);
  segmenter.filter->segment(result.ground, result.objects);
  if (!segmenter.filter->getError().empty()) throw WorkError(path + ": " + segmenter.filter->getError());
  result.labels = labelsOf(cloud.points->size(), result.ground, result.objects);
  result.elevation = segmenter.fft->getElevationGrid();
  result.surface = segmenter.fft->getGroundSurface();
  if (!cloud.labels.empty()) result.confusion = core::compare(cloud.labels, result.labels);
  return result;
}

void clusterObjects(const Cloud& cloud, const ClusterParameters& parameters, Segmentation& segmentation) {
  VoxelClusterExtraction<Point> extraction;
  extraction.setInputCloud(cloud.points);
  extraction.setIndices(pcl::IndicesConstPtr(new pcl::Indices(segmentation.objects.indices)));
  extraction.setLeafSize(parameters.leaf_size);
  extraction.setMinClusterSize(static_cast<pcl::uindex_t>(parameters.min_cluster_size));
  extraction.setMaxClusterSize(static_cast<pcl::uindex_t>(
      std::min<std::size_t>(parameters.max_cluster_size, std::numeric_limits<pcl::uindex_t>::max())));
  extraction.extract(segmentation.clusters);

  segmentation.segments.assign(cloud.points->size(), 0);
  for (std::size_t k = 0; k < segmentation.clusters.size(); ++k)
    for (const pcl::index_t n : segmentation.clusters[k].indices)
      segmentation.segments[static_cast<std::size_t>(n)] = static_cast<std::int32_t>(k + 1);
}

}  // namespace pcl_fft_ground::cli
