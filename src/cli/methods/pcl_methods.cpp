// The ground filters that PCL has itself, to compare with: run as they are, in a process of their own.

#include <pcl/segmentation/approximate_progressive_morphological_filter.h>
#include <pcl/segmentation/progressive_morphological_filter.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "command_line.h"
#include "methods/method.h"
#include "pcl_fft_ground/core/grid/elevation_grid.h"
#include "separate_process.h"

namespace pcl_fft_ground::cli {
namespace {

namespace po = boost::program_options;

constexpr double DEFAULT_TIME_LIMIT = 60;  // [s]

/// Settings of PCL's two morphological filters; the values are PCL's defaults.
struct MorphologyParameters {
  unsigned max_window_size = 33;   ///< largest window; [cells], of the exact filter [m]; >= 1
  double slope = 0.7;              ///< of the ground, >= 0
  double initial_distance = 0.15;  ///< height above the first opening that still is ground [m], > 0
  double max_distance = 10;        ///< the same above any opening [m], > 0
  double cell_size = 1;            ///< [m], > 0
  double base = 2;                 ///< of the growth of the windows, > 1; linear growth: >= 1
  bool exponential = true;         ///< whether the windows grow exponentially
};

/** Runs a filter in a process of its own. \return the indices that it gives
 * \throws std::runtime_error saying what became of it
 */
template <typename Filter>
pcl::Indices indicesOf(const Filter& filter, double time_limit) {
  const Outcome outcome = runApart(
      [&] {
        const pcl::Indices ground = filter();
        return std::string(reinterpret_cast<const char*>(ground.data()),
                           ground.size() * sizeof(pcl::index_t));
      },
      time_limit);
  std::ostringstream reason;
  if (outcome.end == End::OUT_OF_TIME)
    reason << "not run: more than " << time_limit << " s (--pcl-time-limit)";
  if (outcome.end == End::CRASHED)
    reason << "not run: PCL's filter crashed (signal " << outcome.signal << ")";
  if (outcome.end == End::OUT_OF_MEMORY) reason << "not run: PCL's filter ran out of memory";
  if (!reason.str().empty()) throw std::runtime_error(reason.str());
  pcl::Indices ground(outcome.bytes.size() / sizeof(pcl::index_t));
  std::copy_n(outcome.bytes.data(), outcome.bytes.size(), reinterpret_cast<char*>(ground.data()));
  return ground;
}

/** A ground filter of PCL's behind our interface, which takes out what they cannot bear: points that are not
 * finite (they crash on them) and such as are far from all others (their grids would fill the memory).
 */
class PclGroundFilter : public GroundSegmentation<Point> {
 public:
  void setTimeLimit(double seconds) {
    requireParameter(std::isfinite(seconds) && seconds > 0 && seconds <= 1e6, "time limit", seconds,
                     "a number of seconds above 0, at most 1e6");
    time_limit_ = seconds;
  }
  double getTimeLimit() const { return time_limit_; }

  /// Without cells: these filters have none.
  const core::GroundSurface& getGroundSurface() const override { return surface_; }

 protected:
  explicit PclGroundFilter(const char* name)
      : GroundSegmentation<Point>(name, {{}, UpEstimation::GIVEN, Yaw::NONE, {}}, false) {}

  /// Indices of the ground, as PCL's filter gives them; run in a process of its own.
  virtual pcl::Indices groundOf(const pcl::PointCloud<Point>::ConstPtr& cloud) const = 0;

  /// Throws std::exception where PCL's filter cannot work on the points.
  virtual void check(const core::Points& /*points*/) const {}

  core::Labels labelPoints(const core::Points& points, const Eigen::Isometry3d&) override {
    if (points.cols() == 0) return {};
    check(points);
    const pcl::PointCloud<Point>::Ptr cloud(new pcl::PointCloud<Point>);
    for (Eigen::Index n = 0; n < points.cols(); ++n)
      cloud->push_back({points(0, n), points(1, n), points(2, n)});
    const pcl::Indices ground = indicesOf([&] { return groundOf(cloud); }, time_limit_);
    core::Labels labels(cloud->size(), core::Label::OBJECT);
    for (const pcl::index_t n : ground) labels.at(static_cast<std::size_t>(n)) = core::Label::GROUND;
    return labels;
  }

