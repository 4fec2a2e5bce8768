#pragma once

#include <pcl/PCLPointCloud2.h>
#include <pcl/register_point_struct.h>

#include <cstddef>
#include <cstdint>

#include "contract_fixture.h"

namespace pcl_fft_ground::test {

/// Points with coordinates in double, which no point type of PCL's has.
struct WidePoint {
  std::uint16_t beam = 0;  ///< number of the beam
  double x = 0, y = 0, z = 0;
  float intensity = 0;
  double time = 0;  ///< [s]
};

/// Stands for a point type whose points are the bytes of a pcl::PCLPointCloud2.
template <typename PointT>
struct InMessage {};

/// A pcl::PCLPointCloud2 that can be used as a cloud of points, as they lie in its bytes.
template <typename PointT>
struct MessageCloud : pcl::PCLPointCloud2 {
  using Ptr = pcl::shared_ptr<MessageCloud>;
  using ConstPtr = pcl::shared_ptr<const MessageCloud>;

  MessageCloud() {
    fields = pcl::getFields<PointT>();
    point_step = sizeof(PointT);
    height = 1;
  }

  std::size_t size() const { return data.size() / sizeof(PointT); }
  bool empty() const { return data.empty(); }
  PointT* begin() { return reinterpret_cast<PointT*>(data.data()); }
  const PointT* begin() const { return reinterpret_cast<const PointT*>(data.data()); }
  PointT* end() { return begin() + size(); }
  const PointT* end() const { return begin() + size(); }
  PointT& operator[](std::size_t n) { return begin()[n]; }
  const PointT& operator[](std::size_t n) const { return begin()[n]; }
  PointT& front() { return *begin(); }

  /// Makes it one row.
  void resize(std::size_t count) {
    data.resize(count * sizeof(PointT));
    width = static_cast<pcl::uindex_t>(count);
    height = 1;
    row_step = static_cast<pcl::uindex_t>(data.size());
  }
  void insert(const PointT* before, const PointT& point) {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&point);
    data.insert(data.begin() + (before - begin()) * static_cast<std::ptrdiff_t>(sizeof(PointT)), bytes,
                bytes + sizeof(PointT));
    const std::size_t count = size();
    resize(count);
  }

  // A message has no pose: one that all share is equal to any.
  inline static Eigen::Vector4f sensor_origin_;
  inline static Eigen::Quaternionf sensor_orientation_;
};

template <typename PointT>
struct CloudFor<InMessage<PointT>> {
  using Type = MessageCloud<PointT>;
};

template <template <typename> class SegmenterT, typename PointT>
using MessageSubject = Subject<SegmenterT, InMessage<PointT>, pcl::PCLPointCloud2>;

}  // namespace pcl_fft_ground::test

POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_fft_ground::test::WidePoint,
                                  (std::uint16_t, beam, beam)(double, x, x)(double, y, y)(double, z, z)(
                                      float, intensity, intensity)(double, time, time))
