// align(): two overlapping scans, on arrays of points.
#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "pcl_fft_ground/segment_icp.h"
#include "point_array.h"
#include "segmentation_options.h"

namespace pcl_fft_ground::python {
namespace {

namespace py = pybind11;
using Point = pcl::PointXYZ;
using Place = std::array<double, 3>;

/// What align() returns.
struct AlignedScans {
  core::Alignment alignment;  ///< its transform takes the coordinates of the arrays
  Eigen::Vector3d origin;     ///< about which the covariance is, in the coordinates of the reference
};

/// What align() can be told besides the ground segmentation.
struct Settings {
  core::AlignmentParameters alignment;
  core::SegmentParameters segments;
};

/// Which of two words was given.
bool isFirst(py::handle given, const char* first, const char* second) {
  const auto word = given.cast<std::string>();
  if (word == first || word == second) return word == first;
  throw std::invalid_argument("'" + word + "': must be '" + first + "' or '" + second + "'");
}

using Setter = std::function<void(Settings&, py::handle)>;

/// A setting that is a number. \param of tells its place in the settings
template <typename Place>
Setter numberSetter(Place of) {
  return [of](Settings& settings, py::handle value) {
    auto& place = of(settings);
    place = value.cast<std::decay_t<decltype(place)>>();
  };
}

/// Settings by name, as the command's options are called; `search` first, as it sets those that follow.
const std::vector<std::pair<const char*, Setter>>& setters() {
  using S = Settings&;
  static const std::vector<std::pair<const char*, Setter>> table{
      {"search",
       [](S s, py::handle v) {
         s.alignment.gates = core::gatesOf(isFirst(v, "navigation", "wide") ? core::SearchMode::NAVIGATION
                                                                            : core::SearchMode::WIDE);
       }},
      {"matching",
       [](S s, py::handle v) {
         s.alignment.matching = isFirst(v, "local", "plain") ? core::Matching::LOCAL : core::Matching::PLAIN;
       }},
      {"fallback",
       [](S s, py::handle v) {
         s.alignment.fallback = isFirst(v, "dense", "none") ? core::Fallback::DENSE : core::Fallback::NONE;
       }},
      {"relief",
       [](S s, py::handle v) {
         s.alignment.relief = isFirst(v, "auto", "off") ? core::ReliefUse::AUTO : core::ReliefUse::OFF;
       }},
      {"max_shift", numberSetter([](S s) -> auto& { return s.alignment.gates.max_shift; })},
      {"max_turn", numberSetter([](S s) -> auto& { return s.alignment.gates.max_turn; })},
      {"min_matches", numberSetter([](S s) -> auto& { return s.alignment.min_matches; })},
      {"min_score", numberSetter([](S s) -> auto& { return s.alignment.min_score; })},
      {"max_sigma", numberSetter([](S s) -> auto& { return s.alignment.max_sigma; })},
      {"min_extent", numberSetter([](S s) -> auto& { return s.segments.min_extent; })},
      {"min_voxels", numberSetter([](S s) -> auto& { return s.segments.min_voxels; })},
      {"max_segments", numberSetter([](S s) -> auto& { return s.segments.max_segments; })},
      {"voxel_size", numberSetter([](S s) -> auto& { return s.segments.voxel_size; })}};
  return table;
}

/// Takes the settings of the alignment out of the options.
/// \throws std::invalid_argument (Python: ValueError) naming the parameter
Settings takeSettings(py::dict& options) {
  Settings settings;
  settings.alignment.relief = core::ReliefUse::AUTO;
  for (const auto& [name, set] : setters()) {
    if (!options.contains(name)) continue;
    const py::object value = options.attr("pop")(name);
    if (value.is_none()) continue;
    try {
      set(settings, value);
    } catch (const py::cast_error&) {
      throw std::invalid_argument(std::string(name) + " = " + std::string(py::repr(value)) +
                                  ": not of the right type");
    } catch (const std::invalid_argument& problem) {
      throw std::invalid_argument(std::string(name) + " = " + problem.what());
    }
  }
  core::validate(settings.alignment);
  core::validate(settings.segments);
  return settings;
}

/// \throws std::invalid_argument (Python: ValueError) if it is no rigid motion
Eigen::Isometry3d toRigidMotion(const py::object& given, const char* name) {
  const std::string wrong = std::string(name) + ": must be a rigid motion, a 4 x 4 array of finite numbers";
  const auto array = py::array_t<double, py::array::forcecast>::ensure(given);
  if (!array) {
    PyErr_Clear();
    throw std::invalid_argument(wrong);
  }
  if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4) throw std::invalid_argument(wrong);
  Eigen::Matrix4d matrix;
  for (Eigen::Index row = 0; row < 4; ++row)
    for (Eigen::Index column = 0; column < 4; ++column) matrix(row, column) = array.at(row, column);
  constexpr double FLOAT_ROUNDING = 1e-5;
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const bool is_rigid = matrix.allFinite() && rotation.determinant() > 0 &&
                        (rotation.transpose() * rotation).isIdentity(FLOAT_ROUNDING) &&
                        matrix.row(3).isApprox(Eigen::RowVector4d::UnitW(), FLOAT_ROUNDING);
  if (!is_rigid) throw std::invalid_argument(wrong);
  return Eigen::Translation3d(matrix.topRightCorner<3, 1>()) * Eigen::Quaterniond(rotation).normalized();
}

/// Where both sensors stood, or each: that of the reference first.
using SensorArgument = std::optional<std::variant<Place, std::array<Place, 2>>>;

/// Where the sensors stood, in the coordinates of the arrays, if it was told.
struct Sensors {
  std::optional<Eigen::Vector3d> reference, moving;
};

/// \throws std::invalid_argument (Python: ValueError) if they are not finite
Sensors toSensors(const SensorArgument& given) {
  if (!given) return {};
  const auto vector = [](const Place& place) {
    const Eigen::Vector3d sensor(place.data());
    if (!sensor.allFinite()) throw std::invalid_argument("sensor: must be finite numbers");
    return sensor;
  };
  if (const Place* both = std::get_if<Place>(&*given)) return {vector(*both), vector(*both)};
  const auto& each = std::get<std::array<Place, 2>>(*given);
  return {vector(each[0]), vector(each[1])};
}

AlignedScans align(const py::array& reference, const py::array& moving, const py::object& guess,
                   std::optional<double> max_object_size, const SensorArgument& sensor,
                   const py::kwargs& given) {
  py::dict options(given);
  const Settings settings = takeSettings(options);
  if (max_object_size) options["max_object_size"] = *max_object_size;
  const Filter::Ptr segmentation(makeFilter("fft", options));
  for (const auto& [key, value] : options)
    throw py::type_error("align() has no parameter '" + key.cast<std::string>() + "'");
  const Eigen::Isometry3d reference_from_moving =
      guess.is_none() ? Eigen::Isometry3d::Identity() : toRigidMotion(guess, "guess");
  const PointArray target = toPoints(reference, "reference"), source = toPoints(moving, "moving");

  const auto placedIn = [](const PointArray& points, const std::optional<Eigen::Vector3d>& place) {
    return place ? std::optional<Eigen::Vector3d>(*place - points.origin) : std::nullopt;
  };
  const Sensors sensors = toSensors(sensor);

  SegmentICP<Point, Point> icp;
  AlignedScans result;
  {
    const py::gil_scoped_release unlocked;
    icp.setNumberOfThreads(segmentation->getNumberOfThreads());
    icp.setAlignmentParameters(settings.alignment);
    icp.setSegmentParameters(settings.segments);
    icp.setGroundSegmentation(segmentation, segmentation);
    icp.setInputSource(source.points);
    icp.setSensorPosition(placedIn(source, sensors.moving), placedIn(target, sensors.reference));
    icp.setInputTarget(target.points);
    result.alignment = icp.computeAlignment(Eigen::Translation3d(-target.origin) * reference_from_moving *
                                            Eigen::Translation3d(source.origin));
  }
  if (!icp.getTargetError().empty()) throw std::runtime_error("reference: " + icp.getTargetError());
  if (!icp.getSourceError().empty()) throw std::runtime_error("moving: " + icp.getSourceError());
  Eigen::Isometry3d& found = result.alignment.reference_from_moving;
  found = Eigen::Translation3d(target.origin) * found * Eigen::Translation3d(-source.origin);
  result.origin = target.origin;
  return result;
}

}  // namespace

