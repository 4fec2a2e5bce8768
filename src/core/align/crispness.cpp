#include "pcl_fft_ground/core/align/crispness.h"

#include <algorithm>
#include <vector>

#include "pcl_fft_ground/core/scan/frame.h"
#include "segments/voxel_set.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double SQUARE = 0.1;  // of the overlap [m]

void addVoxels(const PointsView& points, double voxel_size, VoxelSet& voxels) {
  for (Eigen::Index n = 0; n < points.cols(); ++n) voxels.findOrInsert(voxelOf(points.col(n), voxel_size));
}

Voxel squareOf(const PointsView& points, Eigen::Index n) {
  return {voxelCoordinate(points(0, n), SQUARE), voxelCoordinate(points(1, n), SQUARE), 0};
}

VoxelSet squaresOf(const PointsView& points) {
  VoxelSet squares;
  for (Eigen::Index n = 0; n < points.cols(); ++n) squares.findOrInsert(squareOf(points, n));
  return squares;
}

/// The points that stand on one of the squares.
Points pointsOn(const VoxelSet& squares, const PointsView& points) {
  Points kept = points;
  Eigen::Index count = 0;
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    if (squares.find(squareOf(points, n)) != NO_VOXEL) kept.col(count++) = points.col(n);
  kept.conservativeResize(Eigen::NoChange, count);
  return kept;
}

std::size_t occupied(const PointsView& points, double voxel_size) {
  VoxelSet voxels;
  addVoxels(points, voxel_size, voxels);
  return voxels.voxels().size();
}

std::size_t occupiedTogether(const PointsView& a, const PointsView& b, double voxel_size) {
  VoxelSet voxels;
  addVoxels(a, voxel_size, voxels);
  addVoxels(b, voxel_size, voxels);
  return voxels.voxels().size();
}

}  // namespace

std::size_t occupiedVoxels(const PointsView& moving, const PointsView& reference,
                           const Eigen::Isometry3d& reference_from_moving, double voxel_size) {
  return occupiedTogether(reference, transformed(moving, reference_from_moving), voxel_size);
}

double crispnessChange(std::size_t before, std::size_t after) {
  if (after == 0) return 0;
  return 100 * (static_cast<double>(after) - static_cast<double>(before)) / static_cast<double>(after);
}

std::optional<double> overlapCrispness(const PointsView& moving, const PointsView& reference,
                                       const Eigen::Isometry3d& reference_from_moving, double voxel_size) {
  const Points there = transformed(moving, reference_from_moving);
  const Points a = pointsOn(squaresOf(there), reference);
  const Points b = pointsOn(squaresOf(reference), there);
  const std::size_t apart = occupied(a, voxel_size) + occupied(b, voxel_size);
  if (apart == 0) return std::nullopt;
  return 2 * static_cast<double>(occupiedTogether(a, b, voxel_size)) / static_cast<double>(apart);
}

}  // namespace pcl_fft_ground::core
