#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pcl_fft_ground/core/grid/elevation_grid.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// Mean distance between points, seen from above: the root of the area that one of them has [m]; 0 for fewer
/// than two places.
double planSpacing(const PointsView& points);

/** A scan as heights over the plan: a plane fitted to the points around each cell, the planes blended. */
class ReliefSurface {
 public:
  /// The surface at a place.
  struct Footing {
    double height;          ///< [m]
    Eigen::Vector2d slope;  ///< along x and y
    double variance;        ///< of single points about it: noise and roughness [m^2]
    double uncertainty;     ///< variance of the height itself [m^2]
  };

  /// \param points at least one \param cell_size side of a cell [m]; a plane takes the points of 3 x 3
  ReliefSurface(const PointsView& points, double cell_size);

  /// Nothing where the scan has too few points.
  std::optional<Footing> at(double x, double y) const;

  /// Area that is covered [m^2].
  double area() const;

  /// Median of the points' variance about the planes [m^2].
  double typicalVariance() const;

  /// Mean squared slope, less what noise adds to it.
  double squaredSlope() const;

 private:
  struct Plane {
    float height = 0, along = 0, across = 0;  // at the centre of the cell, slopes per cell
    float variance = 0;
    float count = 0;  // of points; 0: no plane
  };
  using Moments = Eigen::Array<double, 10, Eigen::Dynamic>;

  Moments momentsOf(const PointsView& points) const;
  static Plane fitPlane(const Eigen::Array<double, 10, 1>& sums);

  GridGeometry geometry_;
  double level_ = 0;  // height that the planes are counted from [m]
  std::vector<Plane> planes_;
};

/** The surface of a scan with planes no smaller than its noise demands: where the slopes of small planes are
 * mostly noise, larger ones are taken.
 * \param spacing of the points [m]
 */
ReliefSurface reliefSurface(const PointsView& points, double spacing);

}  // namespace pcl_fft_ground::core
