#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

/// Height of a tilted plane, 4 m x 4 m, with two boxes on it, 0.4 m and 0.5 m wide and 0.3 m high [m].
inline float sceneHeight(float x, float y) {
  const bool on_first_box = x > 0.8F && x < 1.2F && y > 0.9F && y < 1.3F;
  const bool on_second_box = x > 2.5F && x < 3.0F && y > 2.4F && y < 2.9F;
  return 0.1F * x + 0.05F * y + (on_first_box || on_second_box ? 0.3F : 0.0F);
}

/// The scene as a scan, one point per square centimetre.
inline pcl::PointCloud<pcl::PointXYZ>::Ptr makeScene() {
  const auto scan = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (int i = 0; i < 400; ++i)
    for (int j = 0; j < 400; ++j) {
      const float x = 0.01F * static_cast<float>(i);
      const float y = 0.01F * static_cast<float>(j);
      scan->emplace_back(x, y, sceneHeight(x, y));
    }
  return scan;
}
