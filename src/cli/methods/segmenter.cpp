#include "methods/segmenter.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "command_line.h"
#include "errors.h"
#include "io/scanner.h"
#include "methods/parameter_setter.h"
#include "pcl_fft_ground/graph_cut_ground_segmentation.h"
#include "pcl_fft_ground/grid_ground_segmentation.h"
#include "pcl_fft_ground/naive_ground_segmentation.h"
#include "pcl_fft_ground/planar_ground_segmentation.h"

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
constexpr std::array<std::pair<const char*, bool>, 2> SWITCH{{{"on", true}, {"off", false}}};
constexpr std::array<std::pair<const char*, Estimator>, 2> ESTIMATORS{
    {{"robust", Estimator::ROBUST}, {"low-pass", Estimator::LOW_PASS}}};
constexpr std::array<std::pair<const char*, CellStatistic>, 2> CELL_STATISTICS{
    {{"lowest", CellStatistic::LOWEST}, {"mean", CellStatistic::MEAN}}};

Eigen::Vector3d toDirection(const std::string& text) {
  std::string_view rest = text;
  const std::optional<double> x = parseNumber<double>(takeWord(rest)),
                              y = parseNumber<double>(takeWord(rest)),
                              z = parseNumber<double>(takeWord(rest));
  if (!x || !y || !z || !takeWord(rest).empty())
    throw UsageError("--up-direction " + text + ": allowed are three numbers, X Y Z");
  return {*x, *y, *z};
}