void defineAlignment(py::module_& module) {
  py::class_<AlignedScans>(module, "Alignment", "What align() found. A refusal is a result, too.")
      .def_property_readonly(
          "accepted", [](const AlignedScans& a) { return a.alignment.accepted; },
          "whether the scans were aligned with confidence")
      .def_property_readonly(
          "refusal", [](const AlignedScans& a) { return a.alignment.refusal; }, "why not; empty if they were")
      .def_property_readonly(
          "reference_from_moving",
          [](const AlignedScans& a) { return a.alignment.reference_from_moving.matrix(); },
          "4 x 4, from the coordinates of moving to those of reference; the guess where it was refused")
      .def_property_readonly(
          "covariance", [](const AlignedScans& a) { return a.alignment.covariance; },
          "6 x 6, of (translation [m], rotation vector [rad]) of a small motion after the transform, about "
          "origin")
      .def_readonly("origin", &AlignedScans::origin,
                    "in the coordinates of reference: 0 0 0, or whole metres where they are large")
      .def_property_readonly(
          "score", [](const AlignedScans& a) { return a.alignment.score; },
          "share of the object points seen by both scans that agree, 0 to 1")
      .def_property_readonly(
          "overlap", [](const AlignedScans& a) { return a.alignment.overlap; },
          "share of the smaller scan's area that both have seen, 0 to 1")
      .def_property_readonly(
          "method", [](const AlignedScans& a) { return nameOf(a.alignment.method); },
          "what the transform comes from: 'segments', 'dense', 'relief' or 'none'");

  module.def("align", &align, py::arg("reference"), py::arg("moving"), py::arg("guess") = py::none(),
             py::arg("max_object_size") = py::none(), py::arg("sensor") = py::none(),
             R"(Aligns two overlapping scans by the objects in them, or says why it does not.

reference, moving: N x 3 float32 or float64 [m], z roughly up, strided views too; what is not finite is left out.
guess: 4 x 4, reference_from_moving as far as it is known (navigation); no motion if None.
max_object_size: size of the largest object [m]; half of the scan's smaller extent if None.
sensor: where the sensors stood, three numbers for both or two times three, reference and moving: what a scan could
    have seen is then judged by ray.

Other keyword arguments are the command's options with _ in place of -:
search: 'navigation' (the guess is right to 0.6 m and 8 degrees) or 'wide' (to 2.5 m and 25).
matching: 'local', or 'plain': by the centroids and sizes of segments only.
fallback: 'dense' (ICP of all surfaces) or 'none', where segments do not suffice.
relief: 'auto' (the relief of bare ground) or 'off', where these do not suffice either.
max_shift, max_turn: largest correction of the guess, horizontally [m] and of the heading [degrees].
min_matches, min_score, max_sigma: fewer matched segments, a smaller share of agreeing points, a larger
predicted deviation [m] are refused.
min_extent, min_voxels, max_segments, voxel_size: which clusters become segments.
threads: how many share the work, 0 (one for each core) if None; the results are the same for every number.
All others set the ground segmentation as in segment(), method 'fft'.

Returns an Alignment, that of the command. Raises ValueError naming the parameter and what is allowed,
TypeError for an unknown parameter, RuntimeError where a scan cannot be worked on. Other Python threads run on
meanwhile.)");
}

}  // namespace pcl_fft_ground::python
