#pragma once

#include <pcl/common/io.h>
#include <pcl/point_cloud.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "box_scene.h"

namespace pcl_fft_ground::test {

constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

inline bool isCoordinate(const pcl::PCLPointField& field) {
  return field.name == "x" || field.name == "y" || field.name == "z";
}

/// Sets every byte of the registered fields other than x, y and z; 0xFF makes floating point ones NaN.
template <typename PointT>
void setOtherFields(PointT& point, std::uint8_t value) {
  static const std::vector<pcl::PCLPointField> fields = pcl::getFields<PointT>();
  for (const pcl::PCLPointField& field : fields)
    if (!isCoordinate(field))
      std::memset(reinterpret_cast<std::uint8_t*>(&point) + field.offset, value,
                  field.count * static_cast<std::size_t>(pcl::getFieldSize(field.datatype)));
}

/// True if the registered fields are equal bit for bit. \param coordinates whether x, y and z count
template <typename PointT>
bool sameFields(const PointT& a, const PointT& b, bool coordinates = true) {
  static const std::vector<pcl::PCLPointField> fields = pcl::getFields<PointT>();
  return std::all_of(fields.begin(), fields.end(), [&](const pcl::PCLPointField& field) {
    if (isCoordinate(field) && !coordinates) return true;
    const std::size_t size = field.count * static_cast<std::size_t>(pcl::getFieldSize(field.datatype));
    return std::memcmp(reinterpret_cast<const std::uint8_t*>(&a) + field.offset,
                       reinterpret_cast<const std::uint8_t*>(&b) + field.offset, size) == 0;
  });
}

/// The cloud that tests of a point type work on; specialised where that is none of PCL's.
template <typename PointT>
struct CloudFor {
  using Type = pcl::PointCloud<PointT>;
};
template <typename PointT>
using CloudOf = typename CloudFor<PointT>::Type;

/// True if two clouds agree in everything: points, shape, header, sensor pose, is_dense.
template <typename CloudT>
bool sameClouds(const CloudT& a, const CloudT& b) {
  return a.size() == b.size() && a.width == b.width && a.height == b.height && a.is_dense == b.is_dense &&
         a.header.frame_id == b.header.frame_id && a.header.stamp == b.header.stamp &&
         a.header.seq == b.header.seq && a.sensor_origin_ == b.sensor_origin_ &&
         a.sensor_orientation_.coeffs() == b.sensor_orientation_.coeffs() &&
         std::equal(a.begin(), a.end(), b.begin(),
                    [](const auto& p, const auto& q) { return sameFields(p, q); });
}

template <typename PointT>
bool isFinitePoint(const PointT& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// An unorganised cloud of these points; the other fields, the header and the sensor's pose are all set.
template <typename PointT>
typename CloudOf<PointT>::Ptr cloudOf(const Eigen::Matrix3Xf& points) {
  typename CloudOf<PointT>::Ptr cloud(new CloudOf<PointT>);
  cloud->resize(static_cast<std::size_t>(points.cols()));
  for (std::size_t n = 0; n < cloud->size(); ++n) {
    auto& p = (*cloud)[n];
    setOtherFields(p, static_cast<std::uint8_t>(n % 251));
    p.x = points(0, static_cast<Eigen::Index>(n));
    p.y = points(1, static_cast<Eigen::Index>(n));
    p.z = points(2, static_cast<Eigen::Index>(n));
  }
  cloud->is_dense = std::all_of(cloud->begin(), cloud->end(), [](const auto& p) { return isFinitePoint(p); });
  cloud->header.frame_id = "sonar";
  cloud->header.stamp = 1234567;
  cloud->header.seq = 42;
  cloud->sensor_origin_ = Eigen::Vector4f(1, 2, 3, 0);
  cloud->sensor_orientation_ = Eigen::Quaternionf(0.5f, 0.5f, 0.5f, 0.5f);
  return cloud;
}

/// The scene as an organised cloud.
template <typename PointT>
typename CloudOf<PointT>::Ptr cloudOf(const Scene& scene) {
  const auto cloud = cloudOf<PointT>(scene.points);
  cloud->width = scene.width;
  cloud->height = scene.height;
  return cloud;
}

/// Makes one coordinate of every 37th point non-finite, in turn NaN, +infinity and -infinity.
template <typename CloudT>
void spoilPoints(CloudT& cloud) {
  constexpr float INFINITE = std::numeric_limits<float>::infinity();
  for (std::size_t n = 5; n < cloud.size(); n += 37) {
    const float value = n % 3 == 0 ? NOT_A_NUMBER : n % 3 == 1 ? INFINITE : -INFINITE;
    (n % 4 == 0 ? cloud[n].x : n % 4 == 1 ? cloud[n].y : cloud[n].z) = value;
  }
  cloud.is_dense = false;
}

/// A length that suits the points, whatever their scale: cells of a size given once and for all would be too
/// many, or would take their time.
template <typename PointT>
double unitOf(const pcl::PointCloud<PointT>& cloud) {
  constexpr float BEYOND_MEASURE = 1e18F;
  double extent = 0;
  for (const PointT& p : cloud)
    for (const float value : p.data)
      if (std::abs(value) <= BEYOND_MEASURE) extent = std::max(extent, static_cast<double>(std::abs(value)));
  return extent > 0 ? extent : 1;
}

}  // namespace pcl_fft_ground::test
