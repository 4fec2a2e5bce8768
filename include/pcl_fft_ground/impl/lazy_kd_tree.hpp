#pragma once

#include <pcl/search/kdtree.h>

#include <utility>
#include <vector>

namespace pcl_fft_ground::impl {

/// A tree that is not built before it is searched: `pcl::Registration` hands it the target whether needed or
/// not.
template <typename PointT>
class LazyKdTree : public pcl::search::KdTree<PointT> {
 public:
  using Base = pcl::search::KdTree<PointT>;
  using Base::nearestKSearch;
  using Base::radiusSearch;
  using typename Base::IndicesConstPtr;
  using typename Base::PointCloudConstPtr;

  /// What PCL's tree returns: nothing before PCL 1.14, whether it could be built since then.
  using SetInputResult =
      decltype(std::declval<Base&>().setInputCloud(std::declval<const PointCloudConstPtr&>()));

  SetInputResult setInputCloud(const PointCloudConstPtr& cloud,
                               const IndicesConstPtr& indices = IndicesConstPtr()) override {
    cloud_ = cloud;
    cloud_indices_ = indices;
    built_ = false;
    return SetInputResult(true);
  }

  int nearestKSearch(const PointT& point, int k, pcl::Indices& indices,
                     std::vector<float>& squared_distances) const override {
    build();
    return Base::nearestKSearch(point, k, indices, squared_distances);
  }

  int radiusSearch(const PointT& point, double radius, pcl::Indices& indices,
                   std::vector<float>& squared_distances, unsigned int max_nn = 0) const override {
    build();
    return Base::radiusSearch(point, radius, indices, squared_distances, max_nn);
  }

 private:
  void build() const {
    if (built_) return;
    const_cast<LazyKdTree*>(this)->Base::setInputCloud(cloud_, cloud_indices_);
    built_ = true;
  }

  PointCloudConstPtr cloud_;
  IndicesConstPtr cloud_indices_;
  mutable bool built_ = false;
};

}  // namespace pcl_fft_ground::impl
