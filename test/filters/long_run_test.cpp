// One filter on many frames, and many filters on one cloud at once.

#include <gtest/gtest.h>
#include <pcl/console/print.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <thread>
#include <vector>

#include "clouds.h"
#include "every_method.h"

namespace pcl_fft_ground::test {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

Cloud::Ptr frameOf(const Scene& scene, Eigen::Index points) {
  return cloudOf<Point>(Eigen::Matrix3Xf(scene.points.leftCols(points)));
}

pcl::Indices objectsOf(GroundSegmentation<Point>& segmenter, const Cloud::ConstPtr& cloud) {
  pcl::PointIndices ground, objects;
  segmenter.setInputCloud(cloud);
  segmenter.segment(ground, objects);
  return objects.indices;
}

/// Memory of this process that is in use [bytes], as the system counts it.
double residentBytes() {
  std::ifstream stream("/proc/self/statm");
  double pages = 0, resident = 0;
  stream >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

// More frames by the variable PCL_FFT_GROUND_FRAMES.
TEST(LongRun, MemoryStaysAndTheLastFrameIsAsTheFirst) {
  const char* const wanted = std::getenv("PCL_FFT_GROUND_FRAMES");
  const int frames = wanted != nullptr ? std::atoi(wanted) : 200;
  const Scene scene = boxScene();
  const Cloud::Ptr whole = frameOf(scene, scene.points.cols());
  FFTGroundSegmentation<Point> segmenter;
  segmenter.setMaximumObjectSize(0.8);
  const pcl::Indices first = objectsOf(segmenter, whole);
  ASSERT_FALSE(first.empty());
  double after_a_while = residentBytes();
  for (int n = 0; n < frames; ++n) {
    objectsOf(segmenter, frameOf(scene, 100 + (n * 617) % (scene.points.cols() - 100)));
    if (n == frames / 10) after_a_while = residentBytes();
  }
  EXPECT_EQ(objectsOf(segmenter, whole), first);
  EXPECT_LT(residentBytes(), after_a_while + 8e6);  // as much as some frames, not as all
}

TEST(Concurrency, FiltersOfTheirOwnShareOneConstCloud) {
  const auto verbosity = pcl::console::getVerbosityLevel();
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  const Cloud::ConstPtr cloud = cloudOf<Point>(boxScene().points);
  const std::vector<Method<Point>> methods = everyMethod<Point>();
  std::vector<pcl::Indices> alone, together(methods.size());
  for (const Method<Point>& method : methods) alone.push_back(objectsOf(*method.make(1), cloud));
  std::vector<std::thread> threads;
  for (std::size_t n = 0; n < methods.size(); ++n)
    threads.emplace_back([&, n] {
      for (int times = 0; times < 5; ++times) together[n] = objectsOf(*methods[n].make(1), cloud);
    });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t n = 0; n < methods.size(); ++n) EXPECT_EQ(together[n], alone[n]) << methods[n].name;
  pcl::console::setVerbosityLevel(verbosity);
}

}  // namespace
}  // namespace pcl_fft_ground::test
