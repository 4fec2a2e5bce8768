#pragma once

#include <pcl/PCLPointCloud2.h>
#include <pcl/point_cloud.h>
#include <pcl/types.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

namespace pcl_fft_ground::impl {

/// A coordinate less an origin as a float; what is finite stays finite.
inline float localCoordinate(double value, double origin) {
  constexpr double LARGEST = std::numeric_limits<float>::max();
  const double local = value - origin;
  return static_cast<float>(std::isfinite(local) ? std::clamp(local, -LARGEST, LARGEST) : local);
}

/// The points of a cloud of a point type: what the filters read of it, and how they copy from it.
template <typename PointT>
class CloudView {
 public:
  using Cloud = pcl::PointCloud<PointT>;

  explicit CloudView(const Cloud& cloud) : cloud_(cloud) {}

  std::size_t size() const { return cloud_.size(); }
  /// Why the points cannot be read; empty if they can.
  static std::string_view problem() { return {}; }
  static constexpr bool isDouble() { return std::is_same_v<decltype(PointT::x), double>; }

  Eigen::Vector3d place(std::size_t n) const { return {cloud_[n].x, cloud_[n].y, cloud_[n].z}; }
  bool isFinite(std::size_t n) const {
    const PointT& p = cloud_[n];
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  }
  /// \param origin zero unless isDouble()
  Eigen::Vector3f local(std::size_t n, const Eigen::Vector3d& origin) const {
    const PointT& p = cloud_[n];
    if constexpr (isDouble())
      return {localCoordinate(p.x, origin.x()), localCoordinate(p.y, origin.y()),
              localCoordinate(p.z, origin.z())};
    else
      return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  }

  /// Makes a cloud of some points, one after the other, in one row.
  void copy(const pcl::Indices& indices, Cloud& output) const {
    output.resize(indices.size());
    for (std::size_t n = 0; n < indices.size(); ++n) output[n] = cloud_[static_cast<std::size_t>(indices[n])];
  }
  /// Replaces x, y and z of a point of a copy of the cloud.
  void replace(std::size_t n, float value, Cloud& copy) const { copy[n].x = copy[n].y = copy[n].z = value; }

 private:
  const Cloud& cloud_;
};

/** The same for a cloud of any fields, x, y and z among them, all in float32 or all in float64.
 * Rows may be padded. Cheap to copy; the cloud must outlive it.
 */
template <>
class CloudView<pcl::PCLPointCloud2> {
 public:
  using Cloud = pcl::PCLPointCloud2;

  explicit CloudView(const Cloud& cloud) : cloud_(cloud) {
    // PCL does not heed the length of a row, and leaves wrong ones behind: it counts where the data agree.
    const std::size_t tight = std::size_t{cloud.width} * cloud.point_step;
    row_step_ = std::size_t{cloud.row_step} * cloud.height == cloud.data.size() ? cloud.row_step : tight;
    problem_ = findCoordinates();
  }

  std::size_t size() const { return std::size_t{cloud_.width} * cloud_.height; }
  std::string_view problem() const { return problem_; }
  bool isDouble() const { return is_double_; }

  Eigen::Vector3d place(std::size_t n) const {
    const std::size_t start = position(n);
    return {coordinate(start, 0), coordinate(start, 1), coordinate(start, 2)};
  }
  bool isFinite(std::size_t n) const { return place(n).allFinite(); }
  Eigen::Vector3f local(std::size_t n, const Eigen::Vector3d& origin) const {
    const Eigen::Vector3d p = place(n);
    return {localCoordinate(p.x(), origin.x()), localCoordinate(p.y(), origin.y()),
            localCoordinate(p.z(), origin.z())};
  }

  void copy(const pcl::Indices& indices, Cloud& output) const {
    output.fields = cloud_.fields;
    output.is_bigendian = cloud_.is_bigendian;
    output.point_step = cloud_.point_step;
    output.data.resize(indices.size() * cloud_.point_step);
    std::uint8_t* next = output.data.data();
    for (const pcl::index_t n : indices) {
      std::copy_n(cloud_.data.data() + position(static_cast<std::size_t>(n)), cloud_.point_step, next);
      next += cloud_.point_step;
    }
    output.row_step = static_cast<pcl::uindex_t>(output.data.size());
  }
  void replace(std::size_t n, float value, Cloud& copy) const {
    for (const std::size_t offset : offsets_) {
      std::uint8_t* const to = copy.data.data() + position(n) + offset;
      if (is_double_) {
        const double wide = value;
        std::memcpy(to, &wide, sizeof wide);
      } else {
        std::memcpy(to, &value, sizeof value);
      }
    }
  }

 private:
  /// Where a point starts in the data.
  std::size_t position(std::size_t n) const {
    if (cloud_.height <= 1) return n * cloud_.point_step;
    return n / cloud_.width * row_step_ + n % cloud_.width * cloud_.point_step;
  }

  double coordinate(std::size_t start, std::size_t axis) const {
    const std::uint8_t* const from = cloud_.data.data() + start + offsets_[axis];
    if (is_double_) {
      double value;
      std::memcpy(&value, from, sizeof value);
      return value;
    }
    float value;
    std::memcpy(&value, from, sizeof value);
    return value;
  }

  std::string_view findCoordinates() {
    if (size() == 0) return {};
    constexpr std::array<const char*, 3> NAMES{"x", "y", "z"};
    std::array<std::uint8_t, 3> types{};
    std::size_t end = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto field = std::find_if(cloud_.fields.begin(), cloud_.fields.end(),
                                      [&](const auto& f) { return f.name == NAMES[axis]; });
      if (field == cloud_.fields.end()) return "the cloud lacks one of the fields x, y and z";
      offsets_[axis] = field->offset;
      types[axis] = field->datatype;
      end = std::max<std::size_t>(end, field->offset);
    }
    const bool alike = types[0] == types[1] && types[1] == types[2];
    is_double_ = types[0] == pcl::PCLPointField::FLOAT64;
    if (!alike || (!is_double_ && types[0] != pcl::PCLPointField::FLOAT32))
      return "x, y and z of the cloud are neither all float32 nor all float64";
    end += is_double_ ? sizeof(double) : sizeof(float);
    if (end > cloud_.point_step || cloud_.data.size() < cloud_.height * row_step_)
      return "the cloud holds less data than its fields, width and height say";
    return {};
  }

  const Cloud& cloud_;
  std::size_t row_step_ = 0;
  std::array<std::size_t, 3> offsets_{};  ///< of x, y and z in a point [bytes]
  bool is_double_ = false;
  std::string_view problem_;
};

}  // namespace pcl_fft_ground::impl
