#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "box_scene.h"
#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/graph_cut_ground_segmentation.h"
#include "pcl_fft_ground/grid_ground_segmentation.h"
#include "pcl_fft_ground/naive_ground_segmentation.h"
#include "pcl_fft_ground/planar_ground_segmentation.h"

namespace pcl_fft_ground {
namespace {

using Point = pcl::PointXYZ;
using Fft = FFTGroundSegmentation<Point>;
using GraphCut = GraphCutGroundSegmentation<Point>;
using Grid = GridGroundSegmentation<Point>;
using Naive = NaiveGroundSegmentation<Point>;
using Planar = PlanarGroundSegmentation<Point>;
using Filter = std::unique_ptr<GroundSegmentation<Point>>;

constexpr double LEAST = std::numeric_limits<double>::min(), MOST = std::numeric_limits<double>::max();

/// A parameter of a filter at one end of its documented range.
struct End {
  std::string name;
  std::function<Filter()> make;
};

void PrintTo(const End& end, std::ostream* out) {
  *out << end.name;
}

template <typename Method, typename Setter>
End endOf(const std::string& name, Setter setter) {
  return {name, [setter] {
            auto filter = std::make_unique<Method>();
            setter(*filter);
            return Filter(std::move(filter));
          }};
}

/// Both ends of a number's range.
template <typename Method, typename Number, typename Setter>
void addEnds(std::vector<End>& ends, const std::string& name, Number low, Number high, Setter setter) {
  for (const Number value : {low, high})
    ends.push_back(
        endOf<Method>(name + " " + std::to_string(value), [=](Method& filter) { setter(filter, value); }));
}

template <typename Method, typename Setter>
void addLength(std::vector<End>& ends, const std::string& name, Setter setter) {
  addEnds<Method>(ends, name, LEAST, MOST, setter);
  addEnds<Method>(ends, name, 1e-16, 1e16, setter);
}

Fft& lowPass(Fft& filter) {
  filter.setEstimator(Estimator::LOW_PASS);
  return filter;
}

std::vector<End> allEnds() {
  std::vector<End> ends;
  addLength<Fft>(ends, "robust cell size", [](Fft& f, double v) { f.setCellSize(v); });
  addLength<Fft>(ends, "robust maximum object size", [](Fft& f, double v) { f.setMaximumObjectSize(v); });
  addLength<Fft>(ends, "finest wavelength", [](Fft& f, double v) { f.setFinestWavelength(v); });
  addEnds<Fft>(ends, "relative maximum object size", LEAST, 1.0,
               [](Fft& f, double v) { f.setRelativeMaximumObjectSize(v); });
  addEnds<Fft>(ends, "robust filter order", 1U, 100U, [](Fft& f, unsigned v) { f.setFilterOrder(v); });
  addEnds<Fft>(ends, "robust filter order", 48U, 60U, [](Fft& f, unsigned v) { f.setFilterOrder(v); });
  addEnds<Fft>(ends, "robust passband ripple", LEAST, 100.0,
               [](Fft& f, double v) { f.setPassbandRipple(v); });
  addEnds<Fft>(ends, "robust passband ripple at order 100", LEAST, 100.0, [](Fft& f, double v) {
    f.setPassbandRipple(v);
    f.setFilterOrder(100);
  });
  addEnds<Fft>(ends, "maximum slope", 0.0, MOST, [](Fft& f, double v) { f.setMaximumSlope(v); });
  addEnds<Fft>(ends, "maximum slope", LEAST, 1e16, [](Fft& f, double v) { f.setMaximumSlope(v); });
  addEnds<Fft>(ends, "robust height tolerance", -MOST, MOST,
               [](Fft& f, double v) { f.setHeightTolerance(v); });
  addEnds<Fft>(ends, "robust up", -MOST, MOST, [](Fft& f, double v) { f.setUpDirection({v, v, v}); });
  addEnds<Fft>(ends, "robust up", -LEAST, LEAST, [](Fft& f, double v) { f.setUpDirection({0, 0, v}); });
  addEnds<Fft>(ends, "sensor position", -MOST, MOST, [](Fft& f, double v) {
    f.setSensorPosition({v, v, v});
  });

  addLength<Fft>(ends, "low-pass cell size", [](Fft& f, double v) { lowPass(f).setCellSize(v); });
  addLength<Fft>(ends, "low-pass maximum object size",
                 [](Fft& f, double v) { lowPass(f).setMaximumObjectSize(v); });
  addEnds<Fft>(ends, "low-pass filter order", 1U, 100U,
               [](Fft& f, unsigned v) { lowPass(f).setFilterOrder(v); });
  addEnds<Fft>(ends, "low-pass passband ripple", LEAST, 100.0,
               [](Fft& f, double v) { lowPass(f).setPassbandRipple(v); });
  addEnds<Fft>(ends, "cut-off frequency", LEAST, M_SQRT2,
               [](Fft& f, double v) { lowPass(f).setCutoffFrequency(v); });
  addEnds<Fft>(ends, "cut-off frequency at order 100", LEAST, M_SQRT2, [](Fft& f, double v) {
    lowPass(f).setCutoffFrequency(v);
    f.setFilterOrder(100);
  });
  addEnds<Fft>(ends, "peak window", 1U, 1000U, [](Fft& f, unsigned v) { lowPass(f).setPeakWindow(v); });
  addEnds<Fft>(ends, "peak threshold", 0.0, MOST, [](Fft& f, double v) { lowPass(f).setPeakThreshold(v); });

  addLength<GraphCut>(ends, "graph-cut cell size", [](GraphCut& f, double v) { f.setCellSize(v); });
  addLength<GraphCut>(ends, "graph-cut maximum object size",
                      [](GraphCut& f, double v) { f.setMaximumObjectSize(v); });
  addLength<GraphCut>(ends, "object height", [](GraphCut& f, double v) { f.setObjectHeight(v); });
  addLength<GraphCut>(ends, "step height", [](GraphCut& f, double v) { f.setStepHeight(v); });
  addEnds<GraphCut>(ends, "smoothness", 0.0, MOST, [](GraphCut& f, double v) { f.setSmoothness(v); });

  addLength<Grid>(ends, "grid cell size", [](Grid& f, double v) { f.setCellSize(v); });
  addLength<Grid>(ends, "voxel height", [](Grid& f, double v) { f.setVoxelHeight(v); });
  addEnds<Naive>(ends, "naive height tolerance", -MOST, MOST,
                 [](Naive& f, double v) { f.setHeightTolerance(v); });
  addLength<Planar>(ends, "distance threshold", [](Planar& f, double v) { f.setDistanceThreshold(v); });
  addEnds<Planar>(ends, "most planes", 1, std::numeric_limits<int>::max(),
                  [](Planar& f, int v) { f.setMaxIterations(v); });
  addEnds<Planar>(ends, "probability", LEAST, std::nextafter(1.0, 0.0),
                  [](Planar& f, double v) { f.setProbability(v); });
  return ends;
}

pcl::PointCloud<Point>::Ptr boxCloud() {
  const test::Scene scene = test::boxScene();
  pcl::PointCloud<Point>::Ptr cloud(new pcl::PointCloud<Point>);
  for (Eigen::Index n = 0; n < scene.points.cols(); ++n)
    cloud->push_back(Point(scene.points(0, n), scene.points(1, n), scene.points(2, n)));
  return cloud;
}

/// Each point is ground or object; a surface is a number everywhere, or the filter says what is wrong.
void expectSane(GroundSegmentation<Point>& filter, const pcl::PointCloud<Point>::ConstPtr& cloud) {
  pcl::PointIndices ground, objects;
  filter.setInputCloud(cloud);
  filter.segment(ground, objects);
  EXPECT_EQ(ground.indices.size() + objects.indices.size(), cloud->size());
  const core::GroundSurface& surface = filter.getGroundSurface();
  EXPECT_TRUE(surface.height.allFinite());
  if (filter.getError().empty())
    EXPECT_GT(surface.height.size(), 0);
  else
    EXPECT_EQ(ground.indices.size(), cloud->size()) << filter.getError();
}

class ParameterEnds : public testing::TestWithParam<End> {};
INSTANTIATE_TEST_SUITE_P(All, ParameterEnds, testing::ValuesIn(allEnds()));

TEST_P(ParameterEnds, GiveSaneLabels) {
  SCOPED_TRACE(GetParam().name);
  const Filter filter = GetParam().make();
  expectSane(*filter, boxCloud());
}

class FilterOrders : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(All, FilterOrders, testing::Values(4U, 20U, 47U, 48U, 60U, 100U));

TEST_P(FilterOrders, FindTheBoxes) {
  Fft filter;
  filter.setMaximumObjectSize(1);
  filter.setFilterOrder(GetParam());
  const test::Scene scene = test::boxScene();
  pcl::PointIndices ground, objects;
  filter.setInputCloud(boxCloud());
  filter.segment(ground, objects);
  std::size_t wrong = 0;
  for (const pcl::index_t n : ground.indices) wrong += scene.is_object[static_cast<std::size_t>(n)] ? 1 : 0;
  for (const pcl::index_t n : objects.indices) wrong += scene.is_object[static_cast<std::size_t>(n)] ? 0 : 1;
  EXPECT_LT(wrong, scene.is_object.size() / 50);
}

class HugeCoordinates : public testing::TestWithParam<float> {};
INSTANTIATE_TEST_SUITE_P(All, HugeCoordinates, testing::Values(1e15F, 1e18F, 1e25F, 3e38F));

TEST_P(HugeCoordinates, AreFarPoints) {
  const pcl::PointCloud<Point>::Ptr cloud = boxCloud();
  cloud->push_back(Point(GetParam(), 0, 0));
  cloud->push_back(Point(0, -GetParam(), GetParam()));
  for (const auto& make : {+[]() -> Filter { return std::make_unique<Fft>(); },
                           +[]() -> Filter { return std::make_unique<GraphCut>(); },
                           +[]() -> Filter { return std::make_unique<Grid>(); },
                           +[]() -> Filter { return std::make_unique<Planar>(); }}) {
    const Filter filter = make();
    expectSane(*filter, cloud);
    EXPECT_EQ(filter->getFarPoints().size(), 2U);
    EXPECT_TRUE(filter->getError().empty()) << filter->getError();
  }
}

TEST_P(HugeCoordinates, OfAWholeScanAreDefined) {
  const pcl::PointCloud<Point>::Ptr cloud = boxCloud();
  for (Point& p : *cloud)
    p = Point(p.x * 0.1F * GetParam(), p.y * 0.1F * GetParam(), p.z * 0.1F * GetParam());
  for (const auto& make : {+[]() -> Filter { return std::make_unique<Fft>(); },
                           +[]() -> Filter { return std::make_unique<GraphCut>(); },
                           +[]() -> Filter { return std::make_unique<Naive>(); }}) {
    const Filter filter = make();
    pcl::PointIndices ground, objects;
    filter->setInputCloud(cloud);
    filter->segment(ground, objects);
    EXPECT_EQ(ground.indices.size() + objects.indices.size(), cloud->size());
    EXPECT_TRUE(filter->getGroundSurface().height.allFinite());
  }
}

}  // namespace
}  // namespace pcl_fft_ground
