// Whether the ground's uncertainty is right: blocks of one largest object are taken out of scans, and 95 % of
// the true ground there should lie within 1.96 standard deviations of the surface fitted to the rest.
//
//   uncertainty_benchmark [FIRST_SEED [LAST_SEED]]     the guide's table: seeds 801 to 810 unless told
//
// Simulated scans of 300,000 points, 30 % of them on objects, largest object 1 m; their truth is the ground
// without noise. Where PCL_FFT_GROUND_DATA is set also its land, towns, streets and tables; the truth is the
// points labelled ground, noise and all. A row holds all seeds, which choose the blocks too: heights
// withheld, their share within the band (of all, and of single seeds the least and the greatest), root mean
// squares of the errors and of the deviations expected.

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "known_scans.h"
#include "pcl_fft_ground/fft_ground_segmentation.h"

namespace {

using namespace pcl_fft_ground;
using Point = pcl::PointXYZ;

constexpr double WITHHELD = 0.15;  // share of the blocks
constexpr double BAND = 1.96;      // standard deviations that hold 95 %

/// Which blocks of a regular grid are withheld.
class Blocks {
 public:
  Blocks(double side, std::uint32_t seed) : side_(side), random_(seed) {}

  bool withhold(double x, double y) {
    const auto [block, is_new] =
        withheld_.try_emplace({std::lround(x / side_), std::lround(y / side_)}, false);
    if (is_new) block->second = boost::random::uniform_real_distribution<double>(0, 1)(random_) < WITHHELD;
    return block->second;
  }

 private:
  double side_;
  boost::random::mt19937 random_;
  std::map<std::pair<long, long>, bool> withheld_;
};

/// A scan without its points in some blocks, and the true ground there.
struct Trial {
  Trial(double size, std::uint32_t seed) : largest(size), blocks(size, seed) {}

  /// \param ground the true ground at the point, or null
  void add(const Point& p, const float* ground) {
    if (!blocks.withhold(static_cast<double>(p.x), static_cast<double>(p.y)))
      left->push_back(p);
    else if (ground != nullptr)
      withheld.emplace_back(p.x, p.y, *ground);
  }

  double largest;  // object [m]
  Blocks blocks;
  pcl::PointCloud<Point>::Ptr left{new pcl::PointCloud<Point>};
  std::vector<Eigen::Vector3d> withheld;
};

Trial simulated(core::SceneKind kind, std::uint32_t seed) {
  const core::SimulatedScan scan = benchmarkScan(kind, seed);
  Trial trial(1.0, seed);
  for (Eigen::Index n = 0; n < scan.points.cols(); ++n)
    trial.add({scan.points(0, n), scan.points(1, n), scan.points(2, n)},
              &scan.ground_heights[static_cast<std::size_t>(n)]);
  return trial;
}

Trial measured(const pcl::PointCloud<pcl::PointXYZL>& cloud, double largest, std::uint32_t seed) {
  Trial trial(largest, seed);
  for (const auto& p : cloud) trial.add({p.x, p.y, p.z}, p.label == 0 ? &p.z : nullptr);
  return trial;
}

/// A row of the table.
class Row {
 public:
  void add(const Trial& trial) {
    FFTGroundSegmentation<Point> filter;
    filter.setInputCloud(trial.left);
    filter.setMaximumObjectSize(trial.largest);
    pcl::Indices objects;
    filter.filter(objects);
    const core::GroundSurface& surface = filter.getGroundSurface();
    const core::GroundSurface deviation{surface.frame_from_input, surface.geometry, surface.uncertainty};
    std::size_t within = 0;
    for (const Eigen::Vector3d& p : trial.withheld) {
      const Eigen::Vector3d level = surface.frame_from_input * p;
      const double error = level.z() - surface.heightAt(level.x(), level.y());
      const double expected = deviation.heightAt(level.x(), level.y());
      within += std::abs(error) <= BAND * expected ? 1 : 0;
      errors_ += error * error, variances_ += expected * expected;
    }
    if (trial.withheld.empty()) return;
    const auto count = static_cast<double>(trial.withheld.size());
    count_ += count, within_ += static_cast<double>(within);
    least_ = std::min(least_, static_cast<double>(within) / count);
    greatest_ = std::max(greatest_, static_cast<double>(within) / count);
  }

  void print(const std::string& name) const {
    std::printf("| %-24s | %8.0f | %5.1f | %3.0f-%3.0f | %.3g | %.3g |\n", name.c_str(), count_,
                100 * within_ / count_, 100 * least_, 100 * greatest_, std::sqrt(errors_ / count_),
                std::sqrt(variances_ / count_));
    std::fflush(stdout);
  }

 private:
  double count_ = 0, within_ = 0, errors_ = 0, variances_ = 0, least_ = 1, greatest_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const auto first = static_cast<std::uint32_t>(argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 801);
  const auto last = static_cast<std::uint32_t>(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : first + 9);
  std::puts(
      "| scan | withheld | within [%] | by seed | error [m] | expected [m] |\n|---|---|---|---|---|---|");
  for (const auto& [name, kind] : KINDS) {
    Row row;
    for (std::uint32_t seed = first; seed <= last; ++seed) row.add(simulated(kind, seed));
    row.print(name);
  }
  if (!hasLand()) return 0;
  for (const auto& [name, largest] : LAND) {
    const pcl::PointCloud<pcl::PointXYZL> cloud = landScan(name);
    Row row;
    for (std::uint32_t seed = first; seed <= last; ++seed) row.add(measured(cloud, largest, seed));
    row.print(name.substr(name.find('/') + 1));
  }
  return 0;
}
