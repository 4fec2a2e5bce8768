// Speed of the segmentation and of the clustering beside PCL's own filters on the same points: a simulated
// wreck of 600,000 points in random order, or with --points N copies of it side by side. --threads 1,2,4
// segments with as many threads, too. --frame takes one turn of a far-reaching rotating laser in its place,
// --cloud FILE.pcd a scan of the user's; with either --size and --leaf [m] say how large an object is (10)
// and a cell of VoxelGrid (0.28). The last lines give the ratios; single times mean little on a shared
// machine. Google Benchmark's options go on, --benchmark_out=FILE (JSON) among them.

#include <benchmark/benchmark.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/approximate_progressive_morphological_filter.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/simulation/simulation.h"
#include "pcl_fft_ground/voxel_cluster_extraction.h"

namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

std::size_t wanted_points = 600000;
float leaf = 0.02F;           // of VoxelGrid, LOW_PASS and the clusters [m]
double largest_object = 1.0;  // [m]
bool lidar_frame = false;
std::string cloud_file;
std::vector<unsigned> thread_numbers{1};

/// Copies of the first points, side by side in a square.
void growTo(std::size_t size, Cloud& cloud) {
  constexpr float SIDE = 4;  // of a scan [m]
  const std::size_t once = cloud.size();
  const auto row =
      static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(size) / static_cast<double>(once))));
  for (std::size_t n = once; n < size; ++n) {
    const std::size_t copy = n / once;
    Point p = cloud[n % once];
    p.x += SIDE * static_cast<float>(copy % row);
    p.y += SIDE * static_cast<float>(copy / row);
    cloud.push_back(p);
  }
}

Cloud::Ptr simulatedWreck() {
  pcl_fft_ground::core::SimulationParameters parameters;
  parameters.points = std::min(wanted_points, parameters.points);
  const pcl_fft_ground::core::SimulatedScan scan = pcl_fft_ground::core::simulateScan(parameters);
  Cloud::Ptr cloud(new Cloud);
  cloud->reserve(wanted_points);
  for (Eigen::Index i = 0; i < scan.points.cols(); ++i)
    cloud->push_back({scan.points(0, i), scan.points(1, i), scan.points(2, i)});
  growTo(wanted_points, *cloud);
  boost::random::mt19937 random(1);
  for (std::size_t i = cloud->size(); i > 1; --i)
    std::swap((*cloud)[i - 1],
              (*cloud)[boost::random::uniform_int_distribution<std::size_t>(0, i - 1)(random)]);
  return cloud;
}

/// An upright box on the ground: where it stands and half of its sides [m].
struct Box {
  Eigen::Array3f centre, half;

  /// Distance at which a ray from the origin enters it, infinite for none.
  float hitBy(const Eigen::Array3f& direction) const {
    const Eigen::Array3f a = (centre - half) / direction, b = (centre + half) / direction;
    const float enter = a.min(b).maxCoeff(), leave = a.max(b).minCoeff();
    return enter > 0 && enter <= leave ? enter : std::numeric_limits<float>::infinity();
  }
};

/// One turn of a laser of 64 beams, 1.8 m above flat land with cars, trunks and walls, that sees 100 m far:
/// 60,000 points, most of them near, 98 to 99 % of the cells empty.
Cloud::Ptr simulatedFrame() {
  constexpr int BEAMS = 64, STEPS = 1000;
  constexpr float HEIGHT = 1.8F, REACH = 100, LOWEST = -0.42F, HIGHEST = 0.02F;  // [m], [rad]
  boost::random::mt19937 random(1);
  const auto drawn = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random()) / static_cast<float>(random.max());
  };
  std::vector<Box> boxes;
  for (int n = 0; n < 60; ++n) {
    const Eigen::Array3f half = n % 3 == 0   ? Eigen::Array3f(2.2F, 0.9F, 0.75F)
                                : n % 3 == 1 ? Eigen::Array3f(0.2F, 0.2F, 3)
                                             : Eigen::Array3f(3, 0.3F, 1.5F);
    const float angle = drawn(-3.14F, 3.14F), range = drawn(6, 95);
    boxes.push_back({{range * std::cos(angle), range * std::sin(angle), half.z() - HEIGHT}, half});
  }
  Cloud::Ptr cloud(new Cloud);
  for (int step = 0; step < STEPS; ++step)
    for (int beam = 0; beam < BEAMS; ++beam) {
      const float turn = 6.2832F * static_cast<float>(step) / STEPS;
      const float rise = LOWEST + (HIGHEST - LOWEST) * static_cast<float>(beam) / (BEAMS - 1);
      const Eigen::Array3f direction(std::cos(rise) * std::cos(turn), std::cos(rise) * std::sin(turn),
                                     std::sin(rise));
      float range = direction.z() < 0 ? -HEIGHT / direction.z() : std::numeric_limits<float>::infinity();
      for (const Box& box : boxes) range = std::min(range, box.hitBy(direction));
      if (range > REACH) continue;
      const Eigen::Array3f p = (range + drawn(-0.02F, 0.02F)) * direction;
      cloud->push_back({p.x(), p.y(), p.z()});
    }
  return cloud;
}

