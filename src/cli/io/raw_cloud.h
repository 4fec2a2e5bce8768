#pragma once

#include <pcl/PCLPointCloud2.h>

#include <cstddef>
#include <cstdint>

#include "io/viewpoint.h"

namespace pcl_fft_ground::cli {

/// What a file says, before its coordinates are looked at: the decoders of the three formats return it.
struct RawCloud {
  pcl::PCLPointCloud2
      table;  ///< all points and fields, packed; each field of the type that the file gives it
  Viewpoint viewpoint;
};

/// The most points that pcl::index_t can count.
constexpr std::int64_t max_point_count = 2147483647;

/// The most bytes that one point may take: far above any real file (a histogram of 10,000 bins has 40,000),
/// and so low that a size times a number of points fits into 64 bits.
constexpr std::uint64_t max_point_bytes = 1u << 24;

}  // namespace pcl_fft_ground::cli