 private:
  double time_limit_ = DEFAULT_TIME_LIMIT;
  core::GroundSurface surface_;
};

/// \tparam FilterT one of PCL's two progressive morphological filters
template <template <typename> class FilterT>
class Morphology : public PclGroundFilter {
 public:
  explicit Morphology(const char* name) : PclGroundFilter(name) {}

  void setParameters(const MorphologyParameters& parameters) {
    const MorphologyParameters& p = parameters;
    requireParameter(p.max_window_size >= 1 && p.max_window_size <= 1000000, "largest window",
                     p.max_window_size, "in [1, 1e6]");
    requireParameter(std::isfinite(p.slope) && p.slope >= 0, "slope", p.slope,
                     "a finite number of at least 0");
    requireLength("initial distance", p.initial_distance);
    requireLength("maximum distance", p.max_distance);
    requireLength("cell size", p.cell_size);
    // With exponents of 1 PCL's windows would never grow, and it would never end.
    const double least = p.exponential ? 1.1 : 1;
    requireParameter(p.base >= least && p.base <= 1000, "base", p.base,
                     p.exponential ? "in [1.1, 1000]" : "in [1, 1000]");
    parameters_ = parameters;
  }
  const MorphologyParameters& getParameters() const { return parameters_; }

 protected:
  void check(const core::Points& points) const override {
    core::gridAround(core::boundsOf(points), parameters_.cell_size);  // throws where there are too many cells
  }

  pcl::Indices groundOf(const pcl::PointCloud<Point>::ConstPtr& cloud) const override {
    FilterT<Point> filter;
    filter.setMaxWindowSize(static_cast<int>(parameters_.max_window_size));
    filter.setSlope(static_cast<float>(parameters_.slope));
    filter.setInitialDistance(static_cast<float>(parameters_.initial_distance));
    filter.setMaxDistance(static_cast<float>(parameters_.max_distance));
    filter.setCellSize(static_cast<float>(parameters_.cell_size));
    filter.setBase(static_cast<float>(parameters_.base));
    filter.setExponential(parameters_.exponential);
    // Other threads do not survive a fork.
    if constexpr (std::is_same_v<FilterT<Point>, pcl::ApproximateProgressiveMorphologicalFilter<Point>>)
      filter.setNumberOfThreads(1);
    filter.setInputCloud(cloud);
    pcl::Indices ground;
    filter.extract(ground);
    return ground;
  }

 private:
  MorphologyParameters parameters_;
};

/// The plane of pcl::SACSegmentation by MLESAC; what is on it is ground.
class MlesacPlane : public PclGroundFilter {
 public:
  MlesacPlane() : PclGroundFilter("pcl-mlesac-plane") {}

  /// Holds the settings, which are those of `planar`, the seed excepted.
  PlanarGroundSegmentation<Point>& settings() { return settings_; }

 protected:
  pcl::Indices groundOf(const pcl::PointCloud<Point>::ConstPtr& cloud) const override {
    pcl::SACSegmentation<Point> segmentation;
    segmentation.setModelType(pcl::SACMODEL_PLANE);
    segmentation.setMethodType(pcl::SAC_MLESAC);
    segmentation.setDistanceThreshold(settings_.getDistanceThreshold());
    segmentation.setMaxIterations(settings_.getMaxIterations());
    segmentation.setProbability(settings_.getProbability());
    segmentation.setOptimizeCoefficients(settings_.getOptimizeCoefficients());
    segmentation.setInputCloud(cloud);
    pcl::PointIndices ground;
    pcl::ModelCoefficients plane;
    segmentation.segment(ground, plane);
    return ground.indices;
  }

