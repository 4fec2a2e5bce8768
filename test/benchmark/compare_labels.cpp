// Says how far the results of two runs of `segment` on the same cloud agree: labels, and segments by their
// overlap.

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <map>
#include <string>
#include <utility>

struct LabelledPoint {
  PCL_ADD_POINT4D;
  std::int32_t label, segment;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};
POINT_CLOUD_REGISTER_POINT_STRUCT(LabelledPoint,
                                  (float, x, x)(float, y, y)(float, z, z)(std::int32_t, label,
                                                                          label)(std::int32_t, segment,
                                                                                 segment))

int main(int argc, char** argv) {
  pcl::PointCloud<LabelledPoint> a, b;
  const auto load = [&](const char* directory, pcl::PointCloud<LabelledPoint>& cloud) {
    return pcl::io::loadPCDFile(std::string(directory) + "/labelled.pcd", cloud) == 0;
  };
  if (argc != 3 || !load(argv[1], a) || !load(argv[2], b) || a.size() != b.size()) {
    std::cerr << "usage: compare_labels DIR DIR, two results of segment on one cloud\n";
    return 2;
  }
  std::size_t same = 0;
  std::map<int, double> sizes_a, sizes_b, best;
  std::map<std::pair<int, int>, double> common;
  for (std::size_t n = 0; n < a.size(); ++n) {
    same += a[n].label == b[n].label ? 1U : 0U;
    if (a[n].segment > 0) ++sizes_a[a[n].segment];
    if (b[n].segment > 0) ++sizes_b[b[n].segment];
    if (a[n].segment > 0 && b[n].segment > 0) ++common[{a[n].segment, b[n].segment}];
  }
  for (const auto& [pair, points] : common) {
    const double all = sizes_a[pair.first] + sizes_b[pair.second] - points;
    best[pair.first] = std::max(best[pair.first], points / all);
  }
  const auto found = [&](double least) {
    const auto count =
        std::count_if(best.begin(), best.end(), [&](const auto& entry) { return entry.second > least; });
    return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(sizes_a.size(), 1));
  };
  std::printf(
      "points %zu, labels agree %.6f (%zu differ); segments %zu and %zu, IoU > 0.95: %.4f, > 0.5: %.4f\n",
      a.size(), static_cast<double>(same) / static_cast<double>(a.size()), a.size() - same, sizes_a.size(),
      sizes_b.size(), found(0.95), found(0.5));
  return 0;
}
