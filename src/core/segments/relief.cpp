#include "segments/relief.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

#include "segments/voxel_set.h"

namespace pcl_fft_ground::core {
namespace {

/// Columns are half as wide as voxels if that leaves them this many points on average: with fewer, holes by
/// chance would tear things.
constexpr double ENOUGH_POINTS = 2.5;

constexpr double FIXED_POINT = 1 << 20;  // heights are summed as whole numbers of this part of a voxel

/// Count and sum of the heights of the points of a part of a voxel, exact and so in any order.
struct HeightSum {
  std::int64_t sum = 0;  // above the voxel's floor
  std::int32_t count = 0;
};

/// Which quarter of its voxel holds a point: 0 to 3.
int quarterOf(const Eigen::Vector3f& point, const Voxel& voxel, double leaf_size) {
  const auto upper = [&](float coordinate, std::int64_t floor) {
    return coordinate / leaf_size - static_cast<double>(floor) >= 0.5 ? 1 : 0;
  };
  return upper(point.x(), voxel.i) + 2 * upper(point.y(), voxel.j);
}

/// Numbers of the voxels, row by row.
std::vector<VoxelIndex> voxelsByPlace(const std::vector<Voxel>& voxels) {
  using Placed = std::tuple<std::int64_t, std::int64_t, std::int64_t, VoxelIndex>;
  std::vector<Placed> placed;
  placed.reserve(voxels.size());
  for (const Voxel& v : voxels) placed.emplace_back(v.j, v.i, v.k, static_cast<VoxelIndex>(placed.size()));
  std::sort(placed.begin(), placed.end());
  std::vector<VoxelIndex> order;
  order.reserve(placed.size());
  for (const Placed& voxel : placed) order.push_back(std::get<3>(voxel));
  return order;
}

/// A whole number that is ordered as the value is, and by the column where values are equal.
std::uint64_t sortKey(float value, std::size_t column) {
  constexpr std::uint32_t SIGN = 0x80000000U;
  const float plain = value + 0.0F;  // no -0
  std::uint32_t bits;
  std::memcpy(&bits, &plain, sizeof bits);
  bits = (bits & SIGN) != 0 ? ~bits : bits | SIGN;
  return static_cast<std::uint64_t>(bits) << 32 | column;
}

}  // namespace

/// What the points say of the voxels' quarters, and where these go.
struct Relief::Blocks {
  VoxelContact contact;
  std::vector<std::int8_t> quarter_of_point;
  std::vector<HeightSum> sums;             // per voxel and quarter
  std::vector<VoxelIndex> block_of_voxel;  // voxels above one another in a cluster make a block
};

Relief::Relief(const PointsView& points, double leaf_size) {
  Blocks blocks;
  blocks.contact = contactOf(points, leaf_size);
  const std::vector<Voxel>& voxels = blocks.contact.occupied.voxels();
  blocks.quarter_of_point.resize(static_cast<std::size_t>(points.cols()));
  blocks.sums.resize(4 * voxels.size());
  for (std::size_t n = 0; n < blocks.quarter_of_point.size(); ++n) {
    const Eigen::Vector3f point = points.col(static_cast<Eigen::Index>(n));
    const auto v = static_cast<std::size_t>(blocks.contact.voxel_of_point[n]);
    const int quarter = quarterOf(point, voxels[v], leaf_size);
    blocks.quarter_of_point[n] = static_cast<std::int8_t>(quarter);
    HeightSum& sum = blocks.sums[4 * v + static_cast<std::size_t>(quarter)];
    // In [0, 1] but for rounding, unless a leaf is too small for the numbers of the voxels.
    const double share = std::clamp(point.z() / leaf_size - static_cast<double>(voxels[v].k), -1.0, 2.0);
    sum.sum += std::llround(share * FIXED_POINT);
    ++sum.count;
  }

  std::vector<std::int32_t> cluster_of_root(voxels.size(), -1);
  blocks.block_of_voxel.resize(voxels.size());
  for (const VoxelIndex v : voxelsByPlace(voxels)) {
    const Voxel& voxel = voxels[static_cast<std::size_t>(v)];
    std::int32_t& cluster =
        cluster_of_root[static_cast<std::size_t>(blocks.contact.root_of_voxel[static_cast<std::size_t>(v)])];
    if (cluster < 0) {
      cluster = static_cast<std::int32_t>(first_.size());
      first_.push_back(voxel);
    }
    blocks.block_of_voxel[static_cast<std::size_t>(v)] = blocks_.findOrInsert({voxel.i, voxel.j, cluster});
  }
  const std::size_t quarters = static_cast<std::size_t>(std::count_if(
      blocks.sums.begin(), blocks.sums.end(), [](const HeightSum& sum) { return sum.count > 0; }));
  const bool dense = static_cast<double>(points.cols()) >= ENOUGH_POINTS * static_cast<double>(quarters);
  divisions_ = dense ? 2 : 1;
  side_ = leaf_size / divisions_;
  addColumns(blocks);
  connect();
}

void Relief::addColumns(const Blocks& blocks) {
  const std::vector<Voxel>& voxels = blocks.contact.occupied.voxels();
  const std::size_t block_count = blocks_.voxels().size();
  struct Total {
    double floors = 0;  // sum of the voxels' floors [voxels]; whole numbers
    HeightSum within;
  };
  std::vector<std::array<Total, 4>> totals(block_count);
  for (std::size_t v = 0; v < voxels.size(); ++v) {
    const auto block = static_cast<std::size_t>(blocks.block_of_voxel[v]);
    const Voxel& first = first_[static_cast<std::size_t>(blocks_.voxels()[block].k)];
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
      const HeightSum& sum = blocks.sums[4 * v + quarter];
      Total& total = totals[block][divisions_ == 2 ? quarter : 0];
      total.floors += static_cast<double>(voxels[v].k - first.k) * sum.count;
      total.within.sum += sum.sum;
      total.within.count += sum.count;
    }
  }
  columns_of_block_.resize(block_count);
  for (std::size_t b = 0; b < block_count; ++b) {
    const Voxel& block = blocks_.voxels()[b];
    const Voxel& first = first_[static_cast<std::size_t>(block.k)];
    for (int sub = 0; sub < 4; ++sub) {
      const Total& total = totals[b][static_cast<std::size_t>(sub)];
      ColumnIndex& column = columns_of_block_[b][static_cast<std::size_t>(sub)];
      column = NO_COLUMN;
      if (total.within.count == 0) continue;
      column = static_cast<ColumnIndex>(height_.size());
      const double sum = total.floors + static_cast<double>(total.within.sum) / FIXED_POINT;
      height_.push_back(static_cast<float>(divisions_ * sum / total.within.count));
      x_.push_back(static_cast<float>(divisions_ * (block.i - first.i) + sub % 2));
      const int row = sub / 2;
      y_.push_back(static_cast<float>(divisions_ * (block.j - first.j) + row));
      cluster_.push_back(static_cast<std::int32_t>(block.k));
      block_.push_back(static_cast<std::int32_t>(b));
      sub_.push_back(static_cast<std::int8_t>(sub));
    }
  }
  column_of_point_.resize(blocks.quarter_of_point.size());
  for (std::size_t n = 0; n < column_of_point_.size(); ++n) {
    const auto block = static_cast<std::size_t>(
        blocks.block_of_voxel[static_cast<std::size_t>(blocks.contact.voxel_of_point[n])]);
    column_of_point_[n] =
        columns_of_block_[block][divisions_ == 2 ? static_cast<std::size_t>(blocks.quarter_of_point[n]) : 0];
  }
}

