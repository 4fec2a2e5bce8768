// `import pcl_fft_ground`: the segmenters on arrays of points.
#include <pcl/console/print.h>
#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/scan/threads.h"
#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/object_cluster_extraction.h"
#include "pcl_fft_ground/version.h"
#include "pcl_fft_ground/voxel_cluster_extraction.h"
#include "point_array.h"
#include "segmentation_options.h"

namespace pcl_fft_ground::python {
namespace {

namespace py = pybind11;
using Point = pcl::PointXYZ;

/// What segment() returns.
struct Segmentation {
  py::array_t<std::int32_t> labels;    ///< 0 ground, 1 object, 2 neither
  py::array_t<double> height;          ///< above the ground [m]
  py::array_t<float> p_ground;         ///< how likely a point is ground; empty if not known
  py::array_t<std::int32_t> segments;  ///< from 1 by falling size, 0 none
  core::GroundSurface surface;         ///< its frame takes the coordinates of the array
  py::dict report;
};

/// The ground and what it is made of, found without the interpreter's lock.
struct Result {
  pcl::PointIndices ground, objects;
  std::vector<double> heights;
  std::vector<float> ground_probability;
  std::vector<pcl::PointIndices> clusters;
};

/// How object points are clustered: as the command does it.
struct Clustering {
  bool contact_only;
  std::optional<double> leaf_size, min_object_size, max_object_size;  ///< [m]
  unsigned min_cluster_size;
};

template <typename Extraction>
std::vector<pcl::PointIndices> clustersBy(Extraction& extraction, const pcl::PointCloud<Point>::Ptr& points,
                                          const pcl::Indices& objects, const Clustering& clustering) {
  extraction.setInputCloud(points);
  extraction.setIndices(pcl::IndicesConstPtr(new pcl::Indices(objects)));
  extraction.setMinClusterSize(clustering.min_cluster_size);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);
  return clusters;
}

std::vector<pcl::PointIndices> clustersOf(const pcl::PointCloud<Point>::Ptr& points,
                                          const pcl::Indices& objects, const Eigen::Vector3d& up,
                                          double leaf_size, const Clustering& clustering) {
  if (clustering.contact_only) {
    VoxelClusterExtraction<Point> extraction;
    extraction.setLeafSize(leaf_size);
    return clustersBy(extraction, points, objects, clustering);
  }
  ObjectClusterExtraction<Point> extraction;
  extraction.setLeafSize(leaf_size);
  extraction.setUpDirection(up);
  const double smallest = clustering.max_object_size
                              ? core::MINIMUM_OBJECT_SHARE * *clustering.max_object_size
                              : core::MINIMUM_OBJECT_LEAVES * leaf_size;
  extraction.setMinimumObjectSize(clustering.min_object_size.value_or(smallest));
  return clustersBy(extraction, points, objects, clustering);
}

/// Side of a cluster's voxel: that of an elevation cell, whether or not the method has cells itself.
double defaultLeafSize(const Filter& filter) {
  const auto* fft = dynamic_cast<const FFTGroundSegmentation<Point>*>(&filter);
  const double cell_size = fft != nullptr ? fft->getCellSize() : core::LowPassParameters().cell_size;
  return cell_size > 0 ? cell_size : core::LowPassParameters().cell_size;
}

Result run(Filter& filter, const PointArray& xyz, const Clustering& clustering) {
  const core::Threads threads(filter.getNumberOfThreads());
  Result result;
  filter.setInputCloud(xyz.points);
  filter.segment(result.ground, result.objects);
  result.heights = filter.getHeightAboveGround();
  if (const auto* fft = dynamic_cast<const FFTGroundSegmentation<Point>*>(&filter))
    result.ground_probability = fft->getGroundProbability();
  const Eigen::Vector3d up = filter.getFrame().linear().row(2).transpose();
  result.clusters = clustersOf(xyz.points, result.objects.indices, up,
                               clustering.leaf_size.value_or(defaultLeafSize(filter)), clustering);
  return result;
}

template <typename Number>
py::array_t<Number> filled(std::size_t count, Number value) {
  py::array_t<Number> array(static_cast<py::ssize_t>(count));
  std::fill(array.mutable_data(), array.mutable_data() + count, value);
  return array;
}

py::array_t<std::int32_t> labelsOf(std::size_t count, const Result& result) {
  py::array_t<std::int32_t> labels = filled<std::int32_t>(count, 2);
  for (const pcl::index_t n : result.ground.indices) labels.mutable_data()[n] = 0;
  for (const pcl::index_t n : result.objects.indices) labels.mutable_data()[n] = 1;
  return labels;
}

py::array_t<std::int32_t> segmentsOf(std::size_t count, const Result& result) {
  py::array_t<std::int32_t> segments = filled<std::int32_t>(count, 0);
  for (std::size_t k = 0; k < result.clusters.size(); ++k)
    for (const pcl::index_t n : result.clusters[k].indices)
      segments.mutable_data()[n] = static_cast<std::int32_t>(k + 1);
  return segments;
}

/// What the robust estimator chose from the data, with the reasons.
py::dict choicesOf(const Filter& filter) {
  py::dict choices;
  const auto* fft = dynamic_cast<const FFTGroundSegmentation<Point>*>(&filter);
  if (fft == nullptr) return choices;
  for (const core::RobustChoice& choice : fft->getChoices()) {
    py::dict entry;
    entry["value"] = choice.value;
    entry["reason"] = choice.reason;
    choices[py::str(choice.parameter)] = entry;
  }
  return choices;
}

/// The filter's warnings, and that of no segment.
std::vector<std::string> warningsOf(const Filter& filter, const Result& result, unsigned min_cluster_size) {
  std::vector<std::string> warnings = filter.getWarnings();
  if (result.clusters.empty() && result.objects.indices.size() >= min_cluster_size)
    warnings.push_back("no segment has " + std::to_string(min_cluster_size) +
                       " points: a larger leaf_size or a smaller min_cluster_size may help");
  return warnings;
}

py::dict reportOf(const std::string& method, const Filter& filter, const PointArray& xyz,
                  const Result& result, unsigned min_cluster_size) {
  const std::size_t ground = result.ground.indices.size(), objects = result.objects.indices.size();
  py::dict report;
  report["version"] = PCL_FFT_GROUND_VERSION;
  report["method"] = method;
  report["points"] = xyz.points->size();
  report["ground"] = ground;
  report["objects"] = objects;
  report["neither"] = xyz.points->size() - ground - objects;
  report["far"] = filter.getFarPoints().size();
  report["segments"] = result.clusters.size();
  report["origin"] = std::vector<double>{xyz.origin.x(), xyz.origin.y(), xyz.origin.z()};
  report["chosen"] = choicesOf(filter);
  report["warnings"] = warningsOf(filter, result, min_cluster_size);
  return report;
}

void requireLength(const char* name, const std::optional<double>& length) {
  if (!length || (*length > 0 && std::isfinite(*length))) return;
  throw std::invalid_argument(std::string(name) + " = " + std::to_string(*length) +
                              ": must be a finite number of metres above 0");
}

bool isContactOnly(const std::optional<std::string>& clusters, const std::string& method) {
  if (!clusters) return method == "fft-lowpass";
  if (*clusters == "objects" || *clusters == "contact") return *clusters == "contact";
  throw std::invalid_argument("clusters = '" + *clusters + "': must be 'objects' or 'contact'");
}

Segmentation segment(const py::array& xyz, std::optional<double> max_object_size, const std::string& method,
                     const std::optional<std::string>& clusters, std::optional<double> leaf_size,
                     std::optional<double> min_object_size, unsigned min_cluster_size,
                     const std::optional<std::array<double, 3>>& sensor, const py::kwargs& options) {
  requireLength("leaf_size", leaf_size);
  requireLength("min_object_size", min_object_size);
  const bool contact_only = isContactOnly(clusters, method);
  py::dict settings(options);
  if (max_object_size) settings["max_object_size"] = *max_object_size;
  const std::unique_ptr<Filter> filter = makeFilter(method, settings);
  for (const auto& [key, value] : settings)
    throw py::type_error("segment() has no parameter '" + key.cast<std::string>() + "'");
  const PointArray points = toPoints(xyz, "xyz");
  if (sensor) filter->setSensorPosition(Eigen::Vector3d(sensor->data()) - points.origin);
  Result result;
  {
    const py::gil_scoped_release unlocked;
    result =
        run(*filter, points, {contact_only, leaf_size, min_object_size, max_object_size, min_cluster_size});
  }
  if (!filter->getError().empty()) throw std::runtime_error(filter->getError());
  Segmentation segmentation;
  const std::size_t count = points.points->size();
  segmentation.labels = labelsOf(count, result);
  segmentation.height = filled<double>(count, std::numeric_limits<double>::quiet_NaN());
  std::copy(result.heights.begin(), result.heights.end(), segmentation.height.mutable_data());
  segmentation.p_ground = filled<float>(result.ground_probability.size(), 0);
  std::copy(result.ground_probability.begin(), result.ground_probability.end(),
            segmentation.p_ground.mutable_data());
  segmentation.segments = segmentsOf(count, result);
  segmentation.surface = filter->getGroundSurface();
  segmentation.surface.frame_from_input.translate(-points.origin);
  segmentation.report = reportOf(method, *filter, points, result, min_cluster_size);
  return segmentation;
}

}  // namespace
}  // namespace pcl_fft_ground::python

