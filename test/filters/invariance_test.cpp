// What must not change the labels: place, direction, unit, order, repetition and mirroring of a scan.

#include <gtest/gtest.h>
#include <pcl/console/print.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "clouds.h"
#include "every_method.h"
#include "message_cloud.h"
#include "pcl_fft_ground/object_cluster_extraction.h"
#include "pcl_fft_ground/simulation/simulation.h"
#include "pcl_fft_ground/voxel_cluster_extraction.h"
#include "random_points.h"

namespace pcl_fft_ground::test {
namespace {

using Point = pcl::PointXYZ;
using Message = MessageCloud<WidePoint>;
using Places = Eigen::Matrix3Xd;

/// Coordinates are multiples of this length [m]: whole metres, powers of two and quarter turns are exact in
/// float.
constexpr double STEP = 1.0 / 4096;

/// A simulated scan whose kind, share of objects, gaps, outliers and tilt hang on the seed.
Places scene(unsigned seed) {
  std::mt19937 random(seed);
  core::SimulationParameters parameters;
  constexpr std::array<core::SceneKind, 3> KINDS{core::SceneKind::WRECK, core::SceneKind::PIPES,
                                                 core::SceneKind::REEF};
  parameters.scene = KINDS[seed % KINDS.size()];
  parameters.seed = seed;
  parameters.points = 3000 + random() % 3000;
  parameters.object_share = uniform(random, 0, 0.6);
  parameters.noise = uniform(random, 0, 0.01);
  parameters.gap_share = random() % 2 ? uniform(random, 0, 0.5) : 0;
  parameters.outlier_share = random() % 3 ? 0 : 0.01;
  parameters.tilt_degrees = random() % 2 ? uniform(random, -15, 15) : 0;
  return (core::simulateScan(parameters).points.cast<double>() / STEP).array().round() * STEP;
}

/// 1 object, 0 ground, -1 neither.
template <typename PointT, typename Cloud>
std::vector<int> labelsOf(GroundSegmentation<PointT>& segmenter, const Cloud& cloud, std::size_t size) {
  segmenter.setInputCloud(cloud);
  pcl::PointIndices ground, objects;
  segmenter.segment(ground, objects);
  EXPECT_EQ(segmenter.getError(), "");
  std::vector<int> labels(size, -1);
  for (const pcl::index_t n : ground.indices) labels[static_cast<std::size_t>(n)] = 0;
  for (const pcl::index_t n : objects.indices) labels[static_cast<std::size_t>(n)] = 1;
  return labels;
}

std::vector<int> labelsOf(const Method<Point>& method, const Places& places, double unit = 1) {
  const auto segmenter = method.make(unit);
  return labelsOf(*segmenter, cloudOf<Point>(Eigen::Matrix3Xf(places.cast<float>())),
                  static_cast<std::size_t>(places.cols()));
}

std::vector<int> labelsInDouble(const Method<pcl::PCLPointCloud2>& method, const Places& places) {
  const auto cloud = pcl::make_shared<Message>();
  cloud->resize(static_cast<std::size_t>(places.cols()));
  for (Eigen::Index n = 0; n < places.cols(); ++n) {
    WidePoint& p = (*cloud)[static_cast<std::size_t>(n)];
    p.x = places(0, n);
    p.y = places(1, n);
    p.z = places(2, n);
  }
  const auto segmenter = method.make(1);
  return labelsOf(*segmenter, pcl::PCLPointCloud2::ConstPtr(cloud), static_cast<std::size_t>(places.cols()));
}

std::size_t differences(const std::vector<int>& a, const std::vector<int>& b) {
  EXPECT_EQ(a.size(), b.size());
  return std::inner_product(a.begin(), a.end(), b.begin(), std::size_t{0}, std::plus<>(),
                            std::not_equal_to<>());
}

/// How many labels may change.
struct Bound {
  double mean;   ///< share of the points of all scenes that may change [%]
  double worst;  ///< and of any one scene [%]
};

constexpr Bound NOTHING{0, 0};

/// More scenes by the variable PCL_FFT_GROUND_SEEDS.
class Invariance : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    verbosity_ = pcl::console::getVerbosityLevel();
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  }
  void TearDown() override { pcl::console::setVerbosityLevel(verbosity_); }

  static unsigned scenes() {
    const char* const wanted = std::getenv("PCL_FFT_GROUND_SEEDS");
    return wanted != nullptr ? static_cast<unsigned>(std::atoi(wanted)) : 9;
  }

  template <typename PointT = Point>
  static Method<PointT> method() {
    for (const Method<PointT>& each : everyMethod<PointT>())
      if (each.name == GetParam()) return each;
    throw std::logic_error(GetParam());
  }

  /// \param law the number of labels that change, given the places of a scene and its seed
  template <typename Law>
  void expectInvariance(const Bound& bound, const Law& law) {
    double points = 0, changed = 0;
    for (unsigned seed = 0; seed < scenes(); ++seed) {
      const Places places = scene(seed);
      const auto count = static_cast<double>(places.cols());
      const auto differences = static_cast<double>(law(places, seed));
      EXPECT_LE(100 * differences / count, bound.worst) << GetParam() << ", seed " << seed;
      points += count;
      changed += differences;
    }
    EXPECT_LE(100 * changed / points, bound.mean) << GetParam();
    RecordProperty("changed_percent", std::to_string(100 * changed / points));
  }

 private:
  pcl::console::VERBOSITY_LEVEL verbosity_ = pcl::console::L_INFO;
};