void Relief::connect() {
  std::vector<std::array<VoxelIndex, 9>> around(blocks_.voxels().size());
  for (auto& blocks : around) blocks.fill(NO_VOXEL);
  for (std::size_t b = 0; b < around.size(); ++b) {
    const Voxel& block = blocks_.voxels()[b];
    around[b][4] = static_cast<VoxelIndex>(b);
    for (int n = 5; n < 9; ++n) {  // the other four are seen from the other side
      const VoxelIndex other = blocks_.find({block.i + n % 3 - 1, block.j + n / 3 - 1, block.k});
      if (other == NO_VOXEL) continue;
      around[b][static_cast<std::size_t>(n)] = other;
      around[static_cast<std::size_t>(other)][static_cast<std::size_t>(8 - n)] = static_cast<VoxelIndex>(b);
    }
  }
  const auto floorDivided = [&](int value) { return value < 0 ? -1 : value / divisions_; };
  neighbours_.resize(size());
  for (std::size_t c = 0; c < size(); ++c)
    for (std::size_t d = 0; d < 8; ++d) {
      const int x = sub_[c] % 2 + STEP_X[d];
      const int y = sub_[c] / 2 + STEP_Y[d];
      const int block_x = floorDivided(x), block_y = floorDivided(y);
      const int aside = block_x + 1 + 3 * (block_y + 1);
      const VoxelIndex block = around[static_cast<std::size_t>(block_[c])][static_cast<std::size_t>(aside)];
      const int sub = x - block_x * divisions_ + 2 * (y - block_y * divisions_);
      neighbours_[c][d] =
          block == NO_VOXEL
              ? NO_COLUMN
              : columns_of_block_[static_cast<std::size_t>(block)][static_cast<std::size_t>(sub)];
    }
}

