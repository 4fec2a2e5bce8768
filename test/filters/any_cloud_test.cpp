// Any floats at all: each finite point is ground or object, once and in order, and belongs to a cluster.

#include <gtest/gtest.h>
#include <pcl/console/print.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "clouds.h"
#include "every_method.h"
#include "pcl_fft_ground/object_cluster_extraction.h"
#include "pcl_fft_ground/voxel_cluster_extraction.h"
#include "random_points.h"

namespace pcl_fft_ground::test {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using Random = std::mt19937;

float anyFloat(Random& random) {
  const auto bits = static_cast<std::uint32_t>(random());
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// A value that breaks arithmetic if any does.
float oddFloat(Random& random) {
  using Limits = std::numeric_limits<float>;
  constexpr std::array<float, 16> ODD{0.0F,
                                      -0.0F,
                                      Limits::denorm_min(),
                                      -Limits::denorm_min(),
                                      1e-30F,
                                      -1e-30F,
                                      Limits::min(),
                                      1.0F,
                                      -1.0F,
                                      1e18F,
                                      -1e18F,
                                      1e30F,
                                      Limits::max(),
                                      Limits::lowest(),
                                      Limits::infinity(),
                                      Limits::quiet_NaN()};
  return ODD[random() % ODD.size()];
}

float metre(Random& random) {
  return static_cast<float>(uniform(random, -2, 2));
}

Point along(const Eigen::Vector3f& direction, float place) {
  return Point(direction.x() * place, direction.y() * place, direction.z() * place);
}

/// A kind of cloud: makes a point of it.
struct Kind {
  std::string name;
  std::function<Point(Random&)> point;
};

/// All kinds, their shapes drawn.
std::vector<Kind> kinds(Random& random) {
  const Point place(metre(random), metre(random), metre(random));
  const Eigen::Vector3f direction(metre(random), metre(random), metre(random));
  const auto scale = static_cast<float>(std::pow(10.0, uniform(random, -38, 38)));
  const auto scattered = [](Random& r) { return Point(metre(r), metre(r), metre(r)); };
  return {
      {"any bits", [](Random& r) { return Point(anyFloat(r), anyFloat(r), anyFloat(r)); }},
      {"odd values", [](Random& r) { return Point(oddFloat(r), oddFloat(r), oddFloat(r)); }},
      {"some odd values",
       [=](Random& r) { return r() % 8 == 0 ? Point(oddFloat(r), metre(r), oddFloat(r)) : scattered(r); }},
      {"scattered", scattered},
      {"of any scale",
       [=](Random& r) { return Point(scale * metre(r), scale * metre(r), scale * metre(r)); }},
      {"of many scales",
       [](Random& r) {
         const auto s = static_cast<float>(std::pow(10.0, uniform(r, -30, 12)));
         return Point(s * metre(r), s * metre(r), s * metre(r));
       }},
      {"all equal", [=](Random&) { return place; }},
      {"zeros of both signs",
       [](Random& r) {
         return Point(r() % 2 ? 0.0F : -0.0F, r() % 2 ? 0.0F : -0.0F, r() % 2 ? 0.0F : -0.0F);
       }},
      {"denormals",
       [](Random& r) {
         const float least = std::numeric_limits<float>::denorm_min();
         return Point(least * static_cast<float>(r() % 99), least * static_cast<float>(r() % 99), least);
       }},
      {"a line", [=](Random& r) { return along(direction, metre(r)); }},
      {"an upright line", [=](Random& r) { return along(Eigen::Vector3f::UnitZ(), metre(r)); }},
      {"a wall", [=](Random& r) { return Point(place.x, metre(r), metre(r)); }},
      {"a level plane", [=](Random& r) { return Point(metre(r), metre(r), place.z); }},
      {"a lattice",
       [](Random& r) {
         return Point(static_cast<float>(r() % 4), static_cast<float>(r() % 4), static_cast<float>(r() % 4));
       }},
      {"two heaps far apart",
       [=](Random& r) { return Point(metre(r) + (r() % 2 ? 1e5F : 0.0F), metre(r), metre(r)); }},
  };
}

/// 1 to 100 points of a kind.
Cloud::Ptr cloudOfKind(const Kind& kind, Random& random) {
  const auto cloud = pcl::make_shared<Cloud>();
  const std::size_t count = 1 + random() % 100;
  for (std::size_t n = 0; n < count; ++n) cloud->push_back(kind.point(random));
  cloud->is_dense = random() % 2 == 0;  // it may lie
  return cloud;
}

bool isFinite(const Point& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

void expectSplit(GroundSegmentation<Point>& segmenter, const Cloud::ConstPtr& cloud) {
  pcl::PointIndices ground, objects;
  segmenter.setInputCloud(cloud);
  ASSERT_NO_THROW(segmenter.segment(ground, objects));
  EXPECT_TRUE(std::is_sorted(ground.indices.begin(), ground.indices.end()));
  EXPECT_TRUE(std::is_sorted(objects.indices.begin(), objects.indices.end()));
  std::vector<int> times(cloud->size(), 0);
  for (const pcl::Indices* list : {&ground.indices, &objects.indices})
    for (const pcl::index_t n : *list) ++times.at(static_cast<std::size_t>(n));
  for (std::size_t n = 0; n < times.size(); ++n)
    EXPECT_EQ(times[n], isFinite((*cloud)[n]) ? 1 : 0) << "point " << n << (*cloud)[n];
  EXPECT_TRUE(segmenter.getGroundSurface().height.allFinite())
      << segmenter.getGroundSurface().height.size() << " cells of "
      << segmenter.getGroundSurface().geometry.cell_size << ", first point " << cloud->front();
  EXPECT_LE(segmenter.getGroundSurface().height.size(), core::MAX_CELLS);
}

template <typename Extraction>
void expectClusters(Extraction& extraction, const Cloud::ConstPtr& cloud) {
  std::vector<pcl::PointIndices> clusters;
  extraction.setInputCloud(cloud);
  ASSERT_NO_THROW(extraction.extract(clusters));
  std::vector<int> times(cloud->size(), 0);
  std::size_t last = cloud->size();
  for (const pcl::PointIndices& cluster : clusters) {
    EXPECT_FALSE(cluster.indices.empty());
    EXPECT_LE(cluster.indices.size(), last);
    last = cluster.indices.size();
    for (const pcl::index_t n : cluster.indices) ++times.at(static_cast<std::size_t>(n));
  }
  for (std::size_t n = 0; n < times.size(); ++n)
    EXPECT_EQ(times[n], isFinite((*cloud)[n]) ? 1 : 0) << "point " << n << (*cloud)[n];
}

/// Seeds in parts, so that ctest can run them side by side; more of them by the variable
/// PCL_FFT_GROUND_SEEDS.
class AnyCloud : public testing::TestWithParam<unsigned> {
 protected:
  static constexpr unsigned PARTS = 8;

  static unsigned seeds() {
    const char* const wanted = std::getenv("PCL_FFT_GROUND_SEEDS");
    return wanted != nullptr ? static_cast<unsigned>(std::atoi(wanted)) : 100;
  }

  void SetUp() override {
    verbosity_ = pcl::console::getVerbosityLevel();
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  }
  void TearDown() override { pcl::console::setVerbosityLevel(verbosity_); }

  /// Runs `check` on clouds of every kind.
  template <typename Check>
  static void forEachCloud(const Check& check) {
    for (unsigned seed = GetParam(); seed < seeds(); seed += PARTS) {
      Random random(seed);
      for (const Kind& kind : kinds(random)) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + kind.name);
        check(cloudOfKind(kind, random));
        if (HasFatalFailure() || HasNonfatalFailure()) return;
      }
    }
  }

 private:
  pcl::console::VERBOSITY_LEVEL verbosity_ = pcl::console::L_INFO;
};
INSTANTIATE_TEST_SUITE_P(Parts, AnyCloud, testing::Range(0U, 8U));

TEST_P(AnyCloud, IsSplitByEveryMethod) {
  const std::vector<Method<Point>> methods = everyMethod<Point>();
  forEachCloud([&](const Cloud::ConstPtr& cloud) {
    for (const Method<Point>& method : methods) {
      SCOPED_TRACE(method.name);
      expectSplit(*method.make(unitOf(*cloud)), cloud);
    }
  });
}

TEST_P(AnyCloud, IsSplitWithTheDefaults) {
  FFTGroundSegmentation<Point> segmenter;
  forEachCloud([&](const Cloud::ConstPtr& cloud) { expectSplit(segmenter, cloud); });
}

TEST_P(AnyCloud, IsClustered) {
  forEachCloud([](const Cloud::ConstPtr& cloud) {
    VoxelClusterExtraction<Point> contact;
    contact.setMinClusterSize(1);
    ObjectClusterExtraction<Point> objects;
    objects.setMinClusterSize(1);
    for (const double leaf_size : {0.02, 1.0, 1e-30, 1e30}) {
      SCOPED_TRACE(leaf_size);
      contact.setLeafSize(leaf_size);
      objects.setLeafSize(leaf_size);
      expectClusters(contact, cloud);
      expectClusters(objects, cloud);
    }
  });
}

}  // namespace
}  // namespace pcl_fft_ground::test
