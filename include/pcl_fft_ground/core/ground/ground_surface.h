#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/grid/elevation_grid.h"
#include "pcl_fft_ground/core/ground/labels.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// Height of the ground over the cells of a grid in a level frame (Sec. IV-B3).
struct GroundSurface {
  Eigen::Isometry3d frame_from_input =
      Eigen::Isometry3d::Identity();  ///< brings input points into the level frame
  GridGeometry geometry;              ///< the cells, in the level frame
  Eigen::ArrayXXd height;             ///< height at the cell centres [m]
  Mask supported = {};  ///< true where ground was observed nearby; no cells if the method does not tell
  Eigen::ArrayXXd uncertainty = {};  ///< standard deviation to be expected of the height [m]; likewise

  /** Height of the ground [m] at a place of the level frame: bilinear between cell centres.
   * Beyond the outermost cell centres the height of the border continues. The surface must have at least one
   * cell.
   */
  PCL_FFT_GROUND_CORE_EXPORT double heightAt(double x, double y) const;

  /// Height above the ground [m], along up, of a point of the input frame; negative below it.
  PCL_FFT_GROUND_CORE_EXPORT double heightAbove(const Eigen::Vector3d& input_point) const;
};

/** Separates ground from objects (Sec. IV-C): a point more than `tolerance` above the surface is an object.
 * \param points points in the level frame of the surface
 * \param tolerance [m]; 0 as published
 */
PCL_FFT_GROUND_CORE_EXPORT Labels labelByHeight(const PointsView& points, const GroundSurface& surface,
                                                double tolerance);

/// A plane that is not vertical: z = slope . (x, y) + offset [m].
struct Plane {
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  double offset = 0;
};

/** A plane as a ground surface of 2 x 2 cells whose centres span the bounds.
 * \param bounds of the points in the level frame; the surface is flat beyond them
 */
PCL_FFT_GROUND_CORE_EXPORT GroundSurface planeSurface(const Eigen::Isometry3d& frame_from_input,
                                                      const Bounds& bounds, const Plane& plane);

}  // namespace pcl_fft_ground::core
