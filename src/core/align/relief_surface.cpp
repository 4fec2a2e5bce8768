#include "align/relief_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "segments/voxel_set.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double PI = 3.14159265358979323846;

constexpr double LEAST_POINTS = 6;     // of a plane: three are determined by it
constexpr double LEAST_SPREAD = 0.05;  // determinant of the points' covariance in plan [cells^4]; .56 if even
constexpr double FARTHEST_MEAN = 0.7;  // of the points from the cell's centre: no extrapolation [cells]
constexpr double LEAST_BLEND = 0.4;    // share of the four planes around a place that have to be there
constexpr double PERFECT = 1e-4;       // least deviation of points, for perfect planes [cells]
constexpr double MOST_CELLS = 4e6;     // of a surface: a thin loop of points covers little of its box
constexpr double FEWEST = 12, MOST = 60;  // points of a plane
constexpr double SLOPE_ERROR = 0.12;      // of the slope's size that noise may make of it

enum Moment { N, X, Y, Z, XX, XY, YY, XZ, YZ, ZZ };

std::size_t squaresOf(const PointsView& points, double side) {
  VoxelSet squares;
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    squares.findOrInsert({voxelCoordinate(points(0, n), side), voxelCoordinate(points(1, n), side), 0});
  return squares.voxels().size();
}

}  // namespace

double planSpacing(const PointsView& points) {
  constexpr double ENOUGH = 6;  // points in a square: nearly none is empty by chance
  constexpr int ROUNDS = 8;
  const auto count = static_cast<double>(points.cols());
  if (points.cols() < 2) return 0;
  const Bounds bounds = boundsOf(points);
  const Eigen::Array2d extent = (bounds.high - bounds.low).head<2>();
  double side = std::max(std::sqrt(ENOUGH * extent.prod() / count), ENOUGH * extent.maxCoeff() / count);
  if (!(side > 0)) return 0;
  // The box is mostly larger than what the points cover: with smaller squares it is seen better.
  for (int round = 0; round < ROUNDS; ++round) {
    const double area = static_cast<double>(squaresOf(points, side)) * side * side;
    const double smaller = std::sqrt(ENOUGH * area / count);
    if (smaller > 0.95 * side) break;
    side = smaller;
  }
  return side / std::sqrt(ENOUGH);
}

ReliefSurface::ReliefSurface(const PointsView& points, double cell_size)
    : geometry_(gridAround(boundsOf(points), cell_size)) {
  level_ = points.row(2).cast<double>().mean();
  const Moments moments = momentsOf(points);
  planes_.resize(static_cast<std::size_t>(moments.cols()));
  const Eigen::Index rows = geometry_.rows;
  for (Eigen::Index j = 0; j < geometry_.cols; ++j)
    for (Eigen::Index i = 0; i < rows; ++i) {
      Eigen::Array<double, 10, 1> sums = Eigen::Array<double, 10, 1>::Zero();
      for (Eigen::Index dj = -1; dj <= 1; ++dj)
        for (Eigen::Index di = -1; di <= 1; ++di) {
          if (i + di < 0 || i + di >= rows || j + dj < 0 || j + dj >= geometry_.cols) continue;
          const auto m = moments.col(i + di + (j + dj) * rows);
          if (m[N] == 0) continue;
          // From the neighbour's centre to that of the cell.
          const auto x = static_cast<double>(di), y = static_cast<double>(dj);
          sums += m;
          sums[X] += x * m[N];
          sums[Y] += y * m[N];
          sums[XX] += 2 * x * m[X] + x * x * m[N];
          sums[XY] += x * m[Y] + y * m[X] + x * y * m[N];
          sums[YY] += 2 * y * m[Y] + y * y * m[N];
          sums[XZ] += x * m[Z];
          sums[YZ] += y * m[Z];
        }
      planes_[static_cast<std::size_t>(i + j * rows)] = fitPlane(sums);
    }
}

/// Of each cell's points, counted from its centre, all in cells.
ReliefSurface::Moments ReliefSurface::momentsOf(const PointsView& points) const {
  Moments moments = Moments::Zero(10, geometry_.rows * geometry_.cols);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const double u = (static_cast<double>(points(0, n)) - geometry_.origin.x()) / geometry_.cell_size;
    const double v = (static_cast<double>(points(1, n)) - geometry_.origin.y()) / geometry_.cell_size;
    const double i = std::floor(u), j = std::floor(v);
    const double x = u - i - 0.5, y = v - j - 0.5;
    const double z = (static_cast<double>(points(2, n)) - level_) / geometry_.cell_size;
    Eigen::Array<double, 10, 1> point;
    point << 1, x, y, z, x * x, x * y, y * y, x * z, y * z, z * z;
    moments.col(static_cast<Eigen::Index>(i) + static_cast<Eigen::Index>(j) * geometry_.rows) += point;
  }
  return moments;
}