Cloud::Ptr readCloud(const std::string& file) {
  Cloud::Ptr cloud(new Cloud);
  if (pcl::io::loadPCDFile(file, *cloud) != 0) throw std::runtime_error(file + " cannot be read");
  return cloud;
}

const Cloud::Ptr& scan() {
  static const Cloud::Ptr cloud = !cloud_file.empty() ? readCloud(cloud_file)
                                  : lidar_frame       ? simulatedFrame()
                                                      : simulatedWreck();
  return cloud;
}

const pcl::IndicesPtr& objectIndices() {
  static const pcl::IndicesPtr indices = [] {
    pcl_fft_ground::FFTGroundSegmentation<Point> filter;
    filter.setInputCloud(scan());
    filter.setMaximumObjectSize(largest_object);
    pcl::IndicesPtr objects(new pcl::Indices);
    filter.filter(*objects);
    return objects;
  }();
  return indices;
}

void voxelGrid(benchmark::State& state) {
  scan();
  for (auto _ : state) {
    pcl::VoxelGrid<Point> filter;
    filter.setInputCloud(scan());
    filter.setLeafSize(leaf, leaf, leaf);
    Cloud output;
    filter.filter(output);
    benchmark::DoNotOptimize(output.points.data());
  }
}

/// segment() of a new filter, set up by `set_up`.
template <typename SetUp>
void segmentScan(benchmark::State& state, const SetUp& set_up) {
  scan();
  for (auto _ : state) {
    pcl_fft_ground::FFTGroundSegmentation<Point> filter;
    filter.setInputCloud(scan());
    filter.setMaximumObjectSize(largest_object);
    filter.setNumberOfThreads(static_cast<unsigned>(state.range(0)));
    set_up(filter);
    pcl::PointIndices ground, objects;
    filter.segment(ground, objects);
    benchmark::DoNotOptimize(ground.indices.data());
    benchmark::DoNotOptimize(objects.indices.data());
  }
}

void segmentLowPass(benchmark::State& state) {
  segmentScan(state, [](auto& filter) {
    filter.setEstimator(pcl_fft_ground::Estimator::LOW_PASS);
    filter.setCellSize(leaf);
  });
}

void segmentRobust(benchmark::State& state) {
  segmentScan(state, [](auto&) {});
}

void euclideanClusters(benchmark::State& state) {
  objectIndices();
  for (auto _ : state) {
    pcl::EuclideanClusterExtraction<Point> extraction;
    extraction.setInputCloud(scan());
    extraction.setIndices(objectIndices());
    extraction.setSearchMethod(pcl::search::KdTree<Point>::Ptr(new pcl::search::KdTree<Point>));
    extraction.setClusterTolerance(leaf);
    std::vector<pcl::PointIndices> clusters;
    extraction.extract(clusters);
    benchmark::DoNotOptimize(clusters.data());
  }
}

/// As much as reading all points three times: no method can be faster.
void threePasses(benchmark::State& state) {
  scan();
  for (auto _ : state) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (int pass = 0; pass < 3; ++pass)
      for (const Point& p : *scan()) sum += p.getVector3fMap();
    benchmark::DoNotOptimize(sum);
  }
}

/// With windows up to the largest object, cells of a thirty-sixth of it.
void progressiveMorphological(benchmark::State& state) {
  scan();
  for (auto _ : state) {
    pcl::ApproximateProgressiveMorphologicalFilter<Point> filter;
    filter.setInputCloud(scan());
    filter.setCellSize(static_cast<float>(largest_object / 36));
    filter.setMaxWindowSize(36);
    filter.setSlope(0.3F);
    filter.setInitialDistance(static_cast<float>(0.02 * largest_object));
    filter.setMaxDistance(static_cast<float>(0.2 * largest_object));
    pcl::Indices ground;
    filter.extract(ground);
    benchmark::DoNotOptimize(ground.data());
  }
}

void planeByMlesac(benchmark::State& state) {
  scan();
  for (auto _ : state) {
    pcl::SACSegmentation<Point> segmentation;
    segmentation.setInputCloud(scan());
    segmentation.setModelType(pcl::SACMODEL_PLANE);
    segmentation.setMethodType(pcl::SAC_MLESAC);
    segmentation.setDistanceThreshold(0.02 * largest_object);
    segmentation.setMaxIterations(50);
    pcl::PointIndices plane;
    pcl::ModelCoefficients coefficients;
    segmentation.segment(plane, coefficients);
    benchmark::DoNotOptimize(plane.indices.data());
  }
}

void voxelClusters(benchmark::State& state) {
  objectIndices();
  for (auto _ : state) {
    pcl_fft_ground::VoxelClusterExtraction<Point> extraction;
    extraction.setInputCloud(scan());
    extraction.setIndices(objectIndices());
    extraction.setLeafSize(leaf);
    std::vector<pcl::PointIndices> clusters;
    extraction.extract(clusters);
    benchmark::DoNotOptimize(clusters.data());
  }
}

