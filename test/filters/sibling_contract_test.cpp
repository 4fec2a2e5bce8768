// The contract on the benchmark methods and the graph cut.

#include <pcl/exceptions.h>
#include <pcl/point_types.h>

#include <limits>
#include <string>
#include <vector>

#include "contract_suite.h"
#include "sibling_traits.h"

namespace pcl_fft_ground::test {
using Siblings = testing::Types<
    Subject<NaiveGroundSegmentation, pcl::PointXYZ>, Subject<PlanarGroundSegmentation, pcl::PointXYZ>,
    Subject<GridGroundSegmentation, pcl::PointXYZ>, Subject<GraphCutGroundSegmentation, pcl::PointXYZ>>;
INSTANTIATE_TYPED_TEST_SUITE_P(Siblings, FilterContract, Siblings);

namespace {

/// Line 26 for a parameter: the value reads back, the others throw, naming the parameter, and change nothing.
template <typename Value, typename Segmenter>
void expectGuarded(Segmenter segmenter, void (Segmenter::*set)(Value), Value (Segmenter::*get)() const,
                   const std::string& name, Value valid, const std::vector<Value>& invalid_values) {
  (segmenter.*set)(valid);
  EXPECT_EQ((segmenter.*get)(), valid);
  for (const Value invalid : invalid_values) {
    try {
      (segmenter.*set)(invalid);
      ADD_FAILURE() << name << " accepts " << invalid;
    } catch (const pcl::PCLException& error) {
      EXPECT_NE(std::string(error.what()).find(name + " is "), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("must be"), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ((segmenter.*get)(), valid) << name;
}

const double NAN_VALUE = std::numeric_limits<double>::quiet_NaN();
const double INFINITE_VALUE = std::numeric_limits<double>::infinity();
const std::vector<double> NO_LENGTHS{0, -0.1, NAN_VALUE, INFINITE_VALUE};

TEST(SiblingParameters, Line26SettersReadBackAndRejectInvalidValues) {
  using Planar = PlanarGroundSegmentation<pcl::PointXYZ>;
  using Grid = GridGroundSegmentation<pcl::PointXYZ>;
  using Cut = GraphCutGroundSegmentation<pcl::PointXYZ>;
  expectGuarded(Planar(), &Planar::setDistanceThreshold, &Planar::getDistanceThreshold, "distance threshold",
                0.3, NO_LENGTHS);
  expectGuarded(Planar(), &Planar::setMaxIterations, &Planar::getMaxIterations, "number of iterations", 7,
                {0, -1});
  expectGuarded(Planar(), &Planar::setProbability, &Planar::getProbability, "probability", 0.5,
                {0, 1, -1, NAN_VALUE});
  expectGuarded(Grid(), &Grid::setCellSize, &Grid::getCellSize, "cell size", 0.3, NO_LENGTHS);
  expectGuarded(Grid(), &Grid::setVoxelHeight, &Grid::getVoxelHeight, "voxel height", 0.3, NO_LENGTHS);
  expectGuarded(Cut(), &Cut::setCellSize, &Cut::getCellSize, "cell size", 0.3, NO_LENGTHS);
  expectGuarded(Cut(), &Cut::setMaximumObjectSize, &Cut::getMaximumObjectSize, "maximum object size", 0.3,
                NO_LENGTHS);
  expectGuarded(Cut(), &Cut::setObjectHeight, &Cut::getObjectHeight, "object height", 0.3, NO_LENGTHS);
  expectGuarded(Cut(), &Cut::setStepHeight, &Cut::getStepHeight, "step height", 0.3, NO_LENGTHS);
  expectGuarded(Cut(), &Cut::setSmoothness, &Cut::getSmoothness, "smoothness", 0.0,
                {-0.1, NAN_VALUE, INFINITE_VALUE});
}

TEST(SiblingParameters, PlanarSeedAndRefinementReadBack) {
  PlanarGroundSegmentation<pcl::PointXYZ> planar;
  planar.setSeed(4294967295U);
  EXPECT_EQ(planar.getSeed(), 4294967295U);
  planar.setOptimizeCoefficients(false);
  EXPECT_FALSE(planar.getOptimizeCoefficients());
}

}  // namespace

}  // namespace pcl_fft_ground::test
