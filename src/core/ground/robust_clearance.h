#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "pcl_fft_ground/core/ground/robust_ground.h"
#include "scan/point_block.h"

namespace pcl_fft_ground::core {

/** How far points are clear of the ground, at a right angle to its surface.
 *
 * On a slope a height is lessened by what places that are not told apart may differ in height. Above, the
 * ground may bend up to the lowest point of a cell, but no further than the greatest tolerance allows, and
 * climb its own steps.
 */
class Clearance {
 public:
  /// \param ground outlives this; its surface has cells
  /// \param points those that read() will be asked for: over land without any nothing is made ready
  Clearance(const RobustGround& ground, const PointsView& points);

  /// Of some consecutive points [m].
  struct Block {
    std::array<float, PointBlock::SIZE> above, below;
    std::size_t count = 0;
  };

  /// Takes up to PointBlock::SIZE points.
  void read(const PointsView& points, std::size_t begin, Block& block) const;

 private:
  /// Between four cell centres: the bilinear surface, a + b u + c v + d u v, and how its slope s shortens
  /// what is measured at a right angle.
  struct Patch {
    float a, b, c, d;
    float shortening;  // 1 / sqrt(1 + s^2)
    float lean;        // height by which places differ that are not told apart [m]

    float heightAt(float u, float v) const { return a + b * u + (c + d * u) * v; }
  };

  /// The patch and the cell in which a place lies.
  struct Place {
    std::int32_t patch, cell;
    float u, v;  // shares of the way from the patch's lower corner to the next centres
  };

  /// One patch more along each axis than there are pairs of cells: beyond the outermost centres the border
  /// continues.
  struct Patches {
    explicit Patches(const GroundSurface& surface);
    Place placeOf(float x, float y) const {
      const float from_x = std::min(std::max((x - x_first) * per_metre, 0.0F), x_end);
      const float from_y = std::min(std::max((y - y_first) * per_metre, 0.0F), y_end);
      const auto i = static_cast<std::int32_t>(from_x), j = static_cast<std::int32_t>(from_y);
      const float u = from_x - static_cast<float>(i), v = from_y - static_cast<float>(j);
      // The nearest of the four centres is that of the point's own cell.
      const std::int32_t row = i - (u < 0.5F ? 1 : 0), col = j - (v < 0.5F ? 1 : 0);
      return {i + j * rows, std::clamp(row, 0, rows - 2) + std::clamp(col, 0, cols - 2) * (rows - 1), u, v};
    }
    std::size_t number(Eigen::Index i, Eigen::Index j) const {
      return static_cast<std::size_t>(i + j * rows);
    }

    std::int32_t rows, cols;
    float per_metre, x_first, y_first;  // lower corner of patch (0, 0)
    float x_end, y_end;                 // of the patches, just not reached
  };

  void makeReady(const RobustGround& ground);
  void makeReady(const RobustGround& ground, const PointsView& points);

  Patch patchAt(const RobustGround& ground, Eigen::Index i, Eigen::Index j) const;
  float allowanceOf(const RobustGround& ground, Eigen::Index cell) const;

  Patches grid_;
  double per_metre_;
  std::vector<Patch> patches_;
  std::vector<float> allowances_;  // of each cell: how far the ground may reach above its surface [m]
};

}  // namespace pcl_fft_ground::core
