#include "align/scan_description.h"

#include <cmath>

#include "errors.h"
#include "pcl_fft_ground/core/labels.h"

namespace pcl_fft_ground::cli {
namespace {

bool isFinitePoint(const Point& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// Labels of the finite points, in order.
core::Labels labelFinitePoints(const Cloud& cloud, const pcl::PointIndices& objects) {
  std::vector<bool> is_object(cloud.points->size(), false);
  for (const pcl::index_t n : objects.indices) is_object[static_cast<std::size_t>(n)] = true;
  core::Labels labels;
  labels.reserve(is_object.size());
  for (std::size_t n = 0; n < is_object.size(); ++n)
    if (isFinitePoint((*cloud.points)[n]))
      labels.push_back(is_object[n] ? core::Label::OBJECT : core::Label::GROUND);
  return labels;
}

}  // namespace

Eigen::Isometry3d worldFromPoints(const Cloud& cloud) {
  return Eigen::Translation3d(cloud.sensor_origin.head<3>().cast<double>()) *
         cloud.sensor_orientation.cast<double>().normalized() * Eigen::Translation3d(cloud.origin);
}

core::Points finitePoints(const std::string& path, const Cloud& cloud) {
  core::Points points(3, static_cast<Eigen::Index>(cloud.points->size()));
  Eigen::Index count = 0;
  for (const Point& p : *cloud.points)
    if (isFinitePoint(p)) points.col(count++) = p.getVector3fMap();
  if (count == 0) throw WorkError(path + ": none of its points is finite; at least one has to be");
  points.conservativeResize(Eigen::NoChange, count);
  return points;
}

core::ScanSegments describeCloud(const std::string& path, const Cloud& cloud, Segmenter& segmenter,
                                 const core::SegmentParameters& parameters) {
  const core::Points points = finitePoints(path, cloud);
  pcl::PointIndices ground, objects;
  segmenter.filter->setInputCloud(cloud.points);
  segmenter.filter->segment(ground, objects);
  if (!segmenter.filter->getError().empty()) throw WorkError(path + ": " + segmenter.filter->getError());
  return core::describeScan(points, labelFinitePoints(cloud, objects), parameters);
}

}  // namespace pcl_fft_ground::cli
