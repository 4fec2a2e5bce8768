#include "commands/align/scan_description.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "errors.h"
#include "pcl_fft_ground/core/ground/labels.h"
#include "pcl_fft_ground/core/scan/far_points.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"

namespace pcl_fft_ground::cli {
namespace {

bool isFinitePoint(const Point& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// Column n of the points is point indices[n] of the cloud.
struct UsablePoints {
  core::Points points;
  pcl::Indices indices;
};

UsablePoints finitePoints(const std::string& path, const Cloud& cloud) {
  UsablePoints usable;
  usable.points.resize(3, static_cast<Eigen::Index>(cloud.points->size()));
  for (std::size_t n = 0; n < cloud.points->size(); ++n) {
    if (!isFinitePoint((*cloud.points)[n])) continue;
    usable.points.col(static_cast<Eigen::Index>(usable.indices.size())) = (*cloud.points)[n].getVector3fMap();
    usable.indices.push_back(static_cast<pcl::index_t>(n));
  }
  if (usable.indices.empty())
    throw WorkError(path + ": none of its points is finite; at least one has to be");
  usable.points.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(usable.indices.size()));
  return usable;
}

UsablePoints usablePointsOf(const std::string& path, const Cloud& cloud) {
  UsablePoints usable = finitePoints(path, cloud);
  const std::vector<Eigen::Index> far = core::findFarPoints(usable.points, core::summarise(usable.points));
  if (far.empty()) return usable;
  std::vector<Eigen::Index> near;
  for (Eigen::Index n = 0; n < usable.points.cols(); ++n)
    if (!std::binary_search(far.begin(), far.end(), n)) near.push_back(n);
  UsablePoints compact;
  compact.points = usable.points(Eigen::all, near);
  for (const Eigen::Index n : near) compact.indices.push_back(usable.indices[static_cast<std::size_t>(n)]);
  return compact;
}

/// What the core refuses for want of cells or by a parameter, with the name of the file.
template <typename Work>
auto namingFile(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const std::logic_error& error) {
    throw WorkError(path + ": " + error.what());
  }
}

}  // namespace

core::Points usablePoints(const std::string& path, const Cloud& cloud) {
  return usablePointsOf(path, cloud).points;
}

core::ScanCoverage coverageOf(const std::string& path, const core::Points& points) {
  constexpr double CELLS_PER_VOXEL = 2.5;
  return namingFile(path,
                    [&] { return core::coverageOf(points, CELLS_PER_VOXEL * core::voxelSizeFor(points)); });
}

core::ScanSegments describeCloud(const std::string& path, const Cloud& cloud, Segmenter& segmenter,
                                 const core::SegmentParameters& parameters) {
  const UsablePoints usable = usablePointsOf(path, cloud);
  pcl::PointIndices ground, objects;
  segmenter.filter->setInputCloud(cloud.points);
  segmenter.filter->segment(ground, objects);
  if (!segmenter.filter->getError().empty()) throw WorkError(path + ": " + segmenter.filter->getError());
  std::vector<bool> is_object(cloud.points->size(), false);
  for (const pcl::index_t n : objects.indices) is_object[static_cast<std::size_t>(n)] = true;
  core::Labels labels;
  for (const pcl::index_t n : usable.indices)
    labels.push_back(is_object[static_cast<std::size_t>(n)] ? core::Label::OBJECT : core::Label::GROUND);
  return namingFile(path, [&] { return core::describeScan(usable.points, labels, parameters); });
}

core::ScanSegments describeAsGround(const std::string& path, const core::Points& points,
                                    const core::SegmentParameters& parameters) {
  const core::Labels labels(static_cast<std::size_t>(points.cols()), core::Label::GROUND);
  return namingFile(path, [&] { return core::describeScan(points, labels, parameters); });
}

}  // namespace pcl_fft_ground::cli