ColumnIndex Relief::at(std::int32_t cluster, double x, double y) const {
  const Voxel& first = first_[static_cast<std::size_t>(cluster)];
  const auto column_x = static_cast<std::int64_t>(std::floor(x + 0.5));
  const auto column_y = static_cast<std::int64_t>(std::floor(y + 0.5));
  const auto block_x = static_cast<std::int64_t>(std::floor(static_cast<double>(column_x) / divisions_));
  const auto block_y = static_cast<std::int64_t>(std::floor(static_cast<double>(column_y) / divisions_));
  const VoxelIndex block = blocks_.find({first.i + block_x, first.j + block_y, cluster});
  if (block == NO_VOXEL) return NO_COLUMN;
  const std::int64_t sub = column_x - block_x * divisions_ + 2 * (column_y - block_y * divisions_);
  return columns_of_block_[static_cast<std::size_t>(block)][static_cast<std::size_t>(sub)];
}

std::vector<float> smoothed(const Relief& relief, const std::vector<float>& values) {
  constexpr float OWN = 4, STRAIGHT = 2, DIAGONAL = 1;
  std::vector<float> result(values.size());
  for (std::size_t c = 0; c < values.size(); ++c) {
    float sum = OWN * values[c], weight = OWN;
    for (std::size_t d = 0; d < 8; ++d) {
      const ColumnIndex neighbour = relief.neighbours(c)[d];
      if (neighbour == NO_COLUMN) continue;
      const float share = d % 2 == 0 ? STRAIGHT : DIAGONAL;
      sum += share * values[static_cast<std::size_t>(neighbour)];
      weight += share;
    }
    result[c] = sum / weight;
  }
  return result;
}

std::vector<float> concavity(const Relief& relief, const std::vector<float>& heights) {
  constexpr float DIAGONAL = 0.70710678F;
  std::vector<float> result(heights.size(), 0);
  for (std::size_t c = 0; c < heights.size(); ++c) {
    const std::array<ColumnIndex, 8>& neighbours = relief.neighbours(c);
    bool is_first = true;
    for (std::size_t d = 0; d < 4; ++d) {
      if (neighbours[d] == NO_COLUMN || neighbours[d + 4] == NO_COLUMN) continue;
      const float bend = (heights[static_cast<std::size_t>(neighbours[d])] +
                          heights[static_cast<std::size_t>(neighbours[d + 4])] - 2 * heights[c]) *
                         (d % 2 == 0 ? 1 : DIAGONAL);
      result[c] = is_first ? bend : std::max(result[c], bend);
      is_first = false;
    }
  }
  return result;
}

std::vector<std::int32_t> basins(const Relief& relief, const std::vector<float>& values) {
  std::vector<std::uint64_t> order(values.size());
  for (std::size_t c = 0; c < values.size(); ++c) order[c] = sortKey(values[c], c);
  std::sort(order.begin(), order.end());
  std::vector<std::int32_t> basin(values.size(), -1);
  std::int32_t count = 0;
  for (const std::uint64_t key : order) {
    const auto c = static_cast<std::size_t>(key & 0xFFFFFFFFU);
    ColumnIndex lowest = NO_COLUMN;
    for (const ColumnIndex n : relief.neighbours(c)) {
      if (n == NO_COLUMN || basin[static_cast<std::size_t>(n)] < 0) continue;
      if (lowest == NO_COLUMN ||
          values[static_cast<std::size_t>(n)] < values[static_cast<std::size_t>(lowest)])
        lowest = n;
    }
    basin[c] = lowest == NO_COLUMN ? count++ : basin[static_cast<std::size_t>(lowest)];
  }
  return basin;
}

}  // namespace pcl_fft_ground::core