std::vector<std::string> methodNames() {
  std::vector<std::string> names;
  for (const Method<Point>& method : everyMethod<Point>()) names.push_back(method.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Methods, Invariance, testing::ValuesIn(methodNames()));

TEST_P(Invariance, Translation) {
  expectInvariance(NOTHING, [](const Places& places, unsigned) {
    const Places moved = places.colwise() + Eigen::Vector3d(512, -300, 77);
    return differences(labelsOf(method(), places), labelsOf(method(), moved));
  });
}

TEST_P(Invariance, TranslationToUtmInDouble) {
  const auto wide = method<pcl::PCLPointCloud2>();
  expectInvariance(NOTHING, [&](const Places& places, unsigned) {
    const Places moved = places.colwise() + Eigen::Vector3d(499937.25, 5999871.75, 1234.5);
    return differences(labelsInDouble(wide, places), labelsInDouble(wide, moved));
  });
}

TEST_P(Invariance, Permutation) {
  expectInvariance(NOTHING, [](const Places& places, unsigned seed) {
    std::mt19937 random(seed);
    const std::vector<Eigen::Index> order = randomOrder(places.cols(), random);
    const std::vector<int> in_order = labelsOf(method(), places);
    std::vector<int> expected;
    for (const Eigen::Index n : order) expected.push_back(in_order[static_cast<std::size_t>(n)]);
    return differences(expected, labelsOf(method(), Places(places(Eigen::all, order))));
  });
}

// With powers of two nothing is rounded: no length of the method's own is left.
TEST_P(Invariance, ScalingFromAMillimetreToAKilometre) {
  expectInvariance(NOTHING, [](const Places& places, unsigned) {
    std::size_t most = 0;
    const std::vector<int> expected = labelsOf(method(), places);
    for (const double scale : {1.0 / 1024, 1.0 / 8, 16.0, 1024.0})
      most = std::max(most, differences(expected, labelsOf(method(), places * scale, scale)));
    return most;
  });
}

// The mean of all points twice is the mean; so are highest and lowest points. PCL's plane draws other
// samples, and the robust estimator sees more points in a cell, which decides how many it trusts, and another
// spacing.
TEST_P(Invariance, Duplication) {
  if (GetParam() == "planar") GTEST_SKIP() << "PCL draws random points";
  const bool takes_extremes = GetParam() == "low-pass" || GetParam() == "grid" || GetParam() == "naive";
  expectInvariance(takes_extremes ? NOTHING : Bound{3, 10}, [](const Places& places, unsigned) {
    Places twice(3, 2 * places.cols());
    twice << places, places;
    std::vector<int> labels = labelsOf(method(), twice);
    const auto half = labels.begin() + places.cols();
    EXPECT_TRUE(std::equal(labels.begin(), half, half)) << "copies differ";
    labels.erase(half, labels.end());
    return differences(labelsOf(method(), places), labels);
  });
}

// A turn or a mirror moves the borders of the cells among the points: cells begin at one corner of the
// rectangle around them. That bounds the methods that look at cells; published ones, which have no tolerance,
// more than the robust one.
Bound boundOfCells(const std::string& method) {
  if (method == "naive") return NOTHING;
  return method.rfind("robust", 0) == 0 ? Bound{1, 4} : Bound{15, 35};
}

TEST_P(Invariance, Reflection) {
  if (GetParam() == "planar") GTEST_SKIP() << "PCL draws random points";
  expectInvariance(boundOfCells(GetParam()), [](const Places& places, unsigned) {
    Places mirrored = places;
    mirrored.row(0) *= -1;
    return differences(labelsOf(method(), places), labelsOf(method(), mirrored));
  });
}

TEST_P(Invariance, RotationAboutUp) {
  if (GetParam() == "planar") GTEST_SKIP() << "PCL draws random points";
  expectInvariance(boundOfCells(GetParam()), [](const Places& places, unsigned seed) {
    std::mt19937 random(seed);
    const Eigen::AngleAxisd turn(uniform(random, 0, 2 * M_PI), Eigen::Vector3d::UnitZ());
    return differences(labelsOf(method(), places), labelsOf(method(), turn.toRotationMatrix() * places));
  });
}

/// Cluster numbers of the points.
template <typename Extraction>
std::vector<int> clustersOf(Extraction extraction, const Places& places, double unit) {
  std::vector<pcl::PointIndices> clusters;
  extraction.setLeafSize(0.125 * unit);
  extraction.setMinClusterSize(5);
  extraction.setInputCloud(cloudOf<Point>(Eigen::Matrix3Xf(places.cast<float>())));
  extraction.extract(clusters);
  std::vector<int> numbers(static_cast<std::size_t>(places.cols()), 0);
  for (std::size_t k = 0; k < clusters.size(); ++k)
    for (const pcl::index_t n : clusters[k].indices)
      numbers[static_cast<std::size_t>(n)] = static_cast<int>(k) + 1;
  return numbers;
}

TEST(InvarianceOfClusters, Scaling) {
  for (unsigned seed = 0; seed < 20; ++seed)
    for (const double scale : {1.0 / 1024, 1024.0}) {
      const Places places = scene(seed);
      EXPECT_EQ(clustersOf(VoxelClusterExtraction<Point>(), places, 1),
                clustersOf(VoxelClusterExtraction<Point>(), places * scale, scale))
          << seed;
      EXPECT_EQ(clustersOf(ObjectClusterExtraction<Point>(), places, 1),
                clustersOf(ObjectClusterExtraction<Point>(), places * scale, scale))
          << seed;
    }
}

}  // namespace
}  // namespace pcl_fft_ground::test
