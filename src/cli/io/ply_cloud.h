#pragma once

#include <string_view>

#include "io/raw_cloud.h"

namespace pcl_fft_ground::cli {

/// Decodes the vertices of a PLY file (ascii or binary, of either byte order) with all their single values;
/// lists and every other element (faces) are passed over. As pcl::PLYReader does, nx, ny, nz become
/// normal_x, normal_y, normal_z; other names stay. The viewpoint is the identity.
///
/// pcl::PLYReader is not used for this: PCL 1.13's allocates whatever a header claims.
/// \throws WorkError saying what is wrong, but not naming the file; nothing is allocated for vertices that
///         the file is too short to hold
RawCloud decodePly(std::string_view content);

}  // namespace pcl_fft_ground::cli
