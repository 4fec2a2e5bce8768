#include "commands/align/scan_description.h"

#include <stdexcept>

#include "errors.h"
#include "methods/segmentation.h"
#include "pcl_fft_ground/core/ground/labels.h"

namespace pcl_fft_ground::cli {
namespace {

core::UsablePoints finitePoints(const std::string& path, const Cloud& cloud) {
  requireFinitePoint(path, *cloud.points);
  return usablePoints(*cloud.points);
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
  return finitePoints(path, cloud).points;
}

core::ScanCoverage coverageOf(const std::string& path, const core::Points& points) {
  constexpr double CELLS_PER_VOXEL = 2.5;
  return namingFile(path,
                    [&] { return core::coverageOf(points, CELLS_PER_VOXEL * core::voxelSizeFor(points)); });
}

core::ScanSegments describeCloud(const std::string& path, const Cloud& cloud, Segmenter& segmenter,
                                 const core::SegmentParameters& parameters) {
  const core::UsablePoints usable = finitePoints(path, cloud);
  pcl::PointIndices ground, objects;
  segmenter.filter->setInputCloud(cloud.points);
  segmenter.filter->segment(ground, objects);
  if (!segmenter.filter->getError().empty()) throw WorkError(path + ": " + segmenter.filter->getError());
  std::vector<bool> is_object(cloud.points->size(), false);
  for (const pcl::index_t n : objects.indices) is_object[static_cast<std::size_t>(n)] = true;
  core::Labels labels;
  for (Eigen::Index n = 0; n < usable.points.cols(); ++n)
    labels.push_back(is_object[static_cast<std::size_t>(usable.column(n))] ? core::Label::OBJECT
                                                                           : core::Label::GROUND);
  return namingFile(path, [&] { return core::describeScan(usable.points, labels, parameters); });
}

core::ScanSegments describeAsGround(const std::string& path, const core::Points& points,
                                    const core::SegmentParameters& parameters) {
  const core::Labels labels(static_cast<std::size_t>(points.cols()), core::Label::GROUND);
  return namingFile(path, [&] { return core::describeScan(points, labels, parameters); });
}

}  // namespace pcl_fft_ground::cli
