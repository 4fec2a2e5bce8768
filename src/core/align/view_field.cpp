#include "align/view_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pcl_fft_ground/core/scan/point_statistics.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double HALF_PI = 1.57079632679489661923;
constexpr double IN_CELL = 4;              // points in a cell of a range image that holds any
constexpr Eigen::Index FEWEST_CELLS = 16;  // along a side of the cube: 6 degrees
constexpr Eigen::Index MOST_CELLS = 400;   // 0.2 degrees
constexpr double FINER = 1.25;             // from one number of cells that is tried to the next
constexpr int WHOLE = 9;                   // weight of a cell's own points: it has been looked at
constexpr int LOOKED_AT = 5;               // neighbours with points that say the same of an empty cell
constexpr double DEEP = 4;  // range of distances in a cell that leaves things unclear [margins]
constexpr float NOTHING = std::numeric_limits<float>::infinity();

}  // namespace

ViewField::ViewField(const PointsView& points, const std::optional<Eigen::Vector3d>& sensor, double cell_size)
    : sensor_(sensor) {
  if (sensor_)
    divisions_ = divisionsFor(points);
  else
    plan_ = gridAround(boundsOf(points), cell_size);
  const Eigen::Index rows = sensor_ ? divisions_ : plan_.rows, cols = sensor_ ? 6 * divisions_ : plan_.cols;
  nearest_ = Eigen::ArrayXXf::Constant(rows, cols, NOTHING);
  farthest_ = Eigen::ArrayXXf::Constant(rows, cols, -NOTHING);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const std::optional<Ray> ray = rayTo(points.col(n).cast<double>());
    if (!ray) continue;
    nearest_(ray->row, ray->col) = std::min(nearest_(ray->row, ray->col), ray->range);
    farthest_(ray->row, ray->col) = std::max(farthest_(ray->row, ray->col), ray->range);
  }
  spread();
}

std::optional<ViewField::Ray> ViewField::rayTo(const Eigen::Vector3d& place) const {
  if (!sensor_) {
    const Eigen::Array2d cell = (place.head<2>() - plan_.origin).array() / plan_.cell_size;
    const bool inside = (cell >= 0).all() && cell.x() < static_cast<double>(plan_.rows) &&
                        cell.y() < static_cast<double>(plan_.cols);
    if (!inside) return std::nullopt;
    return Ray{static_cast<Eigen::Index>(cell.x()), static_cast<Eigen::Index>(cell.y()),
               static_cast<float>(-place.z())};
  }
  const Eigen::Vector3d ray = place - *sensor_;
  Eigen::Index axis = 0;
  const double along = ray.cwiseAbs().maxCoeff(&axis);
  if (!(along > 0)) return std::nullopt;
  const auto cell = [&](Eigen::Index other) {
    const double angle = 0.5 + std::atan(ray[(axis + other) % 3] / along) / HALF_PI;
    return std::clamp<Eigen::Index>(static_cast<Eigen::Index>(angle * static_cast<double>(divisions_)), 0,
                                    divisions_ - 1);
  };
  const Eigen::Index side = 2 * axis + (ray[axis] < 0 ? 1 : 0);
  return Ray{cell(1), side * divisions_ + cell(2), static_cast<float>(ray.norm())};
}

bool ViewField::areThinlySpread(const PointsView& points, Eigen::Index divisions) {
  divisions_ = divisions;
  Mask occupied = Mask::Constant(divisions, 6 * divisions, false);
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    if (const std::optional<Ray> ray = rayTo(points.col(n).cast<double>()))
      occupied(ray->row, ray->col) = true;
  return static_cast<double>(points.cols()) < IN_CELL * static_cast<double>(occupied.count());
}

/// The fewest cells, of those on a ladder, that hold few enough points; more cells never hold more.
Eigen::Index ViewField::divisionsFor(const PointsView& points) {
  std::vector<Eigen::Index> ladder;
  for (Eigen::Index cells = FEWEST_CELLS; cells < MOST_CELLS;
       cells = static_cast<Eigen::Index>(FINER * static_cast<double>(cells)))
    ladder.push_back(cells);
  ladder.push_back(MOST_CELLS);
  const auto found = std::partition_point(
      ladder.begin(), ladder.end() - 1, [&](Eigen::Index cells) { return !areThinlySpread(points, cells); });
  return *found;
}

/// Lets every cell know what its neighbours hold: on the same side of the cube, where there is one.
void ViewField::spread() {
  const Eigen::ArrayXXf nearest = nearest_, farthest = farthest_;
  const Eigen::Index rows = nearest.rows(), side = sensor_ ? divisions_ : nearest.cols();
  seen_ = Eigen::ArrayXXi::Zero(rows, nearest.cols());
  for (Eigen::Index col = 0; col < nearest.cols(); ++col)
    for (Eigen::Index row = 0; row < rows; ++row) {
      if (nearest(row, col) == NOTHING) continue;
      const Eigen::Index first = col / side * side, last = std::min(first + side, nearest.cols()) - 1;
      for (Eigen::Index j = std::max(first, col - 1); j <= std::min(last, col + 1); ++j)
        for (Eigen::Index i = std::max<Eigen::Index>(0, row - 1); i <= std::min(rows - 1, row + 1); ++i) {
          nearest_(i, j) = std::min(nearest_(i, j), nearest(row, col));
          farthest_(i, j) = std::max(farthest_(i, j), farthest(row, col));
          seen_(i, j) += i == row && j == col ? WHOLE : 1;
        }
    }
}

Sight ViewField::at(const Eigen::Vector3d& place, double margin) const {
  const std::optional<Ray> ray = rayTo(place);
  if (!ray || seen_(ray->row, ray->col) < LOOKED_AT) return Sight::UNSEEN;
  const auto range = static_cast<double>(ray->range);
  const auto nearest = static_cast<double>(nearest_(ray->row, ray->col));
  const auto farthest = static_cast<double>(farthest_(ray->row, ray->col));
  if (range < nearest - margin) return Sight::EMPTY;
  if (range > farthest + margin) return Sight::UNSEEN;
  return farthest - nearest > DEEP * margin ? Sight::UNCLEAR : Sight::SURFACE;
}

double ViewField::spacingAt(const Eigen::Vector3d& place) const {
  return sensor_ ? (place - *sensor_).norm() * HALF_PI / static_cast<double>(divisions_) : 0;
}

}  // namespace pcl_fft_ground::core
