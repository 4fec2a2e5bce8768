#include "commands/evaluate/cloud_evaluation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "errors.h"
#include "methods/segmentation.h"

namespace pcl_fft_ground::cli {
namespace {

/// The field that `simulate --ground-heights` writes; one of whole numbers is something else, such as a flag.
const pcl::PCLPointField* findGroundHeights(const pcl::PCLPointCloud2& fields) {
  const pcl::PCLPointField* const field = findField(fields, "ground");
  if (field == nullptr || field->count != 1) return nullptr;
  const bool is_real =
      field->datatype == pcl::PCLPointField::FLOAT32 || field->datatype == pcl::PCLPointField::FLOAT64;
  return is_real ? field : nullptr;
}

std::vector<Eigen::Vector3d> trueGroundOf(const Cloud& cloud) {
  const pcl::PCLPointField* const field = findGroundHeights(cloud.fields);
  const std::vector<double> heights =
      field != nullptr ? fieldNumbers(cloud.fields, *field) : std::vector<double>();
  std::vector<Eigen::Vector3d> ground;
  for (std::size_t n = 0; n < cloud.points->size(); ++n) {
    Eigen::Vector3d p = (*cloud.points)[n].getVector3fMap().cast<double>();
    if (field != nullptr)
      p.z() = heights[n] - cloud.origin.z();
    else if (cloud.labels[n] != 0)
      continue;
    if (p.allFinite()) ground.push_back(p);
  }
  return ground;
}

/// Root mean square of the heights of the true ground above the surface [m].
std::optional<double> surfaceError(const std::vector<Eigen::Vector3d>& true_ground,
                                   const core::GroundSurface& surface) {
  if (true_ground.empty() || surface.height.size() == 0) return std::nullopt;
  double sum = 0;
  for (const Eigen::Vector3d& p : true_ground) sum += std::pow(surface.heightAbove(p), 2);
  return std::sqrt(sum / static_cast<double>(true_ground.size()));
}

}  // namespace

LabelledCloud readLabelledCloud(const std::string& path, const ReadOptions& options) {
  LabelledCloud result{path, readCloud(path, options), {}};
  if (!result.cloud.label_fault.empty()) throw WorkError(path + ": " + result.cloud.label_fault);
  if (result.cloud.labels.empty())
    throw WorkError(path + ": has no field 'label' (0 ground, 1 object) to compare with");
  const std::vector<int>& labels = result.cloud.labels;
  if (std::none_of(labels.begin(), labels.end(), [](int label) { return label == 0 || label == 1; }))
    throw WorkError(path + ": none of its labels means ground or object");
  requireFinitePoint(path, *result.cloud.points);
  result.true_ground = trueGroundOf(result.cloud);
  return result;
}

Evaluation evaluateMethod(const LabelledCloud& cloud, Segmenter& segmenter) {
  Evaluation result;
  EvaluationRow& row = result.row;
  row.cloud = cloud.path;
  row.method = segmenter.method;
  GroundSegmentation<Point>& filter = *segmenter.filter;
  setInput(cloud.cloud, segmenter);
  pcl::PointIndices ground, objects;
  const auto start = std::chrono::steady_clock::now();
  filter.segment(ground, objects);
  row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  row.failure = filter.getError();
  if (!row.failure.empty()) return result;
  row.surface_rmse = surfaceError(cloud.true_ground, filter.getGroundSurface());
  result.labels = labelsOf(cloud.cloud.points->size(), ground, objects);
  row.confusion = core::compare(cloud.cloud.labels, result.labels);
  return result;
}

}  // namespace pcl_fft_ground::cli
