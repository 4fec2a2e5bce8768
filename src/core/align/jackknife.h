#pragma once

#include <vector>

#include "pcl_fft_ground/core/align/rigid_fit.h"

namespace pcl_fft_ground::core {

/** Covariance of a motion by how far parts of the scene contradict each other: the jackknife.
 *
 * Errors that points of one part share, by drift inside a scan or by what each scan sees of an object, make
 * the parts disagree, however many points they have. Each part is left out in turn; of n parts
 * C = (n - 1) / n sum (v_i - v)(v_i - v)^T, v the motion by all of them, v_i that without the i-th.
 *
 * \param parts equations of each part for motions about one centre; parts without equations do not count
 * \return zero for fewer than two parts
 */
Matrix6d jackknifeCovariance(const std::vector<MotionFit>& parts);

}  // namespace pcl_fft_ground::core
