#include "pcl_fft_ground/core/segments/segment.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "pcl_fft_ground/core/scan/prepare.h"
#include "pcl_fft_ground/core/segments/voxel_clusters.h"
#include "scan/parameter_check.h"
#include "scan/point_sample.h"
#include "segments/voxel_set.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double COVERAGE_CELL = 2.5;   // side of a cell of the coverage [voxels]
constexpr Eigen::Index RELIEF = 50000;  // points that are kept for the relief: 220 x 220
constexpr double BORDER = 3;  // a segment that comes nearer to the border may go on beyond it [voxels]

/// The mean of the points in each occupied voxel, in the order of the voxels' first points.
Points voxelMeans(const PointsView& points, double voxel_size) {
  VoxelSet occupied;
  std::vector<Eigen::Vector4d> sums;  // x, y, z and the number of points
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const auto voxel = static_cast<std::size_t>(occupied.findOrInsert(voxelOf(points.col(n), voxel_size)));
    if (voxel == sums.size()) sums.emplace_back(Eigen::Vector4d::Zero());
    sums[voxel] += points.col(n).cast<double>().homogeneous();
  }
  Points means(3, static_cast<Eigen::Index>(sums.size()));
  for (std::size_t voxel = 0; voxel < sums.size(); ++voxel)
    means.col(static_cast<Eigen::Index>(voxel)) = sums[voxel].hnormalized().cast<float>();
  return means;
}

Points gathered(const PointsView& points, const std::vector<Eigen::Index>& columns) {
  Points result(3, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t n = 0; n < columns.size(); ++n)
    result.col(static_cast<Eigen::Index>(n)) = points.col(columns[n]);
  return result;
}

/// Sorts the principal axes by falling spread.
void setPrincipalAxes(Segment& segment) {
  const Eigen::Matrix3Xd centred = segment.points.cast<double>().colwise() - segment.centroid;
  const Eigen::Matrix3d covariance = centred * centred.transpose() / static_cast<double>(centred.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  segment.axes = solver.eigenvectors().rowwise().reverse();
  segment.spreads = solver.eigenvalues().reverse().cwiseMax(0).cwiseSqrt();
}

Segment makeSegment(Points points, const ScanCoverage& coverage, double voxel_size) {
  Segment segment;
  segment.points = std::move(points);
  segment.centroid = segment.points.cast<double>().rowwise().mean();
  segment.extents =
      (segment.points.rowwise().maxCoeff() - segment.points.rowwise().minCoeff()).cast<double>();
  setPrincipalAxes(segment);
  for (Eigen::Index n = 0; n < segment.points.cols() && !segment.at_border; ++n)
    segment.at_border = !coverage.covers(segment.points.col(n).cast<double>(), BORDER * voxel_size);
  return segment;
}

/// Turns clusters, given by their mean points, into segments.
void addSegments(std::vector<Points> clusters, ScanSegments& scan) {
  std::vector<std::size_t> order;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    if (clusters[c].cols() < std::max<Eigen::Index>(1, static_cast<Eigen::Index>(scan.parameters.min_voxels)))
      continue;
    const Eigen::Vector3f extents = clusters[c].rowwise().maxCoeff() - clusters[c].rowwise().minCoeff();
    if (extents.maxCoeff() >= scan.parameters.min_extent) order.push_back(c);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return clusters[a].cols() > clusters[b].cols(); });
  order.resize(std::min(order.size(), scan.parameters.max_segments));
  for (const std::size_t c : order) {
    scan.segments.push_back(makeSegment(std::move(clusters[c]), scan.coverage, scan.voxel_size));
    scan.sources.push_back(static_cast<std::ptrdiff_t>(c));
  }
}

/// Those of the points that lie in a box.
Points pointsWithin(const Points& points, const Eigen::AlignedBox3f& box) {
  Points inside(3, points.cols());
  Eigen::Index count = 0;
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    if (box.contains(points.col(n))) inside.col(count++) = points.col(n);
  inside.conservativeResize(Eigen::NoChange, count);
  return inside;
}

/// The scan proper, whatever stray returns there are far away.
Eigen::AlignedBox3f boxWithoutFarPoints(const Points& points) {
  const Bounds bounds = usablePoints(points).statistics.bounds;
  return {bounds.low.cast<float>().matrix(), bounds.high.cast<float>().matrix()};
}

/// Finds the mean points of the voxels that objects occupy, as far as they belong to the scan proper.
class ObjectMeans {
 public:
  explicit ObjectMeans(const ScanSegments& scan) : voxel_size_(scan.voxel_size) {
    const Bounds bounds = boundsOf(scan.surface);
    box_ = {(bounds.low - voxel_size_).cast<float>().matrix(),
            (bounds.high + voxel_size_).cast<float>().matrix()};
  }

