// The methods that the paper compares with, and the one that it leaves to future work.

#include "command_line.h"
#include "methods/method.h"
#include "pcl_fft_ground/graph_cut_ground_segmentation.h"
#include "pcl_fft_ground/grid_ground_segmentation.h"
#include "pcl_fft_ground/naive_ground_segmentation.h"
#include "pcl_fft_ground/planar_ground_segmentation.h"

namespace pcl_fft_ground::cli {
namespace {

namespace po = boost::program_options;

void setUpGrid(GridGroundSegmentation<Point>& grid, ParameterSetter& parameters) {
  parameters.set<double>(
      "cell-size", [&](double v) { grid.setCellSize(v); }, [&] { return grid.getCellSize(); });
  parameters.set<double>(
      "voxel-height", [&](double v) { grid.setVoxelHeight(v); }, [&] { return grid.getVoxelHeight(); });
}

void setUpGraphCut(GraphCutGroundSegmentation<Point>& cut, ParameterSetter& parameters) {
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

template <typename Filter, typename SetUp>
Segmenter make(const po::variables_map& values, const SetUp& set_up) {
  return segmenterWith(pcl::shared_ptr<Filter>(new Filter), values, set_up);
}

}  // namespace

void setUpPlanar(PlanarGroundSegmentation<Point>& planar, ParameterSetter& parameters) {
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

Segmenter makeNaive(const po::variables_map& values) {
  return make<NaiveGroundSegmentation<Point>>(values, [](auto&, ParameterSetter&) {});
}

Segmenter makePlanar(const po::variables_map& values) {
  return make<PlanarGroundSegmentation<Point>>(values, setUpPlanar);
}

Segmenter makeGrid(const po::variables_map& values) {
  return make<GridGroundSegmentation<Point>>(values, setUpGrid);
}

Segmenter makeGraphCut(const po::variables_map& values) {
  return make<GraphCutGroundSegmentation<Point>>(values, setUpGraphCut);
}

void addOtherOptions(po::options_description& options) {
  const auto number = [] { return po::value<double>(); };
  const auto count = [] { return po::value<long long>()->value_name("N"); };
  po::options_description others("Other methods", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add_other = others.add_options();
  add_other("distance-threshold", number()->value_name("M"),
            "planar, pcl-mlesac-plane: distance up to which a point lies on the plane [m], above 0 (0.02)");
  add_other("max-iterations", count(), "planar, pcl-mlesac-plane: most planes to try, at least 1 (1000)");
  add_other(
      "probability", number()->value_name("P"),
      "planar, pcl-mlesac-plane: probability of having tried a sample without outliers, in (0, 1) (0.99)");
  add_other("optimize-coefficients", po::value<std::string>()->value_name("ON|OFF"),
            "planar, pcl-mlesac-plane: on fits the plane to all of its inliers in the end (on)");
  add_other("plane-seed", count(), "planar: seed of the samples (1)");
  add_other("voxel-height", number()->value_name("M"), "grid: vertical size of a voxel [m], above 0 (0.02)");
  add_other(
      "object-height", number()->value_name("M"),
      "graph-cut: height above the lower surface where ground and object are equally likely [m] (0.05)");
  add_other("step-height", number()->value_name("M"),
            "graph-cut: height step between cells that makes a border likely [m] (0.02)");
  add_other("smoothness", number()->value_name("S"), "graph-cut: cost of a border, at least 0 (0.5)");
  options.add(others);
}

}  // namespace pcl_fft_ground::cli
