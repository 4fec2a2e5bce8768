// Takes the ground out of a scan: the filter as a stage of a PCL pipeline.

#include <pcl/point_types.h>

#include <cmath>
#include <iostream>

#include "pcl_fft_ground/fft_ground_segmentation.h"

/// A sea floor of 4 m x 4 m, one point per square centimetre, with a box of 0.4 m x 0.4 m x 0.2 m on it.
pcl::PointCloud<pcl::PointXYZ>::Ptr makeScan() {
  pcl::PointCloud<pcl::PointXYZ>::Ptr scan(new pcl::PointCloud<pcl::PointXYZ>);
  for (int i = 0; i < 400; ++i)
    for (int j = 0; j < 400; ++j) {
      const float x = 0.01F * static_cast<float>(i), y = 0.01F * static_cast<float>(j);
      const bool on_box = std::abs(x - 2.5F) < 0.2F && std::abs(y - 1.5F) < 0.2F;
      scan->push_back({x, y, 0.1F * std::sin(x) + (on_box ? 0.2F : 0.0F)});
    }
  return scan;
}

int main() {
  pcl_fft_ground::FFTGroundSegmentation<pcl::PointXYZ> filter;
  filter.setInputCloud(makeScan());
  filter.setMaximumObjectSize(1.0);  // metres: what is larger counts as ground
  filter.setHeightTolerance(0.05);   // metres: the low-pass surface is pulled up a little around objects

  pcl::PointCloud<pcl::PointXYZ> objects, ground;
  filter.filter(objects);
  filter.setNegative(true);
  filter.filter(ground);

  std::cout << objects.size() << " object points, " << ground.size() << " ground points\n";
  return objects.empty() || ground.empty() ? 1 : 0;
}
