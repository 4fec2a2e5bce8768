#include "segmentation_options.h"

#include <pcl/exceptions.h>
#include <pybind11/stl.h>

#include <Eigen/Core>
#include <array>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/graph_cut_ground_segmentation.h"
#include "pcl_fft_ground/grid_ground_segmentation.h"
#include "pcl_fft_ground/naive_ground_segmentation.h"
#include "pcl_fft_ground/planar_ground_segmentation.h"

namespace pcl_fft_ground::python {
namespace {

namespace py = pybind11;
using Point = pcl::PointXYZ;
using FFT = FFTGroundSegmentation<Point>;
using Planar = PlanarGroundSegmentation<Point>;
using Grid = GridGroundSegmentation<Point>;
using GraphCut = GraphCutGroundSegmentation<Point>;

/// Sets an option of a filter; false if it is none of that filter's.
using Setter = std::function<bool(Filter&, py::handle)>;

/// How Python gives a value: direction vectors as three numbers.
template <typename Value>
Value fromPython(py::handle value) {
  if constexpr (std::is_same_v<Value, Eigen::Vector3d>) {
    const auto numbers = value.cast<std::array<double, 3>>();
    return {numbers[0], numbers[1], numbers[2]};
  } else {
    return value.cast<Value>();
  }
}

template <typename Method, typename Value>
Setter setter(void (Method::*set)(Value)) {
  return [set](Filter& filter, py::handle value) {
    auto* const method = dynamic_cast<Method*>(&filter);
    if (method != nullptr) (method->*set)(fromPython<std::decay_t<Value>>(value));
    return method != nullptr;
  };
}

/// The same for one of a few words.
template <typename Method, typename Value>
Setter wordSetter(void (Method::*set)(Value), std::vector<std::pair<const char*, Value>> words) {
  return [set, words = std::move(words)](Filter& filter, py::handle given) {
    auto* const method = dynamic_cast<Method*>(&filter);
    if (method == nullptr) return false;
    const auto wanted = given.cast<std::string>();
    std::string allowed;
    for (const auto& [word, value] : words) {
      if (wanted == word) return (method->*set)(value), true;
      allowed += (allowed.empty() ? "" : ", ") + std::string(word);
    }
    throw std::invalid_argument("'" + wanted + "', allowed is one of " + allowed);
  };
}

/// Options by name; one that several methods have stands several times.
const std::vector<std::pair<const char*, Setter>>& setters() {
  static const std::vector<std::pair<const char*, Setter>> table{
      {"up_direction", setter(&Filter::setUpDirection)},
      {"up_estimation",
       wordSetter(&Filter::setUpEstimation, {{"auto", UpEstimation::AUTO},
                                             {"principal-axis", UpEstimation::PRINCIPAL_AXIS},
                                             {"given", UpEstimation::GIVEN}})},
      {"yaw", wordSetter(&Filter::setYaw, {{"min-area-rectangle", Yaw::MIN_AREA_RECTANGLE},
                                           {"principal-axes", Yaw::PRINCIPAL_AXES},
                                           {"none", Yaw::NONE}})},
      {"height_tolerance", setter(&Filter::setHeightTolerance)},
      {"threads", setter(&Filter::setNumberOfThreads)},
      {"cell_size", setter(&FFT::setCellSize)},
      {"cell_size", setter(&Grid::setCellSize)},
      {"cell_size", setter(&GraphCut::setCellSize)},
      {"max_object_size", setter(&FFT::setMaximumObjectSize)},
      {"max_object_size", setter(&GraphCut::setMaximumObjectSize)},
      {"relative_max_object_size", setter(&FFT::setRelativeMaximumObjectSize)},
      {"filter_order", setter(&FFT::setFilterOrder)},
      {"passband_ripple", setter(&FFT::setPassbandRipple)},
      {"max_slope", setter(&FFT::setMaximumSlope)},
      {"finest_wavelength", setter(&FFT::setFinestWavelength)},
      {"cell_statistic", wordSetter(&FFT::setCellStatistic,
                                    {{"lowest", CellStatistic::LOWEST}, {"mean", CellStatistic::MEAN}})},
      {"cutoff_frequency", setter(&FFT::setCutoffFrequency)},
      {"peak_window", setter(&FFT::setPeakWindow)},
      {"peak_threshold", setter(&FFT::setPeakThreshold)},
      {"distance_threshold", setter(&Planar::setDistanceThreshold)},
      {"max_iterations", setter(&Planar::setMaxIterations)},
      {"probability", setter(&Planar::setProbability)},
      {"optimize_coefficients", setter(&Planar::setOptimizeCoefficients)},
      {"plane_seed", setter(&Planar::setSeed)},
      {"voxel_height", setter(&Grid::setVoxelHeight)},
      {"object_height", setter(&GraphCut::setObjectHeight)},
      {"step_height", setter(&GraphCut::setStepHeight)},
      {"smoothness", setter(&GraphCut::setSmoothness)}};
  return table;
}

std::unique_ptr<Filter> filterFor(const std::string& method) {
  if (method == "fft") return std::make_unique<FFT>();
  if (method == "fft-lowpass") {
    auto fft = std::make_unique<FFT>();
    fft->setEstimator(Estimator::LOW_PASS);
    return fft;
  }
  if (method == "naive") return std::make_unique<NaiveGroundSegmentation<Point>>();
  if (method == "planar") return std::make_unique<Planar>();
  if (method == "grid") return std::make_unique<Grid>();
  if (method == "graph-cut") return std::make_unique<GraphCut>();
  throw std::invalid_argument("method '" + method +
                              "': allowed is one of naive, planar, grid, graph-cut, fft-lowpass, fft");
}

/// Sets one option. \return whether the filter has it
bool setOption(Filter& filter, const std::string& name, py::handle value) {
  try {
    for (const auto& [option, set] : setters())
      if (name == option && set(filter, value)) return true;
    return false;
  } catch (const py::cast_error&) {
    throw std::invalid_argument(name + " = " + std::string(py::repr(value)) + ": not of the right type");
  } catch (const std::invalid_argument& problem) {
    throw std::invalid_argument(name + " = " + problem.what());
  } catch (const pcl::PCLException& problem) {
    const std::string message = problem.what();  // "Class: parameter is value, must be range"
    const std::size_t range = message.rfind(", must be ");
    throw std::invalid_argument(name + " = " + std::string(py::repr(value)) + ": must be " +
                                message.substr(range == std::string::npos ? 0 : range + 10));
  }
}

bool isKnown(const std::string& name) {
  for (const auto& [option, set] : setters())
    if (name == option) return true;
  return false;
}

}  // namespace

std::unique_ptr<Filter> makeFilter(const std::string& method, py::dict& options) {
  std::unique_ptr<Filter> filter = filterFor(method);
  filter->setNumberOfThreads(0);  // as the command
  py::dict rest;
  for (const auto& [key, value] : options) {
    const auto name = key.cast<std::string>();
    if (!isKnown(name))
      rest[key] = value;
    else if (!value.is_none() && !setOption(*filter, name, value))
      throw std::invalid_argument(name + ": the method '" + method + "' has no such option");
  }
  options = rest;
  return filter;
}

}  // namespace pcl_fft_ground::python
