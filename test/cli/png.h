#pragma once

#include <cairo.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

namespace pcl_fft_ground::cli {

constexpr std::uint32_t kWhite = 0xffffffU;

/// A PNG read back.
class Png {
 public:
  explicit Png(const std::filesystem::path& path)
      : surface_(cairo_image_surface_create_from_png(path.c_str()), cairo_surface_destroy) {
    EXPECT_EQ(cairo_surface_status(surface_.get()), CAIRO_STATUS_SUCCESS) << path;
  }
  int width() const { return cairo_image_surface_get_width(surface_.get()); }
  int height() const { return cairo_image_surface_get_height(surface_.get()); }
  /// 0xRRGGBB
  std::uint32_t at(const Eigen::Vector2d& position) const {
    const unsigned char* const row =
        cairo_image_surface_get_data(surface_.get()) +
        static_cast<std::ptrdiff_t>(position.y()) * cairo_image_surface_get_stride(surface_.get());
    return reinterpret_cast<const std::uint32_t*>(row)[static_cast<std::ptrdiff_t>(position.x())] & kWhite;
  }

 private:
  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
};

}  // namespace pcl_fft_ground::cli
