#pragma once

#include <string_view>

#include "io/raw_cloud.h"

namespace pcl_fft_ground::cli {

/// Decodes a cloud from text, one point a line.
///
/// Values are parted by blanks, tabs, commas or semicolons; `#` starts a comment; lines without values are
/// passed over. `nan` and `inf` are numbers. Every line has as many values as the first one.
///
/// The first line is a header if it does not start with a number, or is a number alone (the number of
/// points in a .pts file). If it names columns x, y and z, in any order and case, these are the
/// coordinates, `label` the label, and every other name a float field of its own, NaN where a value is no
/// number. Otherwise columns 1 to 3 are x, y, z; column 4 is the label if it is the last one; columns
/// beyond that are ignored.
///
/// Coordinates come as FLOAT64, the label, a whole number, as INT32 (NaN: 2, neither ground nor object).
/// \throws WorkError naming the line's number and content, but not the file
RawCloud decodeText(std::string_view content);

}  // namespace pcl_fft_ground::cli
