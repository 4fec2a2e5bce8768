#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// The nearest of a set of points.
struct Neighbour {
  Eigen::Index index = -1;     ///< column of the point; -1: none within reach
  float squared_distance = 0;  ///< [m^2]
};

/// Finds the nearest of a set of points: the one interface by which alignment searches.
class NearestNeighbours {
 public:
  virtual ~NearestNeighbours() = default;

  /// The nearest point within `reach` [m]; of equally near ones any, but always the same.
  virtual Neighbour nearest(const Eigen::Vector3f& query, float reach) const = 0;

  /// All points within `radius` [m], in no particular but always the same order.
  /// Their columns are in `found`, whose old content is discarded and whose memory is used again.
  virtual void within(const Eigen::Vector3f& query, float radius, std::vector<Eigen::Index>& found) const = 0;
};

/** Makes a search over points, which it may keep a reference to: they outlive it.
 * The second argument is the spacing of the points [m], for searches that are built around it.
 */
using NearestNeighboursFactory =
    std::function<std::unique_ptr<NearestNeighbours>(const PointsView& points, double spacing)>;

/** Search by a grid of vertical columns: exact, and built in a single pass.
 *
 * Made for surfaces seen from above, where a column holds few points. Between columns the result is exact at
 * any distance, the time grows with the square of the reach.
 */
PCL_FFT_GROUND_CORE_EXPORT std::unique_ptr<NearestNeighbours> columnNeighbours(const PointsView& points,
                                                                               double spacing);

}  // namespace pcl_fft_ground::core
