#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/cloud_file.h"

/// The steps of readCloud(), for clouds that are read in parts.
namespace pcl_fft_ground::cli {

/// The format of a file. \param content all of it or its first bytes
/// \throws WorkError for a format that is not read
CloudFormat formatOf(const std::string& path, std::string_view content, const ReadOptions& options);

/// x, y and z of every point as the file has them.
using Coordinates = std::array<std::vector<double>, 3>;

/// Names the coordinates x, y and z where they are X, Y and Z, and reads them. \throws WorkError for none
Coordinates coordinatesOf(RawCloud& raw);

/// What a cloud is, but for its labels. \param origin is subtracted from the coordinates
Cloud interpretCoordinates(RawCloud raw, const Coordinates& xyz, const Eigen::Vector3d& origin);

/// The numbers of the label field; NaN where they are none, and for points that are not used. Empty if there
/// are no numbers at all.
std::vector<double> labelNumbers(const RawCloud& raw);

/// Which numbers mean ground, and which neither.
struct LabelMeaning {
  std::vector<int> ground, ignored;
};

/// What the numbers of a label field mean, or why they are not known.
struct LabelVerdict {
  std::optional<LabelMeaning> meaning;
  std::string fault;  ///< empty where there is nothing to say
};

/// \param numbers all numbers that occur, as often as they like
LabelVerdict judgeLabels(const std::vector<double>& numbers, const RawCloud& raw, const ReadOptions& options);

/// 0 ground, 1 object, 2 neither for each number.
std::vector<int> labelsBy(const LabelMeaning& meaning, const std::vector<double>& numbers);

}  // namespace pcl_fft_ground::cli
