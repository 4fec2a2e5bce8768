#pragma once

#include <pcl/point_types.h>

#include <boost/program_options.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "pcl_fft_ground/fft_ground_segmentation.h"

namespace pcl_fft_ground::cli {

using Point = pcl::PointXYZ;

/// A segmenter as the command line asks for it.
struct Segmenter {
  std::string method;                                 ///< as spelled on the command line
  std::unique_ptr<GroundSegmentation<Point>> filter;  ///< ready but for its input
  FFTGroundSegmentation<Point>* fft = nullptr;  ///< the same object where it works in the frequency domain
  double cell_size = 0;                         ///< side of an elevation cell [m]
};

/// The methods that `--method` takes, for help texts and messages.
extern const char* const METHODS;

/// The options that choose and set a segmenter; they are spelled as the setters.
boost::program_options::options_description segmenterOptions();

/// The segmenter that the options describe.
/// \throws UsageError naming the option, the value and what is allowed
Segmenter makeSegmenter(const boost::program_options::variables_map& values);

/// The parameters in force, by option, each {"value": ..., "from": "option" or "default"}.
nlohmann::ordered_json describeParameters(const Segmenter& segmenter,
                                          const boost::program_options::variables_map& values);

}  // namespace pcl_fft_ground::cli
