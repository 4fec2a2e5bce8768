#include "methods/segmenter.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "command_line.h"
#include "errors.h"
#include "io/scanner.h"
#include "methods/method.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

namespace po = boost::program_options;
using nlohmann::ordered_json;

/// The methods that there are: those of the paper in the order of its tables, those for comparison last.
constexpr std::array<Method, 9> REGISTRY{
    {{"naive", "", Tolerance::NONE, Purpose::USE, addOtherOptions, makeNaive},
     {"planar", "", Tolerance::NONE, Purpose::USE, addOtherOptions, makePlanar},
     {"grid", "", Tolerance::NONE, Purpose::USE, addOtherOptions, makeGrid},
     {"graph-cut", "", Tolerance::OWN, Purpose::USE, addOtherOptions, makeGraphCut},
     {"fft-lowpass", "the published method", Tolerance::NONE, Purpose::USE, addFrequencyOptions, makeLowPass},
     {"fft", "the robust one", Tolerance::OWN, Purpose::USE, addFrequencyOptions, makeRobust},
     {"pcl-pmf", "", Tolerance::OWN, Purpose::COMPARISON, addPclOptions, makePclPmf},
     {"pcl-approximate-pmf", "", Tolerance::OWN, Purpose::COMPARISON, addPclOptions, makePclApproximatePmf},
     {"pcl-mlesac-plane", "", Tolerance::OWN, Purpose::COMPARISON, addPclOptions, makePclMlesacPlane}}};

bool isFor(const Method& method, const std::vector<Purpose>& purposes) {
  return std::find(purposes.begin(), purposes.end(), method.purpose) != purposes.end();
}

std::vector<std::string> namesFor(const std::vector<Purpose>& purposes) {
  std::vector<std::string> names;
  for (const Method& method : REGISTRY)
    if (isFor(method, purposes)) names.emplace_back(method.name);
  return names;
}

constexpr std::array<std::pair<const char*, UpEstimation>, 3> UP_ESTIMATIONS{
    {{"auto", UpEstimation::AUTO},
     {"principal-axis", UpEstimation::PRINCIPAL_AXIS},
     {"given", UpEstimation::GIVEN}}};
constexpr std::array<std::pair<const char*, Yaw>, 3> YAWS{{{"min-area-rectangle", Yaw::MIN_AREA_RECTANGLE},
                                                           {"principal-axes", Yaw::PRINCIPAL_AXES},
                                                           {"none", Yaw::NONE}}};

Eigen::Vector3d toVector(const std::string& option, const std::string& text) {
  std::string_view rest = text;
  const std::optional<double> x = parseNumber<double>(takeWord(rest)),
                              y = parseNumber<double>(takeWord(rest)),
                              z = parseNumber<double>(takeWord(rest));
  if (!x || !y || !z || !takeWord(rest).empty())
    throw UsageError("--" + option + " " + text + ": allowed are three numbers, X Y Z");
  return {*x, *y, *z};
}

/// The side of an elevation cell, which the pictures want of methods, too, that have no use for it.
double cellSize(const po::variables_map& values) {
  FFTGroundSegmentation<Point> checking;
  checking.setEstimator(Estimator::LOW_PASS);  // the other one has no fixed cell size
  ordered_json noted;
  ParameterSetter(values, noted)
      .set<double>(
          "cell-size", [&](double v) { checking.setCellSize(v); }, [&] { return checking.getCellSize(); });
  return checking.getCellSize();
}

po::options_description commonOptions() {
  const auto number = [] { return po::value<double>(); };
  po::options_description common("Segmentation", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add = common.add_options();
  add("cell-size", number()->value_name("M"),
      "side of an elevation cell [m], above 0 (0.02; fft: chosen from the data)");
  add("max-object-size", number()->value_name("M"),
      "size of the largest object [m], above 0: anything larger is ground");
  add("height-tolerance", number()->value_name("M"),
      "height above the ground up to which a point is ground [m] (0; graph-cut: 0.02; fft: chosen from the "
      "data)");
  add("up-direction", po::value<std::string>()->value_name("X Y Z"),
      "direction of positive elevation (0 0 1; with --up-estimation auto another one, where the points "
      "clearly "
      "speak for it)");
  add("sensor", po::value<std::string>()->value_name("X Y Z"),
      "where the sensor stood, in the coordinates of the input: on the upper side of the ground (found, "
      "where "
      "the points show rays from 0 0 0)");
  add("up-estimation", po::value<std::string>()->value_name("NAME"),
      "principal-axis: the direction in which the points vary least, turned towards --up-direction; given: "
      "--up-direction itself; auto: the principal axis where it can be trusted (fft and graph-cut: "
      "auto; fft-lowpass: principal-axis; naive, planar and grid: given)");
  add("yaw", po::value<std::string>()->value_name("NAME"),
      "how the grid is turned about up: min-area-rectangle, principal-axes or none (min-area-rectangle; "
      "naive, planar and grid: none)");
  return common;
}

}  // namespace

