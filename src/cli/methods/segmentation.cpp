#include "methods/segmentation.h"

#include <algorithm>
#include <cmath>

#include "errors.h"
#include "pcl_fft_ground/core/scan/prepare.h"
#include "pcl_fft_ground/object_cluster_extraction.h"
#include "pcl_fft_ground/voxel_cluster_extraction.h"

namespace pcl_fft_ground::cli {
namespace {

/// The highest point of each cell in the frame of the method, whatever cells it has itself.
core::ElevationGrid elevationOf(const Segmenter& segmenter) {
  const core::Points level = segmenter.filter->getLevelPoints();
  return core::rasteriseHighest(level, core::gridAround(core::boundsOf(level), segmenter.cellSize()));
}

/// A ground surface at the cells of the elevation, whatever cells it has itself.
core::GroundSurface atCells(const core::GroundSurface& surface, const core::GridGeometry& cells) {
  const core::GridGeometry& own = surface.geometry;
  if (own.rows == cells.rows && own.cols == cells.cols && own.cell_size == cells.cell_size) return surface;
  core::GroundSurface result{surface.frame_from_input, cells, Eigen::ArrayXXd(cells.rows, cells.cols)};
  for (Eigen::Index j = 0; j < cells.cols; ++j)
    for (Eigen::Index i = 0; i < cells.rows; ++i) {
      const Eigen::Vector2d place(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5);
      const Eigen::Vector2d centre = cells.origin + cells.cell_size * place;
      result.height(i, j) = surface.heightAt(centre.x(), centre.y());
    }
  return result;
}

}  // namespace

void requireFinitePoint(const std::string& path, const pcl::PointCloud<Point>& points) {
  const auto finite = [](const Point& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  if (std::none_of(points.begin(), points.end(), finite))
    throw WorkError(path + ": none of its " + std::to_string(points.size()) +
                    " points is finite; at least one has to be");
}

core::UsablePoints usablePoints(const pcl::PointCloud<Point>& cloud) {
  core::RawPoints points(3, static_cast<Eigen::Index>(cloud.size()));
  for (std::size_t n = 0; n < cloud.size(); ++n)
    points.col(static_cast<Eigen::Index>(n)) = cloud[n].getVector3fMap();
  return core::usablePoints(std::move(points));
}

void setInput(const Cloud& cloud, Segmenter& segmenter) {
  segmenter.filter->setInputCloud(cloud.points);
  if (segmenter.sensor) segmenter.filter->setSensorPosition(*segmenter.sensor - cloud.origin);
}

core::Labels labelsOf(std::size_t count, const pcl::PointIndices& ground, const pcl::PointIndices& objects) {
  core::Labels labels(count, core::Label::NEITHER);
  for (const pcl::index_t n : ground.indices) labels[static_cast<std::size_t>(n)] = core::Label::GROUND;
  for (const pcl::index_t n : objects.indices) labels[static_cast<std::size_t>(n)] = core::Label::OBJECT;
  return labels;
}

Segmentation segmentCloud(const std::string& path, const Cloud& cloud, Segmenter& segmenter) {
  requireFinitePoint(path, *cloud.points);
  Segmentation result;
  setInput(cloud, segmenter);
  segmenter.filter->segment(result.ground, result.objects);
  if (!segmenter.filter->getError().empty()) throw WorkError(path + ": " + segmenter.filter->getError());
  result.labels = labelsOf(cloud.points->size(), result.ground, result.objects);
  result.elevation = elevationOf(segmenter);
  result.surface = atCells(segmenter.filter->getGroundSurface(), result.elevation.geometry);
  if (!cloud.labels.empty()) result.confusion = core::compare(cloud.labels, result.labels);
  return result;
}

void clusterObjects(const Cloud& cloud, const ClusterParameters& parameters, Segmentation& segmentation) {
  const auto extract = [&](auto& extraction) {
    extraction.setInputCloud(cloud.points);
    extraction.setIndices(pcl::IndicesConstPtr(new pcl::Indices(segmentation.objects.indices)));
    extraction.setLeafSize(parameters.leaf_size);
    extraction.setMinClusterSize(static_cast<pcl::uindex_t>(parameters.min_cluster_size));
    extraction.setMaxClusterSize(static_cast<pcl::uindex_t>(
        std::min<std::size_t>(parameters.max_cluster_size, std::numeric_limits<pcl::uindex_t>::max())));
    extraction.extract(segmentation.clusters);
  };
  if (parameters.clusters == Clusters::CONTACT) {
    VoxelClusterExtraction<Point> extraction;
    extract(extraction);
  } else {
    ObjectClusterExtraction<Point> extraction;
    extraction.setMinimumObjectSize(parameters.minimum_object_size);
    extraction.setUpDirection(segmentation.surface.frame_from_input.linear().row(2).transpose());
    extract(extraction);
  }

  segmentation.segments.assign(cloud.points->size(), 0);
  for (std::size_t k = 0; k < segmentation.clusters.size(); ++k)
    for (const pcl::index_t n : segmentation.clusters[k].indices)
      segmentation.segments[static_cast<std::size_t>(n)] = static_cast<std::int32_t>(k + 1);
}

}  // namespace pcl_fft_ground::cli
