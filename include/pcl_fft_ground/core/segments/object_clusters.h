#pragma once

#include <vector>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// The smallest object as a share of the largest: an eighth, about the decade of sizes that things strewn on
/// a sea floor span; the marks that a body bears, a socket, a handle, a rib, are smaller than that.
constexpr double MINIMUM_OBJECT_SHARE = 0.125;

/// The smallest object where the largest is not known [leaf sizes]: what has fewer cells has no shape.
constexpr double MINIMUM_OBJECT_LEAVES = 4.5;

/// Settings of objectClusters().
struct ObjectClusterParameters {
  double leaf_size = 0.02;            ///< side of a voxel [m], > 0: what touches within it hangs together
  double minimum_object_size = 0.09;  ///< size of the smallest object [m], > 0: smaller parts are its marks
};

/** Tells objects that touch apart: contact clusters, cut where convex parts meet in creases.
 *
 * Seen from above, the points are a relief. It falls into basins of its concavity, the watersheds of which
 * are the creases; parts are joined again, the likeliest first, as long as the border between them is open,
 * or both continue each other along one axis (a neck, a socket), and pieces of one straight body that another
 * one lies across are joined, too. The parts of a contact cluster smaller than the smallest object are never
 * cut off.
 *
 * \param points finite points, +z up
 * \return clusters of column numbers, ascending within a cluster; larger clusters first, equal ones by their
 * place (y, then x). The same clusters for every order of the points, bit for bit.
 * \throws std::invalid_argument if a parameter is out of range
 * \note O(n log n) time; memory grows with the number of occupied voxels, not with the volume
 */
PCL_FFT_GROUND_CORE_EXPORT std::vector<std::vector<Eigen::Index>> objectClusters(
    const PointsView& points, const ObjectClusterParameters& parameters);

}  // namespace pcl_fft_ground::core