PYBIND11_MODULE(pcl_fft_ground, module) {
  namespace py = pybind11;
  using namespace pcl_fft_ground;
  using namespace pcl_fft_ground::python;

  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // what it would say is raised or reported
  module.doc() = "Ground segmentation of 3D scans in the frequency domain.";
  module.attr("__version__") = PCL_FFT_GROUND_VERSION;

  py::class_<core::GroundSurface>(module, "Surface", R"(Height of the ground over a grid.

Row i, column j of the arrays is the cell whose centre lies at lower_corner + cell_size * (i + 0.5, j + 0.5) in
the level frame; frame_from_input brings points there, its z axis is up.)")
      .def_property_readonly(
          "height", [](const core::GroundSurface& s) { return s.height; },
          "height of the ground in the level frame [m], rows x cols")
      .def_property_readonly(
          "uncertainty", [](const core::GroundSurface& s) { return s.uncertainty; },
          "standard deviation to be expected of the height [m]; 0 x 0 if not known")
      .def_property_readonly(
          "supported", [](const core::GroundSurface& s) { return s.supported; },
          "whether ground was seen nearby; 0 x 0 if not known")
      .def_property_readonly(
          "cell_size", [](const core::GroundSurface& s) { return s.geometry.cell_size; },
          "side of a cell [m]")
      .def_property_readonly(
          "lower_corner", [](const core::GroundSurface& s) { return s.geometry.origin; },
          "corner of the first cell in the level frame [m]")
      .def_property_readonly(
          "frame_from_input", [](const core::GroundSurface& s) { return s.frame_from_input.matrix(); },
          "4 x 4, from the coordinates of the points to the level frame");

  py::class_<Segmentation>(module, "Segmentation", "What segment() found.")
      .def_readonly("labels", &Segmentation::labels,
                    "int32, one for each point: 0 ground, 1 object, 2 neither (not finite)")
      .def_readonly("height", &Segmentation::height,
                    "height above the ground [m], one for each point; NaN where it is not finite")
      .def_readonly(
          "p_ground", &Segmentation::p_ground,
          "float32, how likely each point is ground, 0 to 1, by the robust estimator; NaN where it is "
          "not finite, empty with other methods")
      .def_readonly("segments", &Segmentation::segments,
                    "int32, number of the point's segment, from 1 by falling size; 0 none")
      .def_readonly("surface", &Segmentation::surface, "the ground, a Surface")
      .def_readonly("report", &Segmentation::report,
                    "dict: counts, what was chosen from the data and why, warnings");

  module.def("segment", &segment, py::arg("xyz"), py::arg("max_object_size") = py::none(), py::kw_only(),
             py::arg("method") = "fft", py::arg("clusters") = py::none(), py::arg("leaf_size") = py::none(),
             py::arg("min_object_size") = py::none(), py::arg("min_cluster_size") = 10U,
             py::arg("sensor") = py::none(), R"(Tells ground from objects, and the objects from each other.

xyz: N x 3 float32 or float64 [m], strided views too; what is not finite is neither ground nor object.
max_object_size: size of the largest object [m]; half of the scan's smaller extent if None.
method: 'fft' (robust), 'fft-lowpass' (as published), 'naive', 'planar', 'grid' or 'graph-cut'.
clusters: 'objects' tells touching objects apart, 'contact' does not; objects if None (fft-lowpass: contact).
leaf_size: side of the voxels that form segments [m]; the cell size if None.
min_object_size: smallest object that is told apart from what it touches [m]; a share of the largest if None.
min_cluster_size: points of the smallest segment.
threads: how many share the work, 0 (one for each core) if None; the results are the same for every number.
sensor: where the sensor stood, three numbers in the coordinates of xyz: on the upper side of the ground.

Other keyword arguments are the command's options with _ in place of -: cell_size, height_tolerance,
up_direction (three numbers), up_estimation, yaw, relative_max_object_size, filter_order, passband_ripple,
max_slope, finest_wavelength, cell_statistic, cutoff_frequency, peak_window, peak_threshold,
distance_threshold, max_iterations, probability, optimize_coefficients, plane_seed, voxel_height,
object_height, step_height, smoothness.

Returns a Segmentation. Raises ValueError naming the parameter, its value and what is allowed, TypeError for
an unknown parameter, RuntimeError where the method cannot work on these points. The labels are those of the
command, bit for bit. Other Python threads run on meanwhile.)");

#ifdef PCL_FFT_GROUND_WITH_REGISTRATION
  defineAlignment(module);
#endif
}
