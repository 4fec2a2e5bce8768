#pragma once

#include <string>
#include <vector>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/ground/labels.h"
#include "pcl_fft_ground/core/ground/robust_ground.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/** What tells that the ground found cannot be right, or that the scan does not suit the parameters: a
 * sentence each, with the value, what it means and the option that helps.
 *
 * - the size of the largest object does not suit the unit: no more than the points' spacing, or more than the
 *   scan's extent; horizontal coordinates that look like degrees
 * - less than a tenth of the bounding rectangle holds points
 * - no ground: the ground found lies in patches no larger than the largest object
 * - little ground: few points, few cells with points or a wide spread, as under vegetation
 * - 20 % of the cells with points have no ground within the largest object
 * - a tolerance so large, where no size is given, that it hides what stands out of the ground
 *
 * \param level_points points in the level frame of the ground
 * \param labels one per point
 * \param parameters those that led to the ground
 * \return none for most scans, for no points and for a ground without cells
 */
PCL_FFT_GROUND_CORE_EXPORT std::vector<std::string> warningsAbout(const RobustGround& ground,
                                                                  const PointsView& level_points,
                                                                  const Labels& labels,
                                                                  const RobustParameters& parameters);

}  // namespace pcl_fft_ground::core
