#pragma once

#include <pcl/point_types.h>

#include <boost/program_options.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "pcl_fft_ground/fft_ground_segmentation.h"

namespace pcl_fft_ground::cli {

using Point = pcl::PointXYZ;

/// A segmenter as the command line asks for it.
struct Segmenter {
  std::string method;                           ///< as spelled on the command line
  GroundSegmentation<Point>::Ptr filter;        ///< ready but for its input
  FFTGroundSegmentation<Point>* fft = nullptr;  ///< the same object if it works in the frequency domain
  bool has_own_tolerance = false;               ///< whether it needs none to be told
  std::optional<Eigen::Vector3d> sensor;  ///< its place in the coordinates of the file, if it was told [m]
  double default_cell_size = 0;           ///< for methods without cells [m]
  nlohmann::ordered_json
      parameters;  ///< those set or by default: option -> {"value", "from": "option" or "default"}

  /// Side of an elevation cell [m]; NaN where it is chosen from the data and nothing has been segmented yet.
  double cellSize() const;

  /// The parameters with those that the last run chose: {"value", "from": "data", "reason"}.
  nlohmann::ordered_json parametersInForce() const;
};

/// What a method is there for.
enum class Purpose {
  USE,         ///< to be used, by all commands
  COMPARISON,  ///< to be compared with, by `evaluate`; it tells no surface of the ground
};

/// The methods that there are for a purpose, by the names that the command line gives them, in the order of
/// the paper's tables.
std::vector<std::string> methodNames(Purpose purpose = Purpose::USE);

/// The same as a sentence offers them: "naive, ... or fft (the robust one)".
std::string methodChoice();

/// The options that set the segmenters of these purposes; they are spelled as the setters.
boost::program_options::options_description segmenterOptions(const std::vector<Purpose>& purposes = {
                                                                 Purpose::USE});

/// A segmenter with the options that concern its method; those of other methods are passed over.
/// \throws UsageError naming the option, the value and what is allowed
Segmenter makeSegmenter(const std::string& method, const boost::program_options::variables_map& values,
                        const std::vector<Purpose>& purposes = {Purpose::USE});

}  // namespace pcl_fft_ground::cli
