#include "pcl_fft_ground/kd_tree_neighbours.h"

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <vector>

namespace pcl_fft_ground {
namespace {

class KdTreeNeighbours final : public core::NearestNeighbours {
 public:
  explicit KdTreeNeighbours(const core::PointsView& points) {
    const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
    cloud->reserve(static_cast<std::size_t>(points.cols()));
    for (Eigen::Index n = 0; n < points.cols(); ++n)
      cloud->emplace_back(points(0, n), points(1, n), points(2, n));
    if (!cloud->empty()) tree_.setInputCloud(cloud);
  }

  core::Neighbour nearest(const Eigen::Vector3f& query, float reach) const override {
    if (!tree_.getInputCloud()) return {};
    pcl::Indices index(1);
    std::vector<float> squared_distance(1);
    tree_.nearestKSearch(pcl::PointXYZ(query.x(), query.y(), query.z()), 1, index, squared_distance);
    if (squared_distance[0] > reach * reach) return {};
    return {index[0], squared_distance[0]};
  }

  void within(const Eigen::Vector3f& query, float radius, std::vector<Eigen::Index>& found) const override {
    found.clear();
    if (!tree_.getInputCloud()) return;
    pcl::Indices indices;
    std::vector<float> squared_distances;
    tree_.radiusSearch(pcl::PointXYZ(query.x(), query.y(), query.z()), radius, indices, squared_distances);
    found.assign(indices.begin(), indices.end());
  }

 private:
  pcl::KdTreeFLANN<pcl::PointXYZ> tree_;
};

}  // namespace

std::unique_ptr<core::NearestNeighbours> kdTreeNeighbours(const core::PointsView& points,
                                                          double /*spacing*/) {
  return std::make_unique<KdTreeNeighbours>(points);
}

}  // namespace pcl_fft_ground
