#include "commands/align/alignment_options.h"

#include <cmath>
#include <limits>
#include <sstream>

#include "command_line.h"
#include "errors.h"

namespace pcl_fft_ground::cli {
namespace {

namespace po = boost::program_options;

constexpr double ROUGH_TOLERANCE = 0.01;  // [m], three deviations of the range of a close scan
constexpr double PAPER_EXTENT = 0.02;     // [m], Sec. V-D2
constexpr double INFINITE = std::numeric_limits<double>::infinity();

[[noreturn]] void refuse(const std::string& option, const std::string& value, const std::string& allowed) {
  throw UsageError("--" + option + " " + value + ": allowed is " + allowed);
}

/// Sets a number if its option was given. \param low,high ends of the range; low itself is not part of it
void setNumber(const po::variables_map& values, const char* option, double low, double high, double& target) {
  if (values.count(option) == 0) return;
  const auto value = values[option].as<double>();
  if (value > low && value <= high && std::isfinite(value)) {
    target = value;
    return;
  }
  std::ostringstream given, allowed;
  given << value;
  allowed << "a finite number above " << low;
  if (std::isfinite(high)) allowed << " and at most " << high;
  refuse(option, given.str(), allowed.str());
}

void setCount(const po::variables_map& values, const char* option, std::size_t& target) {
  constexpr long long MOST = 1000000;
  if (values.count(option) == 0) return;
  const auto value = values[option].as<long long>();
  if (value < 1 || value > MOST)
    refuse(option, std::to_string(value), "a whole number from 1 to " + std::to_string(MOST));
  target = static_cast<std::size_t>(value);
}

/// Whether a word is the first of two that are allowed.
bool isFirst(const po::variables_map& values, const char* option, const char* first, const char* second) {
  const auto word = values[option].as<std::string>();
  if (word != first && word != second) refuse(option, word, std::string(first) + " or " + second);
  return word == first;
}

void describe(AlignmentSettings& settings) {
  const core::AlignmentParameters& a = settings.alignment;
  const core::SegmentParameters& s = settings.segments;
  settings.described = {{"version", settings.version == Version::PAPER ? "paper" : "ours"},
                        {"matching", a.matching == core::Matching::PLAIN ? "plain" : "local"},
                        {"fallback", a.fallback == core::Fallback::NONE ? "none" : "dense"},
                        {"relief", a.relief == core::ReliefUse::OFF ? "off" : "auto"},
                        {"max-shift", a.gates.max_shift},
                        {"max-rise", a.gates.max_rise},
                        {"max-turn", a.gates.max_turn},
                        {"max-tilt", a.gates.max_tilt},
                        {"hypotheses", a.gates.hypotheses},
                        {"min-matches", a.min_matches},
                        {"min-score", a.min_score},
                        {"max-sigma", core::largestSigma(a, s.voxel_size.value_or(0))},
                        {"min-extent", s.min_extent},
                        {"min-voxels", s.min_voxels},
                        {"max-segments", s.max_segments}};
  if (s.voxel_size) settings.described["voxel-size"] = *s.voxel_size;
}

}  // namespace

po::options_description alignmentOptions(const char* fallback) {
  const auto number = [](const char* unit) { return po::value<double>()->value_name(unit); };
  const auto count = [] { return po::value<long long>()->value_name("N"); };
  const auto word = [](const char* otherwise) {
    return po::value<std::string>()->default_value(otherwise)->value_name("NAME");
  };
  po::options_description options("Alignment", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add = options.add_options();
  add("search", word("navigation"),
      "navigation: the guess is right to 0.6 m and 8 degrees; wide: to 2.5 m and 25");
  add("max-shift", number("M"), "largest horizontal correction of the guess [m] (as --search says)");
  add("max-turn", number("DEG"),
      "largest correction of its heading [degrees], at most 180 (as --search says)");
  add("matching", word("local"),
      "local: segments are aligned one by one, matched, fitted by point-to-plane ICP and gated; plain: "
      "matched by "
      "their centroids and sizes only");
  add("fallback", word(fallback),
      "where segments do not suffice: dense (ICP of all surfaces, gated) or none");
  add("relief", word("auto"),
      "where these do not suffice either: auto (the relief of bare ground is searched for all that "
      "navigation "
      "allows) or off");
  add("min-matches", count(), "N_seg: fewer matched segments give no alignment (3)");
  add("min-score", number("SHARE"),
      "least share of object points that agree, up to 1 (0.8); three quarters of it for dense");
  add("max-sigma", number("M"),
      "largest predicted deviation, and largest distance left between the surfaces of segments [m] (0.05, or "
      "0.12 "
      "voxels if that is more)");
  add("min-extent", number("M"), "size of the smallest segment [m] (0.1)");
  add("min-voxels", count(), "voxels of the smallest segment (12)");
  add("max-segments", count(), "of more segments the largest are taken (60)");
  add("voxel-size", number("M"), "side of the voxels that form the segments [m] (0.02, more for thin scans)");
  add("paper", po::bool_switch(),
      "as published: segments from 2 cm on and of any number of voxels, plain matching, no tolerance above "
      "the ground, "
      "no fallback, no relief");
  return options;
}

AlignmentSettings alignmentSettings(const po::variables_map& values) {
  AlignmentSettings settings;
  core::AlignmentParameters& alignment = settings.alignment;
  const bool near = isFirst(values, "search", "navigation", "wide");
  alignment.gates = core::gatesOf(near ? core::SearchMode::NAVIGATION : core::SearchMode::WIDE);
  alignment.matching =
      isFirst(values, "matching", "local", "plain") ? core::Matching::LOCAL : core::Matching::PLAIN;
  alignment.fallback =
      isFirst(values, "fallback", "dense", "none") ? core::Fallback::DENSE : core::Fallback::NONE;
  alignment.relief = isFirst(values, "relief", "auto", "off") ? core::ReliefUse::AUTO : core::ReliefUse::OFF;
  if (values["paper"].as<bool>()) {
    settings.version = Version::PAPER;
    settings.segments.min_extent = PAPER_EXTENT;
    settings.segments.min_voxels = 1;
    alignment.matching = core::Matching::PLAIN;
    alignment.fallback = core::Fallback::NONE;
    alignment.relief = core::ReliefUse::OFF;
  }
  setNumber(values, "max-shift", 0, INFINITE, alignment.gates.max_shift);
  setNumber(values, "max-turn", 0, 180, alignment.gates.max_turn);
  setNumber(values, "min-score", 0, 1, alignment.min_score);
  double max_sigma = 0;
  setNumber(values, "max-sigma", 0, INFINITE, max_sigma);
  if (max_sigma > 0) alignment.max_sigma = max_sigma;
  setNumber(values, "min-extent", 0, INFINITE, settings.segments.min_extent);
  setCount(values, "min-matches", alignment.min_matches);
  setCount(values, "min-voxels", settings.segments.min_voxels);
  setCount(values, "max-segments", settings.segments.max_segments);
  double voxel_size = 0;
  setNumber(values, "voxel-size", 0, INFINITE, voxel_size);
  if (voxel_size > 0) settings.segments.voxel_size = voxel_size;
  describe(settings);
  return settings;
}

Segmenter makeAlignmentSegmenter(const std::string& method, const po::variables_map& values,
                                 Version version) {
  Segmenter segmenter = makeSegmenter(method, values);
  if (version == Version::PAPER || segmenter.has_own_tolerance || values.count("height-tolerance") != 0)
    return segmenter;
  segmenter.filter->setHeightTolerance(ROUGH_TOLERANCE);
  segmenter.parameters["height-tolerance"] = {{"value", ROUGH_TOLERANCE}, {"from", "alignment"}};
  return segmenter;
}

}  // namespace pcl_fft_ground::cli