void setUpCommon(GroundSegmentation<Point>& filter, ParameterSetter& parameters) {
  parameters.set<std::string>(
      "up-direction", [&](const auto& v) { filter.setUpDirection(toVector("up-direction", v)); },
      [&] { return asList(filter.getUpDirection()); });
  if (parameters.isGiven("sensor"))
    parameters.set<std::string>(
        "sensor", [&](const auto& v) { filter.setSensorPosition(toVector("sensor", v)); },
        [&] { return asList(filter.getSensorPosition()); });
  parameters.set<std::string>(
      "up-estimation",
      [&](const auto& v) { filter.setUpEstimation(valueNamed("up-estimation", v, UP_ESTIMATIONS)); },
      [&] { return nameOf(filter.getUpEstimation(), UP_ESTIMATIONS); });
  parameters.set<std::string>(
      "yaw", [&](const auto& v) { filter.setYaw(valueNamed("yaw", v, YAWS)); },
      [&] { return nameOf(filter.getYaw(), YAWS); });
  parameters.set<double>(
      "height-tolerance", [&](double v) { filter.setHeightTolerance(v); },
      [&] { return filter.getHeightTolerance(); });
}

double Segmenter::cellSize() const {
  return fft != nullptr ? fft->getCellSize() : default_cell_size;
}

ordered_json Segmenter::parametersInForce() const {
  return fft == nullptr ? parameters : withChoices(parameters, fft->getChoices());
}

ordered_json withChoices(ordered_json result, const std::vector<core::RobustChoice>& choices) {
  for (const core::RobustChoice& choice : choices) {
    if (choice.parameter == "statistic") continue;  // an option with a word for a value, noted as the default
    std::string option = choice.parameter;
    std::replace(option.begin(), option.end(), '_', '-');
    result[option] = {{"value", choice.value}, {"from", "data"}, {"reason", choice.reason}};
  }
  return result;
}

std::vector<std::string> methodNames(Purpose purpose) {
  return namesFor({purpose});
}

std::string methodChoice() {
  const std::vector<std::string> names = methodNames();
  std::string choice;
  for (std::size_t n = 0; n < names.size(); ++n) {
    choice += n == 0 ? "" : n + 1 == names.size() ? " or " : ", ";
    choice += names[n];
    if (*REGISTRY[n].note != '\0') choice += std::string(" (") + REGISTRY[n].note + ")";
  }
  return choice;
}

po::options_description segmenterOptions(const std::vector<Purpose>& purposes) {
  po::options_description options = commonOptions();
  std::vector<void (*)(po::options_description&)> added;
  const auto add = [&](Purpose purpose) {
    for (auto method = REGISTRY.rbegin(); method != REGISTRY.rend(); ++method) {
      const bool is_added = std::find(added.begin(), added.end(), method->add_options) != added.end();
      if (method->purpose != purpose || method->add_options == nullptr || is_added) continue;
      method->add_options(options);
      added.push_back(method->add_options);
    }
  };
  for (const Purpose purpose : purposes) add(purpose);
  return options;
}

Segmenter makeSegmenter(const std::string& name, const po::variables_map& values,
                        const std::vector<Purpose>& purposes) {
  if (values.count("max-object-size") != 0 && values.count("relative-max-object-size") != 0)
    throw UsageError("--max-object-size and --relative-max-object-size: allowed is one of the two");
  const auto method = std::find_if(REGISTRY.begin(), REGISTRY.end(),
                                   [&](const Method& m) { return m.name == name && isFor(m, purposes); });
  if (method == REGISTRY.end())
    throw UsageError("--method " + name + ": allowed is one of " + joined(namesFor(purposes), ", "));
  Segmenter segmenter = method->make(values);
  segmenter.method = name;
  segmenter.has_own_tolerance = method->tolerance == Tolerance::OWN;
  segmenter.default_cell_size = cellSize(values);
  if (values.count("sensor") != 0) segmenter.sensor = segmenter.filter->getSensorPosition();
  return segmenter;
}

}  // namespace pcl_fft_ground::cli
