// What becomes of the labels where a scan is far from clean, here and with PCL's own ground filters: a table
// of the share of points whose label changes. Each run has a process, a minute of a processor and 4 GB of its
// own. The scan is a simulated wreck of 20,000 points, --seed N (1); lengths of the filters are set for it,
// in the unit of the scan.

#include <pcl/point_types.h>
#include <pcl/segmentation/approximate_progressive_morphological_filter.h>
#include <pcl/segmentation/progressive_morphological_filter.h>
#include <pcl/segmentation/sac_segmentation.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/simulation/simulation.h"
#include "separate_process.h"

namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

/// A scan, and how many of it are a metre and how many threads work on it.
struct Trial {
  Cloud::Ptr cloud;
  float metre = 1;
  unsigned threads = 1;
};

pcl::Indices groundByFft(const Trial& trial) {
  pcl_fft_ground::FFTGroundSegmentation<Point> filter;
  filter.setMaximumObjectSize(trial.metre);
  filter.setNumberOfThreads(trial.threads);
  filter.setInputCloud(trial.cloud);
  pcl::PointIndices ground, objects;
  filter.segment(ground, objects);
  return ground.indices;
}

template <template <typename> class FilterT>
pcl::Indices groundByMorphology(const Trial& trial) {
  constexpr bool IS_APPROXIMATE =
      std::is_same_v<FilterT<Point>, pcl::ApproximateProgressiveMorphologicalFilter<Point>>;
  FilterT<Point> filter;
  filter.setCellSize(0.05F * trial.metre);
  filter.setMaxWindowSize(static_cast<int>(IS_APPROXIMATE ? 20 : trial.metre));  // [cells], [m]
  filter.setSlope(0.5F);
  filter.setInitialDistance(0.02F * trial.metre);
  filter.setMaxDistance(0.2F * trial.metre);
  if constexpr (IS_APPROXIMATE) filter.setNumberOfThreads(trial.threads);
  filter.setInputCloud(trial.cloud);
  pcl::Indices ground;
  filter.extract(ground);
  return ground;
}

pcl::Indices groundByPlane(const Trial& trial) {
  pcl::SACSegmentation<Point> plane;
  plane.setModelType(pcl::SACMODEL_PLANE);
  plane.setMethodType(pcl::SAC_MLESAC);
  plane.setDistanceThreshold(0.1F * trial.metre);
  plane.setInputCloud(trial.cloud);
  pcl::PointIndices ground;
  pcl::ModelCoefficients coefficients;
  plane.segment(ground, coefficients);
  return ground.indices;
}

constexpr char FAULT = '!';

/// A character for each point, '1' for the ground; or a FAULT and why there are no labels.
std::string labelsOf(const std::function<pcl::Indices(const Trial&)>& method, const Trial& trial) {
  const auto run = [&]() -> std::string {
    const auto limit = [](int resource, rlim_t most) {
      const rlimit both{most, most + 1};
      setrlimit(resource, &both);
    };
    limit(RLIMIT_AS, rlim_t{4} << 30);
    limit(RLIMIT_CPU, 60);
    try {
      std::string labels(trial.cloud->size(), '0');
      for (const pcl::index_t n : method(trial)) labels.at(static_cast<std::size_t>(n)) = '1';
      return labels;
    } catch (const std::exception& error) {
      return FAULT + std::string(error.what());
    }
  };
  const auto outcome = pcl_fft_ground::cli::runApart(run);
  if (outcome.end != pcl_fft_ground::cli::End::CRASHED) return outcome.bytes;
  return FAULT +
         (outcome.signal == SIGXCPU ? "more than a minute" : "signal " + std::to_string(outcome.signal));
}

/// What is done to the scan. Its points come first and in their order; others may follow.
struct Torture {
  std::string name;
  std::function<void(Trial&)> apply;
};

void scale(Trial& trial, float factor) {
  for (Point& p : *trial.cloud) p.getVector3fMap() *= factor;
  trial.metre *= factor;
}