ReliefSurface::Plane ReliefSurface::fitPlane(const Eigen::Array<double, 10, 1>& sums) {
  Plane plane;
  const double n = sums[N];
  if (n < LEAST_POINTS) return plane;
  const double x = sums[X] / n, y = sums[Y] / n, z = sums[Z] / n;
  if (std::max(std::abs(x), std::abs(y)) > FARTHEST_MEAN) return plane;
  const double xx = sums[XX] / n - x * x, xy = sums[XY] / n - x * y, yy = sums[YY] / n - y * y;
  const double xz = sums[XZ] / n - x * z, yz = sums[YZ] / n - y * z, zz = sums[ZZ] / n - z * z;
  const double determinant = xx * yy - xy * xy;
  if (determinant < LEAST_SPREAD) return plane;
  const double along = (yy * xz - xy * yz) / determinant;
  const double across = (xx * yz - xy * xz) / determinant;
  const double variance = (zz - along * xz - across * yz) * n / (n - 3);
  plane.height = static_cast<float>(z - along * x - across * y);
  plane.along = static_cast<float>(along);
  plane.across = static_cast<float>(across);
  plane.variance = static_cast<float>(std::max(variance, PERFECT * PERFECT));
  plane.count = static_cast<float>(n);
  return plane;
}

std::optional<ReliefSurface::Footing> ReliefSurface::at(double x, double y) const {
  const double u = (x - geometry_.origin.x()) / geometry_.cell_size - 0.5;
  const double v = (y - geometry_.origin.y()) / geometry_.cell_size - 0.5;
  if (!(u > -1 && v > -1 && u < static_cast<double>(geometry_.rows) &&
        v < static_cast<double>(geometry_.cols)))
    return std::nullopt;
  const auto i = static_cast<Eigen::Index>(std::floor(u)), j = static_cast<Eigen::Index>(std::floor(v));
  const double a = u - static_cast<double>(i), b = v - static_cast<double>(j);
  double share = 0, height = 0, along = 0, across = 0, variance = 0, uncertainty = 0;
  for (Eigen::Index k = 0; k < 4; ++k) {
    const Eigen::Index di = k & 1, dj = k >> 1;
    if (i + di < 0 || j + dj < 0 || i + di >= geometry_.rows || j + dj >= geometry_.cols) continue;
    const Plane& plane = planes_[static_cast<std::size_t>(i + di + (j + dj) * geometry_.rows)];
    if (plane.count == 0) continue;
    const double weight = (di == 1 ? a : 1 - a) * (dj == 1 ? b : 1 - b);
    const auto slope_x = static_cast<double>(plane.along), slope_y = static_cast<double>(plane.across);
    share += weight;
    height += weight * (static_cast<double>(plane.height) + (a - static_cast<double>(di)) * slope_x +
                        (b - static_cast<double>(dj)) * slope_y);
    along += weight * slope_x;
    across += weight * slope_y;
    variance += weight * static_cast<double>(plane.variance);
    uncertainty += weight * 3 * static_cast<double>(plane.variance) / static_cast<double>(plane.count);
  }
  if (share < LEAST_BLEND) return std::nullopt;
  const double cell = geometry_.cell_size;
  return Footing{level_ + cell * height / share,
                 {along / share, across / share},
                 cell * cell * variance / share,
                 cell * cell * uncertainty / share};
}

double ReliefSurface::area() const {
  const auto count =
      std::count_if(planes_.begin(), planes_.end(), [](const Plane& p) { return p.count > 0; });
  return static_cast<double>(count) * geometry_.cell_size * geometry_.cell_size;
}

double ReliefSurface::typicalVariance() const {
  std::vector<float> variances;
  for (const Plane& plane : planes_)
    if (plane.count > 0) variances.push_back(plane.variance);
  if (variances.empty()) return 0;
  const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
  std::nth_element(variances.begin(), middle, variances.end());
  return static_cast<double>(*middle) * geometry_.cell_size * geometry_.cell_size;
}

double ReliefSurface::squaredSlope() const {
  constexpr double SPREAD = 0.75;  // mean square of a coordinate over three cells [cells^2]
  double sum = 0, count = 0;
  for (const Plane& plane : planes_) {
    if (plane.count == 0) continue;
    const auto along = static_cast<double>(plane.along), across = static_cast<double>(plane.across);
    const double of_noise =
        2 * static_cast<double>(plane.variance) / (SPREAD * static_cast<double>(plane.count));
    sum += along * along + across * across - of_noise;
    ++count;
  }
  return count > 0 ? std::max(0.0, sum / count) : 0;
}

ReliefSurface reliefSurface(const PointsView& points, double spacing) {
  const Bounds bounds = boundsOf(points);
  const double least = std::sqrt((bounds.high - bounds.low).head<2>().prod() / MOST_CELLS);
  const auto cellFor = [&](double count) { return std::max(least, spacing * std::sqrt(count / 9)); };
  ReliefSurface fine(points, cellFor(FEWEST));
  const double noise = std::sqrt(fine.typicalVariance()), slope = std::sqrt(fine.squaredSlope());
  const double wanted = 2 * noise * std::sqrt(PI) / (SLOPE_ERROR * spacing * slope);
  if (wanted <= FEWEST) return fine;
  return {points, cellFor(std::min(wanted, MOST))};
}

}  // namespace pcl_fft_ground::core
