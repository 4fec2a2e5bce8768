// Any points and any parameters: the points are split in two or the parameters are refused with a
// PCLException.

#include <pcl/PointIndices.h>
#include <pcl/exceptions.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/voxel_cluster_extraction.h"

namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

/// Takes values off the front of the bytes; zeros when they are used up.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  template <typename Value>
  Value take() {
    Value value{};
    const std::size_t count = sizeof(Value) < size_ ? sizeof(Value) : size_;
    std::memcpy(&value, data_, count);
    data_ += count;
    size_ -= count;
    return value;
  }
  bool empty() const { return size_ == 0; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

/// Scattered within metres, with a few coordinates of any value at all.
Cloud::Ptr takeCloud(Bytes& bytes) {
  constexpr float CENTIMETRES = 0.01F;
  constexpr std::uint8_t ANY_VALUE = 255;
  const Cloud::Ptr cloud(new Cloud);
  while (!bytes.empty()) {
    Point point;
    for (int axis = 0; axis < 3; ++axis) point.data[axis] = CENTIMETRES * bytes.take<std::int8_t>();
    if (bytes.take<std::uint8_t>() == ANY_VALUE) point.x = bytes.take<float>();
    cloud->push_back(point);
  }
  cloud->is_dense = false;
  return cloud;
}

void segment(Bytes& bytes) {
  constexpr float FINEST_CELL = 0.02F;  // finer ones are right, but take their time under sanitizers
  pcl_fft_ground::FFTGroundSegmentation<Point> filter;
  const auto choice = bytes.take<std::uint8_t>();
  filter.setEstimator(choice % 2 == 0 ? pcl_fft_ground::Estimator::ROBUST
                                      : pcl_fft_ground::Estimator::LOW_PASS);
  if (choice & 2) filter.setMaximumObjectSize(bytes.take<float>());
  if (choice & 4) {
    const auto cell_size = bytes.take<float>();
    if (!(cell_size > 0 && cell_size < FINEST_CELL)) filter.setCellSize(cell_size);
  }
  if (choice & 8) filter.setHeightTolerance(bytes.take<float>());
  if (choice & 16) filter.setMaximumSlope(bytes.take<float>());
  const Cloud::Ptr cloud = takeCloud(bytes);
  filter.setInputCloud(cloud);
  pcl::PointIndices ground, objects;
  filter.segment(ground, objects);
  if (ground.indices.size() + objects.indices.size() > cloud->size()) std::abort();

  pcl_fft_ground::VoxelClusterExtraction<Point> extraction;
  extraction.setInputCloud(cloud);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  try {
    segment(bytes);
  } catch (const pcl::PCLException&) {
    // as promised
  }
  return 0;
}
