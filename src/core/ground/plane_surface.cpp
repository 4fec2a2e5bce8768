#include "pcl_fft_ground/core/ground/plane_surface.h"

namespace pcl_fft_ground::core {

GroundSurface planeSurface(const Eigen::Isometry3d& frame_from_input, const Bounds& bounds,
                           const Plane& plane) {
  const double longest = (bounds.high - bounds.low).head<2>().maxCoeff();
  const double cell_size = longest > 0 ? longest : 1.0;
  const Eigen::Vector2d first_centre = bounds.low.head<2>();
  GroundSurface surface{
      frame_from_input, {first_centre.array() - 0.5 * cell_size, cell_size, 2, 2}, Eigen::ArrayXXd(2, 2)};
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i)
      surface.height(i, j) = plane.slope.dot(first_centre + cell_size * Eigen::Vector2d(i, j)) + plane.offset;
  return surface;
}

}  // namespace pcl_fft_ground::core