std::vector<Torture> tortures() {
  constexpr float NO_NUMBER = std::numeric_limits<float>::quiet_NaN();
  return {{"another run", [](Trial&) {}},
          {"four threads", [](Trial& t) { t.threads = 4; }},
          {"a point 1 km away", [](Trial& t) { t.cloud->emplace_back(1000.0F, 0.0F, 0.0F); }},
          {"a point 1 km below", [](Trial& t) { t.cloud->emplace_back(0.0F, 0.0F, -1000.0F); }},
          {"a point at 1e30", [](Trial& t) { t.cloud->emplace_back(1e30F, 1e30F, 1e30F); }},
          {"NaN for 1 % of the points",
           [](Trial& t) {
             for (std::size_t n = 0; n < t.cloud->size(); n += 100)
               (*t.cloud)[n] = {NO_NUMBER, NO_NUMBER, NO_NUMBER};
             t.cloud->is_dense = false;
           }},
          {"millimetres for metres, all lengths", [](Trial& t) { scale(t, 1000); }},
          {"kilometres for metres, all lengths", [](Trial& t) { scale(t, 0.001F); }},
          {"every point twice", [](Trial& t) { *t.cloud += Cloud(*t.cloud); }},
          {"moved by 1 km",
           [](Trial& t) {
             for (Point& p : *t.cloud) p.x += 1000;
           }},
          {"a hundred points", [](Trial& t) { t.cloud->resize(100); }},
          {"one point", [](Trial& t) { t.cloud->resize(1); }},
          {"a hundred equal points", [](Trial& t) { *t.cloud = Cloud(100, 1, Point(t.cloud->front())); }}};
}

/// Share of the points that still are there, and finite, whose label is another one. Of scans that have
/// become others there is nothing to compare.
std::string verdict(const std::string& before, const std::string& after, const Cloud& cloud) {
  if (after.front() == FAULT) return after.substr(1);
  std::size_t points = 0, other = 0;
  for (std::size_t n = 0; n < std::min(before.size(), after.size()); ++n) {
    if (!std::isfinite(cloud[n].x)) continue;
    ++points;
    if (before[n] != after[n]) ++other;
  }
  if (points < before.size() / 2) return "labels";
  char text[32];
  std::snprintf(text, sizeof text, "%.2f %%",
                100.0 * static_cast<double>(other) / static_cast<double>(points));
  return text;
}

Cloud::Ptr wreck(unsigned seed) {
  pcl_fft_ground::core::SimulationParameters parameters;
  parameters.points = 20000;
  parameters.seed = seed;
  const Cloud::Ptr cloud(new Cloud);
  const pcl_fft_ground::core::SimulatedScan scan = pcl_fft_ground::core::simulateScan(parameters);
  for (const auto& point : scan.points.colwise()) cloud->emplace_back(point.x(), point.y(), point.z());
  return cloud;
}

}  // namespace

int main(int count, char** words) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  const bool is_seeded = count == 3 && words[1] == std::string("--seed");
  if (count != 1 && !is_seeded) {
    std::fprintf(stderr, "Usage: torture_benchmark [--seed N]\n");
    return 2;
  }
  const Cloud::ConstPtr scan = wreck(is_seeded ? static_cast<unsigned>(std::atoi(words[2])) : 1);
  const std::vector<std::pair<const char*, std::function<pcl::Indices(const Trial&)>>> methods{
      {"`FFTGroundSegmentation`", groundByFft},
      {"progressive morphological", groundByMorphology<pcl::ProgressiveMorphologicalFilter>},
      {"approximate of it", groundByMorphology<pcl::ApproximateProgressiveMorphologicalFilter>},
      {"MLESAC plane", groundByPlane}};
  std::vector<std::string> before;
  std::printf("| ");
  for (const auto& [name, method] : methods) {
    std::printf("| %s ", name);
    before.push_back(labelsOf(method, {pcl::make_shared<Cloud>(*scan)}));
  }
  std::printf("|\n|---|---|---|---|---|\n");
  for (const Torture& torture : tortures()) {
    Trial trial{pcl::make_shared<Cloud>(*scan)};
    torture.apply(trial);
    std::printf("| %s ", torture.name.c_str());
    for (std::size_t n = 0; n < methods.size(); ++n)
      std::printf("| %s ", verdict(before[n], labelsOf(methods[n].second, trial), *trial.cloud).c_str());
    std::printf("|\n");
    std::fflush(stdout);
  }
  return 0;
}
