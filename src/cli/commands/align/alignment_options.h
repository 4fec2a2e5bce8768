#pragma once

#include <boost/program_options.hpp>
#include <nlohmann/json.hpp>

#include "methods/segmenter.h"
#include "pcl_fft_ground/core/align/segment_alignment.h"
#include "pcl_fft_ground/core/segments/segment.h"

namespace pcl_fft_ground::cli {

/// Which version of the segments and of their alignment: the paper's or the one that was made of it.
enum class Version { OURS, PAPER };

/// How scans are described by segments and aligned, as the command line asks for it.
struct AlignmentSettings {
  Version version = Version::OURS;
  core::SegmentParameters segments;
  core::AlignmentParameters alignment;
  nlohmann::ordered_json described;  ///< the settings in force, by the names of the options
};

/// The options that set the alignment. \param fallback value of --fallback where it is not given
boost::program_options::options_description alignmentOptions(const char* fallback);

/// The settings that the options ask for.
/// \throws UsageError naming the option, the value and what is allowed
AlignmentSettings alignmentSettings(const boost::program_options::variables_map& values);

/** A segmenter for alignment. Methods that know no tolerance get one of 1 cm, unless the user or the paper's
 * version says otherwise: speckle above the ground would join all segments into one.
 *
 * \throws UsageError as makeSegmenter()
 */
Segmenter makeAlignmentSegmenter(const std::string& method,
                                 const boost::program_options::variables_map& values, Version version);

}  // namespace pcl_fft_ground::cli