 private:
  PlanarGroundSegmentation<Point> settings_;
};

void setUpTimeLimit(PclGroundFilter& filter, ParameterSetter& parameters) {
  parameters.set<double>(
      "pcl-time-limit", [&](double v) { filter.setTimeLimit(v); }, [&] { return filter.getTimeLimit(); });
}

template <typename Filter>
void setUpMorphology(Filter& filter, ParameterSetter& parameters) {
  const auto set = [&](const char* option, auto MorphologyParameters::*member) {
    using Value = std::decay_t<decltype(MorphologyParameters().*member)>;
    const auto setter = [&, member](Value value) {
      MorphologyParameters changed = filter.getParameters();
      changed.*member = value;
      filter.setParameters(changed);
    };
    const auto getter = [&, member] { return filter.getParameters().*member; };
    if constexpr (std::is_same_v<Value, unsigned>)
      parameters.setCount(option, setter, getter);
    else if constexpr (std::is_same_v<Value, bool>)
      parameters.set<std::string>(
          option, [&](const std::string& v) { setter(valueNamed(option, v, SWITCH)); },
          [&] { return nameOf(getter(), SWITCH); });
    else
      parameters.set<Value>(option, setter, getter);
  };
  set("pmf-max-window-size", &MorphologyParameters::max_window_size);
  set("pmf-slope", &MorphologyParameters::slope);
  set("pmf-initial-distance", &MorphologyParameters::initial_distance);
  set("pmf-max-distance", &MorphologyParameters::max_distance);
  set("pmf-cell-size", &MorphologyParameters::cell_size);
  set("pmf-exponential", &MorphologyParameters::exponential);
  set("pmf-base", &MorphologyParameters::base);
  setUpTimeLimit(filter, parameters);
}

template <template <typename> class FilterT>
Segmenter makeMorphology(const char* name, const po::variables_map& values) {
  using Filter = Morphology<FilterT>;
  return segmenterWith(pcl::shared_ptr<Filter>(new Filter(name)), values, setUpMorphology<Filter>);
}

}  // namespace

Segmenter makePclPmf(const po::variables_map& values) {
  return makeMorphology<pcl::ProgressiveMorphologicalFilter>("pcl-pmf", values);
}

Segmenter makePclApproximatePmf(const po::variables_map& values) {
  return makeMorphology<pcl::ApproximateProgressiveMorphologicalFilter>("pcl-approximate-pmf", values);
}

Segmenter makePclMlesacPlane(const po::variables_map& values) {
  return segmenterWith(pcl::shared_ptr<MlesacPlane>(new MlesacPlane), values,
                       [](MlesacPlane& filter, ParameterSetter& parameters) {
                         setUpPlanar(filter.settings(), parameters);
                         setUpTimeLimit(filter, parameters);
                       });
}

void addPclOptions(po::options_description& options) {
  const auto number = [] { return po::value<double>(); };
  po::options_description pcl("PCL's own filters (pcl-pmf, pcl-approximate-pmf, pcl-mlesac-plane)",
                              HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add = pcl.add_options();
  add("pmf-max-window-size", po::value<long long>()->value_name("N"),
      "largest window, at least 1: in cells, of pcl-pmf in metres (33)");
  add("pmf-slope", number()->value_name("S"), "slope of the ground, at least 0 (0.7)");
  add("pmf-initial-distance", number()->value_name("M"),
      "height above the first opening up to which a point is ground [m], above 0 (0.15)");
  add("pmf-max-distance", number()->value_name("M"), "the same above any opening, at most [m], above 0 (10)");
  add("pmf-cell-size", number()->value_name("M"), "side of a cell [m], above 0 (1)");
  add("pmf-exponential", po::value<std::string>()->value_name("ON|OFF"),
      "whether the windows grow exponentially (on)");
  add("pmf-base", number()->value_name("B"), "of the growth of the windows, at least 1.1; off: 1 (2)");
  add("pcl-time-limit", number()->value_name("S"),
      "most seconds for a cloud, above 0: pcl-pmf takes time by the square of the points in a window (60)");
  options.add(pcl);
}

}  // namespace pcl_fft_ground::cli
