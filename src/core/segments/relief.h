#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pcl_fft_ground/core/scan/points.h"
#include "segments/voxel_set.h"

namespace pcl_fft_ground::core {

using ColumnIndex = std::int32_t;
constexpr ColumnIndex NO_COLUMN = -1;

/// Steps to the eight neighbours of a column: counter-clockwise from +x; even numbers are straight ones, and
/// the direction opposite to d is (d + 4) % 8.
constexpr std::array<int, 8> STEP_X = {1, 1, 0, -1, -1, -1, 0, 1};
constexpr std::array<int, 8> STEP_Y = {0, 1, 1, 1, 0, -1, -1, -1};

/** Contact clusters seen from above: a height for each occupied column of each cluster.
 *
 * Lengths are in columns' sides. Columns are numbered by their place, not by the order of the points.
 */
class Relief {
 public:
  /// \param points finite points \param leaf_size side of the voxels of contact [m]; a column is half as
  /// wide, where the points are dense enough for that
  Relief(const PointsView& points, double leaf_size);

  std::size_t size() const { return height_.size(); }
  double side() const { return side_; }                          ///< of a column [m]
  const std::vector<float>& heights() const { return height_; }  ///< mean of the points' z
  /// Of a column, from the corner of its cluster's first one; whole numbers.
  double x(std::size_t column) const { return x_[column]; }
  double y(std::size_t column) const { return y_[column]; }
  std::int32_t cluster(std::size_t column) const { return cluster_[column]; }
  const std::array<ColumnIndex, 8>& neighbours(std::size_t column) const { return neighbours_[column]; }
  const std::vector<ColumnIndex>& columnOfPoint() const { return column_of_point_; }

  /// The column of a cluster at a place, or NO_COLUMN.
  ColumnIndex at(std::int32_t cluster, double x, double y) const;

 private:
  struct Blocks;
  void addColumns(const Blocks& blocks);
  void connect();

  double side_ = 1;
  int divisions_ = 1;  ///< columns along the side of a voxel
  VoxelSet blocks_;    ///< (i, j, cluster) of the voxels' columns
  std::vector<std::array<ColumnIndex, 4>> columns_of_block_;
  std::vector<Voxel> first_;  ///< per cluster: its first block
  std::vector<float> height_, x_, y_;
  std::vector<std::int32_t> cluster_;
  std::vector<std::int32_t> block_;  ///< per column
  std::vector<std::int8_t> sub_;     ///< per column: which one of its block
  std::vector<std::array<ColumnIndex, 8>> neighbours_;
  std::vector<ColumnIndex> column_of_point_;
};

/// Means over the 3 x 3 columns around each, nearer ones counting more; a neighbour that is missing counts
/// nothing.
std::vector<float> smoothed(const Relief& relief, const std::vector<float>& values);

/// How much the slope rises across each column [1 / column], in that of four directions in which it rises
/// most: positive in a crease or at the foot of a step, negative on a ridge; 0 where no direction has both
/// neighbours.
std::vector<float> concavity(const Relief& relief, const std::vector<float>& heights);

/// Basins of the values: each column belongs to the lowest place that it drains to.
/// \return the number of its basin per column, numbered by rising depth
std::vector<std::int32_t> basins(const Relief& relief, const std::vector<float>& values);

}  // namespace pcl_fft_ground::core