std::vector<double> asList(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

void setUpCommon(GroundSegmentation<Point>& filter, ParameterSetter& parameters) {
  parameters.set<std::string>(
      "up-direction", [&](const auto& v) { filter.setUpDirection(toDirection(v)); },
      [&] { return asList(filter.getUpDirection()); });
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

/// What has to be known before anything else: it decides about defaults.
template <typename Filter>
void prepare(Filter&, const std::string&, ParameterSetter&) {}

void prepare(FFTGroundSegmentation<Point>& fft, const std::string& method, ParameterSetter& parameters) {
  if (method == "fft-lowpass") return fft.setEstimator(Estimator::LOW_PASS);
  parameters.set<std::string>(
      "estimator", [&](const auto& v) { fft.setEstimator(valueNamed("estimator", v, ESTIMATORS)); },
      [&] { return nameOf(fft.getEstimator(), ESTIMATORS); });
}

void setUpLowPass(FFTGroundSegmentation<Point>& fft, ParameterSetter& parameters) {
  parameters.set<double>(
      "cutoff-frequency", [&](double v) { fft.setCutoffFrequency(v); },
      [&] { return fft.getCutoffFrequency(); });
  parameters.setCount(
      "peak-window", [&](unsigned v) { fft.setPeakWindow(v); }, [&] { return fft.getPeakWindow(); });
  parameters.set<double>(
      "peak-threshold", [&](double v) { fft.setPeakThreshold(v); }, [&] { return fft.getPeakThreshold(); });
  parameters.set<bool>(
      "exact-grid",
      [&](bool exact) {
        if (exact) fft.setGridLengths(core::GridLengths::EXACT);
      },
      [&] { return fft.getGridLengths() == core::GridLengths::EXACT; });
}

void setUpRobustFit(FFTGroundSegmentation<Point>& fft, ParameterSetter& parameters) {
  parameters.set<double>(
      "max-slope", [&](double v) { fft.setMaximumSlope(v); }, [&] { return fft.getMaximumSlope(); });
  parameters.set<double>(
      "finest-wavelength", [&](double v) { fft.setFinestWavelength(v); },
      [&] { return fft.getFinestWavelength(); });
  parameters.set<std::string>(
      "cell-statistic",
      [&](const auto& v) { fft.setCellStatistic(valueNamed("cell-statistic", v, CELL_STATISTICS)); },
      [&] { return nameOf(fft.getCellStatistic(), CELL_STATISTICS); });
}

void setUp(FFTGroundSegmentation<Point>& fft, ParameterSetter& parameters) {
  parameters.set<double>(
      "cell-size", [&](double v) { fft.setCellSize(v); }, [&] { return fft.getCellSize(); });
  parameters.set<double>(
      "max-object-size", [&](double v) { fft.setMaximumObjectSize(v); },
      [&] { return fft.getMaximumObjectSize(); });
  parameters.set<double>(
      "relative-max-object-size", [&](double v) { fft.setRelativeMaximumObjectSize(v); },
      [&] { return fft.getRelativeMaximumObjectSize(); });
  parameters.setCount(
      "filter-order", [&](unsigned v) { fft.setFilterOrder(v); }, [&] { return fft.getFilterOrder(); });
  parameters.set<double>(
      "passband-ripple", [&](double v) { fft.setPassbandRipple(v); },
      [&] { return fft.getPassbandRipple(); });
  // What is of the other estimator only is checked all the same.
  ordered_json not_in_force;
  ParameterSetter others = parameters.notingIn(not_in_force);
  const bool low_pass = fft.getEstimator() == Estimator::LOW_PASS;
  setUpLowPass(fft, low_pass ? parameters : others);
  setUpRobustFit(fft, low_pass ? others : parameters);
}

void setUp(NaiveGroundSegmentation<Point>&, ParameterSetter&) {}

void setUp(PlanarGroundSegmentation<Point>& planar, ParameterSetter& parameters) {
  parameters.set<double>(
      "distance-threshold", [&](double v) { planar.setDistanceThreshold(v); },
      [&] { return planar.getDistanceThreshold(); });
  parameters.setCount(
      "max-iterations", [&](unsigned v) { planar.setMaxIterations(static_cast<int>(v)); },
      [&] { return planar.getMaxIterations(); });
  parameters.set<double>(
      "probability", [&](double v) { planar.setProbability(v); }, [&] { return planar.getProbability(); });
  parameters.set<std::string>(
      "optimize-coefficients",
      [&](const auto& v) { planar.setOptimizeCoefficients(valueNamed("optimize-coefficients", v, SWITCH)); },
      [&] { return nameOf(planar.getOptimizeCoefficients(), SWITCH); });
  parameters.setCount(
      "plane-seed", [&](unsigned v) { planar.setSeed(v); }, [&] { return planar.getSeed(); });
}

void setUp(GridGroundSegmentation<Point>& grid, ParameterSetter& parameters) {
  parameters.set<double>(
      "cell-size", [&](double v) { grid.setCellSize(v); }, [&] { return grid.getCellSize(); });
  parameters.set<double>(
      "voxel-height", [&](double v) { grid.setVoxelHeight(v); }, [&] { return grid.getVoxelHeight(); });
}

void setUp(GraphCutGroundSegmentation<Point>& cut, ParameterSetter& parameters) {
  parameters.set<double>(
      "cell-size", [&](double v) { cut.setCellSize(v); }, [&] { return cut.getCellSize(); });
  parameters.set<double>(
      "max-object-size", [&](double v) { cut.setMaximumObjectSize(v); },
      [&] { return cut.getMaximumObjectSize(); });
  parameters.set<double>(
      "object-height", [&](double v) { cut.setObjectHeight(v); }, [&] { return cut.getObjectHeight(); });
  parameters.set<double>(
      "step-height", [&](double v) { cut.setStepHeight(v); }, [&] { return cut.getStepHeight(); });
  parameters.set<double>(
      "smoothness", [&](double v) { cut.setSmoothness(v); }, [&] { return cut.getSmoothness(); });
}

template <typename Filter>
Segmenter make(const std::string& method, const po::variables_map& values) {
  Segmenter segmenter;
  segmenter.method = method;
  auto filter = std::make_unique<Filter>();
  ParameterSetter parameters(values, segmenter.parameters);
  prepare(*filter, method, parameters);
  setUpCommon(*filter, parameters);
  setUp(*filter, parameters);
  if constexpr (std::is_same_v<Filter, FFTGroundSegmentation<Point>>) segmenter.fft = filter.get();
  segmenter.filter = std::move(filter);
  return segmenter;
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

using Maker = Segmenter (*)(const std::string&, const po::variables_map&);

const std::vector<std::pair<std::string, Maker>>& methods() {
  static const std::vector<std::pair<std::string, Maker>> makers{
      {"naive", make<NaiveGroundSegmentation<Point>>},
      {"planar", make<PlanarGroundSegmentation<Point>>},
      {"grid", make<GridGroundSegmentation<Point>>},
      {"graph-cut", make<GraphCutGroundSegmentation<Point>>},
      {"fft-lowpass", make<FFTGroundSegmentation<Point>>},
      {"fft", make<FFTGroundSegmentation<Point>>}};
  return makers;
}

}  // namespace

double Segmenter::cellSize() const {
  return fft != nullptr ? fft->getCellSize() : default_cell_size;
}

ordered_json Segmenter::parametersInForce() const {
  ordered_json result = parameters;
  if (fft == nullptr) return result;
  for (const core::RobustChoice& choice : fft->getChoices()) {
    if (choice.parameter == "statistic") continue;  // an option with a word for a value, noted as the default
    std::string option = choice.parameter;
    std::replace(option.begin(), option.end(), '_', '-');
    result[option] = {{"value", choice.value}, {"from", "data"}, {"reason", choice.reason}};
  }
  return result;
}

const std::vector<std::string>& methodNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const auto& [name, maker] : methods()) result.push_back(name);
    return result;
  }();
  return names;
}

Segmenter makeSegmenter(const std::string& method, const po::variables_map& values) {
  if (values.count("max-object-size") != 0 && values.count("relative-max-object-size") != 0)
    throw UsageError("--max-object-size and --relative-max-object-size: allowed is one of the two");
  std::string allowed;
  for (const auto& [name, maker] : methods()) {
    if (name == method) {
      Segmenter segmenter = maker(method, values);
      segmenter.default_cell_size = cellSize(values);
      return segmenter;
    }
    allowed += (allowed.empty() ? "" : ", ") + name;
  }
  throw UsageError("--method " + method + ": allowed is one of " + allowed);
}

}  // namespace pcl_fft_ground::cli
