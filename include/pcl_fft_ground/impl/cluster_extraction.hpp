#pragma once

#include <pcl/console/print.h>
#include <pcl/exceptions.h>

#include <cmath>
#include <sstream>
#include <utility>

#include <pcl/impl/pcl_base.hpp>

#include "pcl_fft_ground/cluster_extraction.h"
#include "pcl_fft_ground/core/scan/threads.h"
#include "pcl_fft_ground/impl/indexed_points.hpp"

namespace pcl_fft_ground {

template <typename PointT>
void ClusterExtraction<PointT>::require(bool valid, const char* parameter, double value,
                                        const char* range) const {
  if (valid) return;
  std::ostringstream message;
  message << name_ << ": " << parameter << " is " << value << ", must be " << range;
  throw pcl::PCLException(message.str());
}

template <typename PointT>
void ClusterExtraction<PointT>::setLeafSize(double leaf_size) {
  require(std::isfinite(leaf_size) && leaf_size > 0, "leaf size", leaf_size,
          "a finite number of metres above 0");
  leaf_size_ = leaf_size;
}

template <typename PointT>
std::string ClusterExtraction<PointT>::problem(std::size_t) const {
  return "";
}

template <typename PointT>
void ClusterExtraction<PointT>::extract(std::vector<pcl::PointIndices>& clusters) {
  clusters.clear();
  if (!initCompute()) return;
  const core::Threads threads(number_of_threads_);
  const impl::IndexedPoints<PointT> listed(*input_, fake_indices_ ? nullptr : indices_.get());
  std::string why_not = listed.problem();
  if (why_not.empty()) why_not = problem(listed.size());
  if (!why_not.empty()) {
    PCL_ERROR("[pcl_fft_ground::%s] %s\n", name_, why_not.c_str());
    return;
  }
  impl::FinitePoints finite = listed.finite();
  for (const std::vector<Eigen::Index>& members : clustersOf(std::move(finite.points))) {
    if (members.size() < min_cluster_size_ || members.size() > max_cluster_size_) continue;
    pcl::PointIndices& cluster = clusters.emplace_back();
    cluster.header = input_->header;
    cluster.indices.reserve(members.size());
    for (const Eigen::Index n : members) cluster.indices.push_back(listed.index(finite.position(n)));
  }
  deinitCompute();
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_ClusterExtraction(T) \
  template class PCL_FFT_GROUND_FILTERS_EXPORT pcl_fft_ground::ClusterExtraction<T>;