void registerAll() {
  using benchmark::RegisterBenchmark;
  RegisterBenchmark("voxelGrid", voxelGrid)->Unit(benchmark::kMillisecond);
  for (const unsigned threads : thread_numbers) {
    RegisterBenchmark("segmentLowPass", segmentLowPass)->Arg(threads)->Unit(benchmark::kMillisecond);
    RegisterBenchmark("segmentRobust", segmentRobust)->Arg(threads)->Unit(benchmark::kMillisecond);
  }
  RegisterBenchmark("threePasses", threePasses)->Unit(benchmark::kMillisecond);
  RegisterBenchmark("progressiveMorphological", progressiveMorphological)->Unit(benchmark::kMillisecond);
  RegisterBenchmark("planeByMlesac", planeByMlesac)->Unit(benchmark::kMillisecond);
  RegisterBenchmark("euclideanClusters", euclideanClusters)->Unit(benchmark::kMillisecond);
  RegisterBenchmark("voxelClusters", voxelClusters)->Unit(benchmark::kMillisecond);
}

/// Prints as usual and keeps the times of each benchmark by its name: CPU time, as others use the machine,
/// too; of several threads real time.
class MedianReporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs)
      if (run.aggregate_name.empty()) {
        const std::string &name = run.run_name.function_name, &threads = run.run_name.args;
        if (threads.empty() || threads == "1") times_[name].push_back(run.GetAdjustedCPUTime());
        if (!threads.empty()) times_[name + "/" + threads].push_back(run.GetAdjustedRealTime());
      }
  }

  void printRatio(const char* text, const std::string& numerator, const std::string& denominator) {
    if (times_.count(numerator) == 0 || times_.count(denominator) == 0) return;
    std::printf("%s: %.3f\n", text, median(numerator) / median(denominator));
  }

 private:
  double median(const std::string& name) {
    std::vector<double>& times = times_[name];
    std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
    return times[times.size() / 2];
  }

  std::map<std::string, std::vector<double>> times_;
};

/// Takes an option and its value out of the arguments.
/// \return the value, empty if it is not given
std::string takeOption(const std::string& name, std::vector<char*>& arguments) {
  const auto at = std::find(arguments.begin(), arguments.end(), name);
  if (at == arguments.end() || at + 1 == arguments.end()) return "";
  const std::string value = *(at + 1);
  arguments.erase(at, at + 2);
  return value;
}

bool takeFlag(const std::string& name, std::vector<char*>& arguments) {
  const auto at = std::find(arguments.begin(), arguments.end(), name);
  if (at == arguments.end()) return false;
  arguments.erase(at);
  return true;
}

void takeOptions(std::vector<char*>& arguments) {
  lidar_frame = takeFlag("--frame", arguments);
  cloud_file = takeOption("--cloud", arguments);
  if (lidar_frame || !cloud_file.empty()) leaf = 0.28F, largest_object = 10;
  const std::string points = takeOption("--points", arguments), size = takeOption("--size", arguments),
                    side = takeOption("--leaf", arguments);
  if (!points.empty()) wanted_points = std::stoul(points);
  if (!size.empty()) largest_object = std::stod(size);
  if (!side.empty()) leaf = std::stof(side);
  std::istringstream numbers(takeOption("--threads", arguments));
  if (!numbers.str().empty()) thread_numbers.clear();
  for (std::string number; std::getline(numbers, number, ',');)
    thread_numbers.push_back(static_cast<unsigned>(std::stoul(number)));
}

}  // namespace

int main(int argc, char** argv) {
  // Interleaved repetitions: a machine that slows down meanwhile slows both sides of a ratio.
  std::vector<char*> arguments(argv, argv + argc);
  takeOptions(arguments);
  registerAll();
  char repetitions[] = "--benchmark_repetitions=9",
       interleaving[] = "--benchmark_enable_random_interleaving=true",
       min_time[] = "--benchmark_min_time=0.05";
  arguments.insert(arguments.begin() + 1, {repetitions, interleaving, min_time});
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  MedianReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  reporter.printRatio("segment (LOW_PASS) / pcl::VoxelGrid", "segmentLowPass", "voxelGrid");
  reporter.printRatio("segment (ROBUST) / pcl::VoxelGrid", "segmentRobust", "voxelGrid");
  for (const unsigned threads : thread_numbers)
    if (threads != 1)
      for (const char* const name : {"segmentLowPass", "segmentRobust"})
        reporter.printRatio(
            (std::string(name) + ", 1 thread / " + std::to_string(threads) + " threads").c_str(),
            std::string(name) + "/1", std::string(name) + "/" + std::to_string(threads));
  reporter.printRatio("segment (ROBUST) / segment (LOW_PASS)", "segmentRobust", "segmentLowPass");
  reporter.printRatio("pcl::EuclideanClusterExtraction / VoxelClusterExtraction", "euclideanClusters",
                      "voxelClusters");
  return 0;
}
