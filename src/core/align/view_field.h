#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pcl_fft_ground/core/grid/elevation_grid.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// What a scan says of a place.
enum class Sight {
  UNSEEN,   ///< it did not look there, or hid it behind something nearer
  EMPTY,    ///< it looked through the place and saw something farther away
  SURFACE,  ///< the surface that it saw passes here
  UNCLEAR   ///< it saw things at many distances in this direction
};

/** What a scan could have seen, by ray.
 *
 * Of a scan taken from one place a range image in equal angles around the sensor; of any other a depth image
 * from above. A cell holds the nearest and the farthest that was seen there and in the cells around it.
 */
class ViewField {
 public:
  /** \param points at least one
   * \param sensor where the scan was taken from; none: it is looked at from above
   * \param cell_size side of a cell seen from above [m], > 0; angles are chosen by the density of the points
   */
  ViewField(const PointsView& points, const std::optional<Eigen::Vector3d>& sensor, double cell_size);

  /// \param margin how far off a surface a place still belongs to it [m]
  Sight at(const Eigen::Vector3d& place, double margin) const;

  /// Whether it is a view from above.
  bool isFromAbove() const { return !sensor_; }

  /// Distance between neighbouring rays at a place [m]; 0 for a view from above, where voxels say it.
  double spacingAt(const Eigen::Vector3d& place) const;

 private:
  /// Number of the cell that a place lies in and its distance from the viewer; none outside of the image.
  struct Ray {
    Eigen::Index row, col;
    float range;
  };
  std::optional<Ray> rayTo(const Eigen::Vector3d& place) const;
  Eigen::Index divisionsFor(const PointsView& points);
  /// Whether so many cells a side hold few points each; sets divisions_.
  bool areThinlySpread(const PointsView& points, Eigen::Index divisions);
  void spread();

  std::optional<Eigen::Vector3d> sensor_;
  GridGeometry plan_;  // without a sensor
  Eigen::Index divisions_ =
      0;  // cells along a side of the cube around the sensor; its sides lie side by side
  Eigen::ArrayXXf nearest_, farthest_;
  Eigen::ArrayXXi seen_;  // cells with points among the 3 x 3; with those of its own at least WHOLE
};

}  // namespace pcl_fft_ground::core
