#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>

#include "command_fixture.h"
#include "pcl_fft_ground/fft_ground_segmentation.h"

namespace pcl_fft_ground::cli {

using nlohmann::json;

class SegmentCommand : public CommandFixture {
 protected:
  Words outputNames() const {
    Words result;
    for (const auto& entry : std::filesystem::directory_iterator(output()))
      result.push_back(entry.path().filename().string());
    std::sort(result.begin(), result.end());
    return result;
  }

  json report() const { return json::parse(contentOf(outputOf("report.json"))); }

  std::vector<double> labels() const { return valuesOf(readByPcl(outputOf("labelled.pcd")), "label"); }

  /// The filter with the parameters of segment(), run on the scan: what the outputs are compared with.
  template <typename PointT>
  static void runFilter(const pcl::PointCloud<PointT>& cloud, FFTGroundSegmentation<pcl::PointXYZ>& filter,
                        pcl::PointIndices& ground, pcl::PointIndices& objects) {
    pcl::PointCloud<pcl::PointXYZ>::Ptr points(new pcl::PointCloud<pcl::PointXYZ>);
    pcl::copyPointCloud(cloud, *points);
    filter.setCellSize(0.04);
    filter.setMaximumObjectSize(0.6);
    filter.setInputCloud(points);
    filter.segment(ground, objects);
  }
};

/// How many labels differ; all if the numbers of labels do.
inline std::size_t differing(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size());
  std::size_t count = 0;
  for (std::size_t n = 0; n < a.size(); ++n) count += a[n] != b[n] ? 1 : 0;
  return count;
}

}  // namespace pcl_fft_ground::cli
