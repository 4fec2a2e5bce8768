#pragma once

#include <boost/program_options.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "io/cloud_file.h"

namespace pcl_fft_ground::cli {

/// The words of a command's help on which files it reads.
constexpr const char* CLOUD_FILES = "PCD, PLY, LAS or text file, or KITTI or nuScenes points (.bin)";

enum class Labels { USED, IGNORED };

/// The options that tell how clouds are read: --format and, where labels are used, --ground-classes and
/// --ignore-classes.
boost::program_options::options_description readingOptions(Labels labels);

/// What the options say.
/// \throws UsageError naming the option, the value and what is allowed
ReadOptions readOptions(const boost::program_options::variables_map& values);

/// Whole numbers parted by commas.
/// \throws UsageError naming the option
std::vector<int> numberList(const std::string& option, const std::string& text);

/// Notes the options that were given among a report's parameters.
void describeReading(const ReadOptions& options, nlohmann::ordered_json& parameters);

}  // namespace pcl_fft_ground::cli
