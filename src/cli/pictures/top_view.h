#pragma once

#include <pcl/point_cloud.h>

#include <Eigen/Core>
#include <vector>

#include "methods/segmenter.h"
#include "pictures/pictures.h"

namespace pcl_fft_ground::cli {

/// A scan seen from above.
struct TopView {
  GridImage top;                    ///< highest point of each cell [m], NaN where there is none
  std::vector<Eigen::Index> cells;  ///< per point: number of its cell in `top.values`; -1 for none
};

/** Looks down on a cloud, its x and y kept as they are where up is +z.
 *
 * Points that are not finite, and those far from all others, are in no cell.
 * \param up direction of positive elevation in the cloud's frame, any length above 0
 * \param most_cells along the longer side; sparse clouds get fewer, so that most cells hold a point
 * \return no cells for a cloud without finite points
 */
TopView viewFromAbove(const pcl::PointCloud<Point>& cloud, const Eigen::Vector3d& up,
                      Eigen::Index most_cells);

/// The most frequent class of the points in each cell, the larger of equals; -1 in cells without points.
/// \param classes per point, from 0 to count - 1
Eigen::ArrayXXi classesFromAbove(const TopView& view, const std::vector<int>& classes, int count);

}  // namespace pcl_fft_ground::cli
