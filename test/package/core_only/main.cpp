// Two points a metre apart and one beside the first: two clusters.
#include <pcl_fft_ground/core/segments/voxel_clusters.h>
#include <pcl_fft_ground/version.h>

#include <iostream>

int main() {
  pcl_fft_ground::core::Points points(3, 3);
  points.col(0) << 0.0F, 0.0F, 0.0F;
  points.col(1) << 0.1F, 0.0F, 0.0F;
  points.col(2) << 1.0F, 0.0F, 0.0F;
  const auto clusters = pcl_fft_ground::core::voxelClusters(points, 0.1);
  std::cout << "version " PCL_FFT_GROUND_VERSION ": " << clusters.size() << " clusters\n";
  return clusters.size() == 2 ? 0 : 1;
}
