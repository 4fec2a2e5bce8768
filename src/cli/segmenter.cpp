#include "segmenter.h"

#include <pcl/exceptions.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "command_line.h"
#include "errors.h"
#include "scanner.h"

namespace pcl_fft_ground::cli {
namespace {

namespace po = boost::program_options;
using nlohmann::ordered_json;

constexpr std::array<std::pair<const char*, UpEstimation>, 3> UP_ESTIMATIONS{
    {{"auto", UpEstimation::AUTO},
     {"principal-axis", UpEstimation::PRINCIPAL_AXIS},
     {"given", UpEstimation::GIVEN}}};
constexpr std::array<std::pair<const char*, Yaw>, 3> YAWS{{{"min-area-rectangle", Yaw::MIN_AREA_RECTANGLE},
                                                           {"principal-axes", Yaw::PRINCIPAL_AXES},
                                                           {"none", Yaw::NONE}}};

/// The value that a word stands for.
template <typename Value, std::size_t N>
Value valueNamed(const std::string& option, const std::string& word,
                 const std::array<std::pair<const char*, Value>, N>& names) {
  std::string allowed;
  for (const auto& [name, value] : names) {
    if (word == name) return value;
    allowed += (allowed.empty() ? "" : ", ") + std::string(name);
  }
  throw UsageError("--" + option + " " + word + ": allowed is one of " + allowed);
}

template <typename Value, std::size_t N>
std::string nameOf(Value value, const std::array<std::pair<const char*, Value>, N>& names) {
  return std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.second == value; })->first;
}

/// Calls a setter if its option was given; its complaint becomes one about the option.
template <typename Value, typename Setter>
void apply(const po::variables_map& values, const std::string& option, const Setter& set) {
  if (values.count(option) == 0) return;
  try {
    set(values[option].as<Value>());
  } catch (const pcl::PCLException& problem) {
    const std::string message = problem.what();  // "Class: parameter is value, must be range"
    throw UsageError("--" + option + message.substr(message.rfind(": ")));
  }
}

Eigen::Vector3d toDirection(const std::string& text) {
  std::string_view rest = text;
  const std::optional<double> x = parseNumber<double>(takeWord(rest)),
                              y = parseNumber<double>(takeWord(rest)),
                              z = parseNumber<double>(takeWord(rest));
  if (!x || !y || !z || !takeWord(rest).empty())
    throw UsageError("--up-direction " + text + ": allowed are three numbers, X Y Z");
  return {*x, *y, *z};
}

void setUpFrame(GroundSegmentation<Point>& filter, const po::variables_map& values) {
  apply<std::string>(values, "up-direction", [&](const auto& v) { filter.setUpDirection(toDirection(v)); });
  apply<std::string>(values, "up-estimation", [&](const auto& v) {
    filter.setUpEstimation(valueNamed("up-estimation", v, UP_ESTIMATIONS));
  });
  apply<std::string>(values, "yaw", [&](const auto& v) { filter.setYaw(valueNamed("yaw", v, YAWS)); });
}

/// A count that the parser would take from "-1" as a huge one is refused by its sign.
unsigned toUnsigned(const std::string& option, long long value) {
  if (value < 0 || value > 1000000000)
    throw UsageError("--" + option + " " + std::to_string(value) +
                     ": allowed is a whole number from 0 to 1e9");
  return static_cast<unsigned>(value);
}

void setUpFFT(FFTGroundSegmentation<Point>& fft, const po::variables_map& values) {
  if (values.count("max-object-size") != 0 && values.count("relative-max-object-size") != 0)
    throw UsageError("--max-object-size and --relative-max-object-size: allowed is one of the two");
  apply<double>(values, "cell-size", [&](double v) { fft.setCellSize(v); });
  apply<double>(values, "max-object-size", [&](double v) { fft.setMaximumObjectSize(v); });
  apply<double>(values, "relative-max-object-size", [&](double v) { fft.setRelativeMaximumObjectSize(v); });
  apply<double>(values, "height-tolerance", [&](double v) { fft.setHeightTolerance(v); });
  apply<double>(values, "cutoff-frequency", [&](double v) { fft.setCutoffFrequency(v); });
  apply<long long>(values, "filter-order",
                   [&](long long v) { fft.setFilterOrder(toUnsigned("filter-order", v)); });
  apply<double>(values, "passband-ripple", [&](double v) { fft.setPassbandRipple(v); });
  apply<long long>(values, "peak-window",
                   [&](long long v) { fft.setPeakWindow(toUnsigned("peak-window", v)); });
  apply<double>(values, "peak-threshold", [&](double v) { fft.setPeakThreshold(v); });
  if (values["exact-grid"].as<bool>()) fft.setGridLengths(core::GridLengths::EXACT);
}