  Points of(const PointsView& points) const { return pointsWithin(voxelMeans(points, voxel_size_), box_); }

 private:
  double voxel_size_;
  Eigen::AlignedBox3f box_;
};

/// A scan without segments yet.
ScanSegments describeSurface(const PointsView& points, const SegmentParameters& parameters) {
  validate(parameters);
  ScanSegments scan;
  scan.parameters = parameters;
  scan.voxel_size = parameters.voxel_size ? *parameters.voxel_size : voxelSizeFor(points);
  const Points means = voxelMeans(points, scan.voxel_size);
  scan.surface = pointsWithin(means, boxWithoutFarPoints(means));
  scan.coverage = coverageOf(scan.surface, COVERAGE_CELL * scan.voxel_size);
  return scan;
}

/// Clusters the object points of a scan by contact of its voxels.
void clusterObjects(ScanSegments& scan) {
  std::vector<Points> clusters;
  for (const std::vector<Eigen::Index>& members : voxelClusters(scan.objects, scan.voxel_size))
    clusters.push_back(gathered(scan.objects, members));
  addSegments(std::move(clusters), scan);
}

/// Number of squares of the given side that hold a point.
std::size_t occupiedSquares(const PointsView& points, double side) {
  VoxelSet squares;
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    squares.findOrInsert({voxelCoordinate(points(0, n), side), voxelCoordinate(points(1, n), side), 0});
  return squares.voxels().size();
}

}  // namespace

void validate(const SegmentParameters& parameters) {
  const double voxel_size = parameters.voxel_size.value_or(1);
  require(std::isfinite(voxel_size) && voxel_size > 0, "voxel_size", voxel_size,
          "a number of metres above 0");
  require(parameters.min_extent >= 0, "min_extent", parameters.min_extent, "0 m or more");
}

double voxelSizeFor(const PointsView& points) {
  constexpr double FINEST = 0.02;
  constexpr double STEP = 0.01;
  constexpr double SPACINGS = 2.5;
  constexpr double ENOUGH = 6;  // points per square: nearly none is empty by chance
  const auto count = static_cast<double>(points.cols());
  if (count == 0) return FINEST;
  double side = 2 * FINEST;
  double squares = static_cast<double>(occupiedSquares(points, side));
  while (count / squares < ENOUGH && squares > 1) {
    side *= 2;
    squares = static_cast<double>(occupiedSquares(points, side));
  }
  if (squares <= 1) return FINEST;
  const double spacing = side * std::sqrt(squares / count);
  return std::max(FINEST, STEP * std::round(SPACINGS * spacing / STEP));
}

ScanSegments describeScan(const PointsView& points, const Labels& labels,
                          const SegmentParameters& parameters) {
  if (static_cast<std::size_t>(points.cols()) != labels.size())
    throw std::invalid_argument("there must be one label per point");
  std::vector<Eigen::Index> objects;
  for (std::size_t n = 0; n < labels.size(); ++n)
    if (labels[n] == Label::OBJECT) objects.push_back(static_cast<Eigen::Index>(n));
  ScanSegments scan = describeSurface(points, parameters);
  scan.relief = sampleOf(points, RELIEF);
  scan.objects = ObjectMeans(scan).of(gathered(points, objects));
  clusterObjects(scan);
  return scan;
}

ScanSegments describeScan(const PointsView& points, const std::vector<std::vector<Eigen::Index>>& clusters,
                          const SegmentParameters& parameters) {
  ScanSegments scan = describeSurface(points, parameters);
  scan.relief = sampleOf(points, RELIEF);
  const ObjectMeans object_means(scan);
  std::vector<Eigen::Index> objects;
  std::vector<Points> means;
  for (const std::vector<Eigen::Index>& cluster : clusters) {
    objects.insert(objects.end(), cluster.begin(), cluster.end());
    means.push_back(object_means.of(gathered(points, cluster)));
  }
  scan.objects = object_means.of(gathered(points, objects));
  addSegments(std::move(means), scan);
  return scan;
}

ScanSegments coarsened(const ScanSegments& scan, double voxel_size) {
  if (!(voxel_size > scan.voxel_size)) return scan;
  SegmentParameters parameters = scan.parameters;
  parameters.voxel_size = voxel_size;
  ScanSegments coarse = describeSurface(scan.surface, parameters);
  coarse.relief = scan.relief;
  coarse.sensor = scan.sensor;
  coarse.objects = ObjectMeans(coarse).of(scan.objects);
  clusterObjects(coarse);
  return coarse;
}

}  // namespace pcl_fft_ground::core
