// How well ObjectClusterExtraction tells touching objects apart: simulated scans of 300,000 points, the true
// ground and objects by FFTGroundSegmentation as `segment` uses it, the truth of segments from the simulator.
//
//   object_benchmark [FIRST_SEED [LAST_SEED]]     the guide's table: seeds 201 to 210 unless told
//
// Panoptic quality PQ is the sum of the IoU of matches (IoU > 0.5) over the mean of the numbers of objects
// and segments; F_os (Richtsfeld) the share of the objects' points that lie in another segment than the main
// one of their object. Points of label 2 do not count, nor do objects and segments of fewer than 300 points.

#include <pcl/point_types.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <utility>
#include <vector>

#include "pcl_fft_ground/core/segments/object_properties.h"
#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/object_cluster_extraction.h"
#include "pcl_fft_ground/simulation/simulation.h"
#include "pcl_fft_ground/voxel_cluster_extraction.h"

namespace {

using namespace pcl_fft_ground;
using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using Clusters = std::vector<pcl::PointIndices>;

constexpr double LARGEST = 1.0;    // object [m]
constexpr int LEAST_POINTS = 300;  // of an object or a segment that counts
constexpr double A_PART = 0.05;    // share of a contact cluster: a piece of that size is a cut
constexpr double ANOTHER = 0.02;   // share of a contact cluster that makes it one of two objects

/// A scan, and what `segment` makes of it.
struct Trial {
  core::SimulatedScan scan;
  Cloud::Ptr cloud{new Cloud};
  pcl::IndicesPtr objects{new pcl::Indices};
  std::vector<double> heights;  // above the ground, per point [m]
  std::vector<core::SimulatedObject> known;
  Eigen::Vector3d up;
  double leaf_size = 0;
};

Trial makeTrial(core::SceneKind kind, double share, std::uint32_t seed, std::size_t points) {
  core::SimulationParameters parameters;
  parameters.scene = kind;
  parameters.object_share = share;
  parameters.seed = seed;
  parameters.points = points;
  Trial trial;
  trial.scan = core::simulateScan(parameters);
  for (const auto& p : trial.scan.points.colwise()) trial.cloud->push_back({p.x(), p.y(), p.z()});
  FFTGroundSegmentation<Point> filter;
  filter.setInputCloud(trial.cloud);
  filter.setMaximumObjectSize(LARGEST);
  filter.filter(*trial.objects);
  trial.up = filter.getFrame().linear().row(2).transpose();
  trial.leaf_size = filter.getCellSize();
  trial.heights = filter.getHeightAboveGround();
  trial.known = core::simulatedObjects(parameters);
  return trial;
}

Clusters extractContact(const Trial& trial) {
  VoxelClusterExtraction<Point> extraction;
  extraction.setInputCloud(trial.cloud);
  extraction.setIndices(trial.objects);
  extraction.setLeafSize(trial.leaf_size);
  Clusters clusters;
  extraction.extract(clusters);
  return clusters;
}

Clusters extractObjects(const Trial& trial) {
  ObjectClusterExtraction<Point> extraction;
  extraction.setInputCloud(trial.cloud);
  extraction.setIndices(trial.objects);
  extraction.setLeafSize(trial.leaf_size);
  extraction.setMinimumObjectSize(core::MINIMUM_OBJECT_SHARE * LARGEST);
  extraction.setUpDirection(trial.up);
  Clusters clusters;
  extraction.extract(clusters);
  return clusters;
}

/// How segments agree with objects.
struct Agreement {
  double quality = 0, objects = 0, segments = 0, over = 0, under = 0;
};

/// \param truth number of its object per point, 0 none, -1: does not count
Agreement compare(const std::vector<int>& truth, const Clusters& clusters) {
  std::map<int, int> object_points, segment_points;
  std::map<std::pair<int, int>, int> common;
  for (const int object : truth)
    if (object > 0) ++object_points[object];
  for (std::size_t k = 0; k < clusters.size(); ++k)
    for (const pcl::index_t n : clusters[k].indices) {
      const int object = truth[static_cast<std::size_t>(n)];
      if (object >= 0) ++segment_points[static_cast<int>(k)];
      if (object > 0) ++common[{object, static_cast<int>(k)}];
    }
  const auto counting = [](const std::map<int, int>& sizes) {
    return static_cast<double>(std::count_if(sizes.begin(), sizes.end(),
                                             [](const auto& size) { return size.second >= LEAST_POINTS; }));
  };
  Agreement result;
  result.objects = counting(object_points);
  result.segments = counting(segment_points);
  std::map<int, std::pair<int, int>> owner;  // per segment: points and number of the object with most of it
  for (const auto& [pair, points] : common)
    owner[pair.second] = std::max(owner[pair.second], {points, pair.first});
  std::map<int, int> main_points;  // per object: points of its main segment
  double total = 0, elsewhere = 0, merged = 0, iou_sum = 0;
  for (const auto& [pair, points] : common) {
    const auto [object, segment] = pair;
    if (owner[segment].second == object) main_points[object] = std::max(main_points[object], points);
  }
  for (const auto& [pair, points] : common) {
    const auto [object, segment] = pair;
    if (object_points[object] < LEAST_POINTS) continue;
    total += points;
    if (owner[segment].second == object && points < main_points[object]) elsewhere += points;
    if (owner[segment].second != object) merged += points;
    if (segment_points[segment] < LEAST_POINTS) continue;
    const double iou =
        static_cast<double>(points) / (object_points[object] + segment_points[segment] - points);
    if (iou > 0.5) iou_sum += iou;
  }
  result.quality = iou_sum / std::max(1.0, 0.5 * (result.objects + result.segments));
  result.over = elsewhere / std::max(1.0, total);
  result.under = merged / std::max(1.0, total);
  return result;
}

std::vector<int> truthOf(const core::SimulatedScan& scan) {
  std::vector<int> truth(scan.labels.size());
  for (std::size_t n = 0; n < truth.size(); ++n)
    truth[n] = scan.labels[n] == 2 ? -1 : scan.labels[n] == 1 ? scan.segments[n] : 0;
  return truth;
}

/// Contact clusters of one object, and how many of them are cut.
struct Singles {
  int whole = 0, cut = 0;
};

void countSingles(const std::vector<int>& truth, const Clusters& contact, const Clusters& clusters,
                  Singles& singles) {
  std::vector<int> cluster_of(truth.size(), -1);
  for (std::size_t k = 0; k < clusters.size(); ++k)
    for (const pcl::index_t n : clusters[k].indices)
      cluster_of[static_cast<std::size_t>(n)] = static_cast<int>(k);
  for (const pcl::PointIndices& cluster : contact) {
    if (cluster.indices.size() < LEAST_POINTS) continue;
    std::map<int, int> objects, parts;
    for (const pcl::index_t n : cluster.indices) {
      if (truth[static_cast<std::size_t>(n)] > 0) ++objects[truth[static_cast<std::size_t>(n)]];
      ++parts[cluster_of[static_cast<std::size_t>(n)]];
    }
    const auto large = [&](const std::map<int, int>& sizes, double share) {
      return std::count_if(sizes.begin(), sizes.end(), [&](const auto& size) {
        return size.second >= share * static_cast<double>(cluster.indices.size());
      });
    };
    if (large(objects, ANOTHER) == 1) ++(large(parts, A_PART) > 1 ? singles.cut : singles.whole);
  }
}

/// Relative errors of what is measured of segments that match objects seen to at least half.
struct Errors {
  std::vector<double> volume, pipe_radius;
};

void measureMatches(const Trial& trial, const std::vector<int>& truth, const Clusters& clusters,
                    bool are_pipes, Errors& errors) {
  std::map<int, double> object_points;
  for (const int object : truth)
    if (object > 0) ++object_points[object];
  for (const pcl::PointIndices& cluster : clusters) {
    std::map<int, int> objects;
    for (const pcl::index_t n : cluster.indices) ++objects[truth[static_cast<std::size_t>(n)]];
    for (const auto& [object, points] : objects) {
      const auto size = static_cast<double>(cluster.indices.size());
      if (object <= 0 || points < LEAST_POINTS || points / (object_points[object] + size - points) <= 0.5)
        continue;
      const core::SimulatedObject& known = trial.known[static_cast<std::size_t>(object - 1)];
      if (known.share_seen < 0.5) continue;
      core::Points of_cluster(3, static_cast<Eigen::Index>(cluster.indices.size()));
      std::vector<double> heights;
      for (std::size_t k = 0; k < cluster.indices.size(); ++k) {
        of_cluster.col(static_cast<Eigen::Index>(k)) = trial.scan.points.col(cluster.indices[k]);
        heights.push_back(trial.heights[static_cast<std::size_t>(cluster.indices[k])]);
      }
      const core::ObjectProperties measured =
          core::measureObject(of_cluster, heights, {trial.leaf_size, trial.up, nullptr});
      errors.volume.push_back(measured.volume / known.volume - 1);
      if (are_pipes && measured.body && measured.body->shape == core::RoundBody::Shape::CYLINDER)
        errors.pipe_radius.push_back(measured.body->radius / known.radius - 1);
    }
  }
}

void printErrors(const char* what, std::vector<double> errors) {
  if (errors.empty()) return;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  const double bias = *middle;
  for (double& error : errors) error = std::abs(error);
  std::nth_element(errors.begin(), middle, errors.end());
  std::printf("%s: median error %.1f %%, median of the sign %+.1f %% (%zu objects)\n", what, 100 * *middle,
              100 * bias, errors.size());
}

void printTable(std::uint32_t first, std::uint32_t last) {
  struct Bar {
    core::SceneKind kind;
    const char* name;
    double share, quality;
  };
  constexpr Bar BARS[] = {
      {core::SceneKind::WRECK, "wreck", 0.1, 0.85}, {core::SceneKind::WRECK, "wreck", 0.3, 0.72},
      {core::SceneKind::WRECK, "wreck", 0.5, 0.55}, {core::SceneKind::PIPES, "pipes", 0.1, 0.85},
      {core::SceneKind::PIPES, "pipes", 0.3, 0.60}, {core::SceneKind::PIPES, "pipes", 0.5, 0.40},
      {core::SceneKind::REEF, "reef", 0.1, 0.90},   {core::SceneKind::REEF, "reef", 0.3, 0.75},
      {core::SceneKind::REEF, "reef", 0.5, 0.60}};
  std::printf(
      "| scene | share | contact PQ | objects PQ | at least | objects seen | segments | F_os | F_us |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  Singles singles;
  Errors errors[3];
  for (const Bar& bar : BARS) {
    Agreement mean, contact_mean;
    for (std::uint32_t seed = first; seed <= last; ++seed) {
      const Trial trial = makeTrial(bar.kind, bar.share, seed, 300000);
      const std::vector<int> truth = truthOf(trial.scan);
      const Clusters contact = extractContact(trial), clusters = extractObjects(trial);
      countSingles(truth, contact, clusters, singles);
      measureMatches(trial, truth, clusters, bar.kind == core::SceneKind::PIPES,
                     errors[static_cast<std::size_t>(bar.kind)]);
      const Agreement agreement = compare(truth, clusters);
      contact_mean.quality += compare(truth, contact).quality;
      mean.quality += agreement.quality;
      mean.objects += agreement.objects;
      mean.segments += agreement.segments;
      mean.over += agreement.over;
      mean.under += agreement.under;
    }
    const double count = last - first + 1;
    std::printf("| %s | %.0f %% | %.2f | %.3f | %.2f | %.1f | %.1f | %.1f %% | %.1f %% |\n", bar.name,
                100 * bar.share, contact_mean.quality / count, mean.quality / count, bar.quality,
                mean.objects / count, mean.segments / count, 100 * mean.over / count,
                100 * mean.under / count);
    std::fflush(stdout);
  }
  std::printf("\ncontact clusters of one object: %d, of which cut: %d\n", singles.whole + singles.cut,
              singles.cut);
  const char* const names[3] = {"volumes of amphorae", "volumes of pipes", "volumes of boulders"};
  for (std::size_t kind = 0; kind < 3; ++kind) printErrors(names[kind], errors[kind].volume);
  printErrors("radii of pipes", errors[1].pipe_radius);
}

template <typename Extract>
double millisecondsOf(const Extract& extract) {
  const auto start = std::chrono::steady_clock::now();
  extract();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// A wreck with 300,000 object points in random order, both extractions by turns.
void printTimes() {
  constexpr int TURNS = 9;
  Trial trial = makeTrial(core::SceneKind::WRECK, 0.5, 1, 600000);
  boost::random::mt19937 random(1);
  for (std::size_t i = trial.objects->size(); i > 1; --i)
    std::swap((*trial.objects)[i - 1],
              (*trial.objects)[boost::random::uniform_int_distribution<std::size_t>(0, i - 1)(random)]);
  std::vector<double> contact, objects;
  for (int turn = 0; turn < TURNS; ++turn) {
    contact.push_back(millisecondsOf([&] { extractContact(trial); }));
    objects.push_back(millisecondsOf([&] { extractObjects(trial); }));
  }
  std::sort(contact.begin(), contact.end());
  std::sort(objects.begin(), objects.end());
  std::printf(
      "%zu object points: contact %.1f ms, objects %.1f ms (medians of %d); 1.5 x contact + 20 ms: %.1f ms\n",
      trial.objects->size(), contact[TURNS / 2], objects[TURNS / 2], TURNS, 1.5 * contact[TURNS / 2] + 20);
}

}  // namespace

int main(int argc, char** argv) {
  const auto first = static_cast<std::uint32_t>(argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 201);
  const auto last = static_cast<std::uint32_t>(argc > 2   ? std::strtoul(argv[2], nullptr, 10)
                                               : argc > 1 ? first
                                                          : 210);
  printTimes();
  printTable(first, last);
  return 0;
}
