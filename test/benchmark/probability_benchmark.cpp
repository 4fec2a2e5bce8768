// Whether the ground's probability is right: of the points to which getGroundProbability() gives about p, a
// share p should be ground.
//
//   probability_benchmark [FIRST_SEED [LAST_SEED]]     the guide's table: seeds 801 to 810 unless told
//
// All seeds of a simulated kind together and, where PCL_FFT_GROUND_DATA is set, labelled land, towns, streets
// and tables. A row holds for each bin of a tenth of the probability the share of its points that are ground
// [%], '-' where they are fewer than 100, and over all points the mean difference of the share from the bin's
// mean probability.

#include <array>
#include <cmath>
#include <cstdio>

#include "known_scans.h"
#include "pcl_fft_ground/fft_ground_segmentation.h"

namespace {

using namespace pcl_fft_ground;

/// A row of the table.
class Row {
 public:
  /// \param truth of each point: 0 ground, 1 none, 2 not known
  template <typename Truth>
  void add(const pcl::PointCloud<pcl::PointXYZ>::Ptr& cloud, double largest, const Truth& truth) {
    FFTGroundSegmentation<pcl::PointXYZ> filter;
    filter.setInputCloud(cloud);
    filter.setMaximumObjectSize(largest);
    pcl::Indices objects;
    filter.filter(objects);
    const std::vector<float> probability = filter.getGroundProbability();
    for (std::size_t n = 0; n < probability.size(); ++n) {
      if (truth(n) == 2) continue;
      const auto p = static_cast<double>(probability[n]);
      Bin& bin = bins_[std::min<std::size_t>(bins_.size() - 1, static_cast<std::size_t>(p * bins_.size()))];
      bin.points += 1, bin.probability += p, bin.ground += truth(n) == 0 ? 1 : 0;
    }
  }

  void print(const std::string& name) const {
    constexpr double FEW = 100;
    double off = 0, points = 0;
    std::printf("| %-24s |", name.c_str());
    for (const Bin& bin : bins_) {
      off += std::abs(bin.probability - bin.ground), points += bin.points;
      if (bin.points < FEW)
        std::printf("   - |");
      else
        std::printf(" %3.0f |", 100 * bin.ground / bin.points);
    }
    std::printf(" %.1f |\n", 100 * off / points);
    std::fflush(stdout);
  }

 private:
  struct Bin {
    double points = 0, probability = 0, ground = 0;
  };
  std::array<Bin, 10> bins_;
};

}  // namespace

int main(int argc, char** argv) {
  const auto first = static_cast<std::uint32_t>(argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 801);
  const auto last = static_cast<std::uint32_t>(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : first + 9);
  std::puts("| scan | 0-.1 | .1-.2 | .2-.3 | .3-.4 | .4-.5 | .5-.6 | .6-.7 | .7-.8 | .8-.9 | .9-1 | off |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (const auto& [name, kind] : KINDS) {
    Row row;
    for (std::uint32_t seed = first; seed <= last; ++seed) {
      const core::SimulatedScan scan = benchmarkScan(kind, seed);
      pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
      for (Eigen::Index n = 0; n < scan.points.cols(); ++n)
        cloud->emplace_back(scan.points(0, n), scan.points(1, n), scan.points(2, n));
      row.add(cloud, 1.0, [&](std::size_t n) { return scan.labels[n] == 0 ? 0 : 1; });
    }
    row.print(name);
  }
  if (!hasLand()) return 0;
  for (const auto& [name, largest] : LAND) {
    const pcl::PointCloud<pcl::PointXYZL> scan = landScan(name);
    pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
    for (const auto& p : scan) cloud->emplace_back(p.x, p.y, p.z);
    Row row;
    row.add(cloud, largest, [&](std::size_t n) { return scan[n].label; });
    row.print(name.substr(name.find('/') + 1));
  }
  return 0;
}
