#include "align/jackknife.h"

#include <cstddef>

namespace pcl_fft_ground::core {

Matrix6d jackknifeCovariance(const std::vector<MotionFit>& parts) {
  MotionFit all(Eigen::Vector3d::Zero());
  std::size_t count = 0;
  for (const MotionFit& part : parts) {
    if (part.information().isZero(0)) continue;
    all += part;
    ++count;
  }
  if (count < 2) return Matrix6d::Zero();
  const Vector6d motion = all.motion();
  Matrix6d sum = Matrix6d::Zero();
  for (const MotionFit& part : parts) {
    if (part.information().isZero(0)) continue;
    MotionFit others = all;
    others -= part;
    const Vector6d difference = others.motion() - motion;
    sum += difference * difference.transpose();
  }
  return static_cast<double>(count - 1) / static_cast<double>(count) * sum;
}

}  // namespace pcl_fft_ground::core