std::vector<double> asList(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

const char* const METHODS = "fft, fft-lowpass";

po::options_description segmenterOptions() {
  po::options_description options("Segmentation", HELP_WIDTH, HELP_TEXT_WIDTH);
  const auto number = [] { return po::value<double>(); };
  auto add = options.add_options();
  add("method", po::value<std::string>()->default_value("fft")->value_name("NAME"),
      "how ground is told from objects: fft or fft-lowpass, at present both the published low-pass");
  add("cell-size", number()->value_name("M"), "side of an elevation cell [m], above 0 (0.02)");
  add("max-object-size", number()->value_name("M"),
      "size of the largest object [m], above 0: anything larger is ground");
  add("relative-max-object-size", number()->value_name("SHARE"),
      "the same as a share of the scan's smaller horizontal extent, in (0, 1] (0.5)");
  add("height-tolerance", number()->value_name("M"),
      "height above the ground up to which a point is ground [m] (0)");
  add("up-direction", po::value<std::string>()->value_name("X Y Z"),
      "direction of positive elevation (0 0 1)");
  add("up-estimation", po::value<std::string>()->value_name("NAME"),
      "principal-axis: the direction in which the points vary least, turned towards --up-direction; "
      "given: --up-direction itself; auto: the principal axis where it can be trusted (principal-axis)");
  add("yaw", po::value<std::string>()->value_name("NAME"),
      "how the grid is turned about up: min-area-rectangle, principal-axes or none (min-area-rectangle)");
  add("cutoff-frequency", number()->value_name("RATIO"),
      "cut-off as a ratio of the Nyquist range, up to 1.414, in place of the automatic one; 0: automatic "
      "(0)");
  add("filter-order", po::value<long long>()->value_name("N"), "order of the low-pass, 1 to 100 (2)");
  add("passband-ripple", number()->value_name("DB"),
      "attenuation at the cut-off [dB], above 0 up to 100 (3)");
  add("peak-window", po::value<long long>()->value_name("K"),
      "a peak of the spectrum is the largest of (2 K + 1) x (2 K + 1) bins, 1 to 1000 (1)");
  add("peak-threshold", number()->value_name("C"),
      "by how much a peak exceeds the other bins, at least 0 (0)");
  add("exact-grid", po::bool_switch(), "leave the grid's axes as they are, not lengthened to fast lengths");
  return options;
}

Segmenter makeSegmenter(const po::variables_map& values) {
  const auto method = values["method"].as<std::string>();
  if (method != "fft" && method != "fft-lowpass")
    throw UsageError("--method " + method + ": allowed is one of " + METHODS);
  auto fft = std::make_unique<FFTGroundSegmentation<Point>>();
  setUpFrame(*fft, values);
  setUpFFT(*fft, values);
  FFTGroundSegmentation<Point>* const view = fft.get();
  return {method, std::move(fft), view, view->getCellSize()};
}

ordered_json describeParameters(const Segmenter& segmenter, const po::variables_map& values) {
  ordered_json parameters;
  const auto add = [&](const std::string& option, const ordered_json& value) {
    const bool given = values.count(option) != 0 && !values[option].defaulted();
    parameters[option] = {{"value", value}, {"from", given ? "option" : "default"}};
  };
  const GroundSegmentation<Point>& filter = *segmenter.filter;
  add("method", segmenter.method);
  add("up-direction", asList(filter.getUpDirection()));
  add("up-estimation", nameOf(filter.getUpEstimation(), UP_ESTIMATIONS));
  add("yaw", nameOf(filter.getYaw(), YAWS));
  add("cell-size", segmenter.cell_size);
  const FFTGroundSegmentation<Point>& fft = *segmenter.fft;
  if (std::isnan(fft.getMaximumObjectSize()))
    add("relative-max-object-size", fft.getRelativeMaximumObjectSize());
  else
    add("max-object-size", fft.getMaximumObjectSize());
  add("height-tolerance", fft.getHeightTolerance());
  add("cutoff-frequency",
      values.count("cutoff-frequency") != 0 ? values["cutoff-frequency"].as<double>() : 0.0);
  add("filter-order", fft.getFilterOrder());
  add("passband-ripple", fft.getPassbandRipple());
  add("peak-window", fft.getPeakWindow());
  add("peak-threshold", fft.getPeakThreshold());
  add("exact-grid", fft.getGridLengths() == core::GridLengths::EXACT);
  return parameters;
}

}  // namespace pcl_fft_ground::cli
