// How many real pairs of scans SegmentICP aligns as `pcl_fft_ground align` asks it to, how many wrongly, and
// beside it PCL's GICP, NDT and point-to-plane ICP, from the same perturbed guesses; and what is accepted
// where nothing may be: scans of different places laid on each other, and scans that are mirrored.

#include <pcl/common/transforms.h>
#include <pcl/console/print.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/ndt.h>

#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "io/cloud_file.h"
#include "pcl_fft_ground/segment_icp.h"
#include "simulation/simulation_random.h"

namespace {

namespace cli = pcl_fft_ground::cli;
namespace core = pcl_fft_ground::core;
namespace po = boost::program_options;
using core::Random;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::PointNormal>;

constexpr double DEGREE = 3.14159265358979323846 / 180;

/// What is set for a kind of scene: guesses and, for PCL's methods, one setting for all scenes of the kind.
struct Kind {
  const char* name;
  double largest;  ///< horizontal extent up to which a scan is of this kind [m]
  double near;     ///< error of the near guesses [m]
  double far;      ///< and of the far ones [m]
  double leaf;     ///< voxels that PCL's methods see [m]
  double reach;    ///< their largest distance of correspondences; cells of NDT [m]
};
constexpr Kind KINDS[] = {{"close range", 8, 0.05, 0.30, 0.03, 0.5},
                          {"indoor laser", 30, 0.05, 0.30, 0.08, 0.8},
                          {"street", 120, 0.10, 0.40, 0.25, 1.5},
                          {"airborne", 1e9, 0.10, 0.40, 1.0, 4.0}};

struct Scan {
  std::string name;
  Cloud::Ptr cloud;
  double spacing = 0;  ///< median distance between neighbours [m]
  double extent = 0;   ///< the larger horizontal one [m]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
};

struct Pair {
  std::string name;
  std::shared_ptr<const Scan> reference, moving;
  Eigen::Isometry3d truth;  ///< reference_from_moving
  const Kind* kind;
};

/// What a method came to.
struct Outcome {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  bool accepted = false;
  std::string refusal = {};
  std::string how = {};
  double seconds = 0;  ///< CPU time
  core::Matrix6d covariance = core::Matrix6d::Zero();
};

using Method = std::function<Outcome(const Scan& reference, const Scan& moving,
                                     const Eigen::Isometry3d& guess, const Kind& kind)>;

double medianOf(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double spacingOf(const Cloud::ConstPtr& cloud) {
  constexpr std::size_t SAMPLES = 2000;
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
  tree.setInputCloud(cloud);
  std::vector<double> distances;
  pcl::Indices found;
  std::vector<float> squares;
  for (std::size_t n = 0; n < SAMPLES; ++n)
    if (tree.nearestKSearch(cloud->points[n * cloud->size() / SAMPLES], 2, found, squares) == 2 &&
        squares[1] > 0)
      distances.push_back(std::sqrt(static_cast<double>(squares[1])));
  return medianOf(distances);
}

std::shared_ptr<Scan> readScan(const std::filesystem::path& path) {
  auto scan = std::make_shared<Scan>();
  scan->name = (path.parent_path().filename() / path.stem()).string();
  scan->cloud.reset(new Cloud);
  Eigen::AlignedBox3d box;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const cli::Cloud cloud = cli::readCloud(path.string());
  for (const auto& point : *cloud.points) {
    if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z)) continue;
    scan->cloud->push_back(point);
    box.extend(point.getVector3fMap().cast<double>());
    sum += point.getVector3fMap().cast<double>();
  }
  scan->centre = sum / static_cast<double>(scan->cloud->size());
  scan->extent = box.sizes().head<2>().maxCoeff();
  scan->spacing = spacingOf(scan->cloud);
  return scan;
}

/// \throws std::runtime_error naming the file that holds no 4 x 4 matrix
Eigen::Isometry3d readTruth(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::vector<double> numbers;
  while (std::getline(file, line)) {
    if (line.rfind('#', 0) == 0) continue;
    std::istringstream words(line);
    for (double number = 0; words >> number;) numbers.push_back(number);
  }
  if (numbers.size() != 16) throw std::runtime_error(path.string() + " holds no 4 x 4 matrix");
  Eigen::Isometry3d pose;
  pose.matrix() = Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  return pose;
}

const Kind& kindOf(double extent) {
  for (const Kind& kind : KINDS)
    if (extent <= kind.largest) return kind;
  return KINDS[3];
}

/// All pairs of a folder, both ways round. \param only part of the names of those that are taken
std::vector<Pair> readPairs(const std::string& folder, const std::string& only) {
  std::vector<std::filesystem::path> folders;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (std::filesystem::exists(entry.path() / "truth.txt") &&
        entry.path().filename().string().find(only) != std::string::npos)
      folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  std::vector<Pair> pairs;
  for (const auto& path : folders) {
    const auto reference = readScan(path / "ref.pcd"), moving = readScan(path / "mov.pcd");
    const Eigen::Isometry3d truth = readTruth(path / "truth.txt");
    const Kind& kind = kindOf(std::max(reference->extent, moving->extent));
    const std::string name = path.filename().string();
    pairs.push_back({name, reference, moving, truth, &kind});
    pairs.push_back({name + ", back", moving, reference, truth.inverse(), &kind});
  }
  return pairs;
}

Eigen::Vector3d anyDirection(Random& random) {
  const double x = random.normal(1), y = random.normal(1), z = random.normal(1);
  return Eigen::Vector3d(x, y, z).normalized();
}

/// The truth, off by a shift in any direction and a turn about any axis or the vertical, amid the moving
/// scan.
Eigen::Isometry3d perturbed(const Pair& pair, double shift, double turn, bool tilted, Random& random) {
  const Eigen::Vector3d way = shift * anyDirection(random);
  const Eigen::Vector3d axis =
      tilted ? anyDirection(random)
             : Eigen::Vector3d((random.chance(0.5) ? 1 : -1) * Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d pivot = pair.truth.translation();
  return Eigen::Translation3d(pivot + way) * Eigen::AngleAxisd(turn * DEGREE, axis) *
         Eigen::Translation3d(-pivot) * pair.truth;
}

Outcome bySegments(const Scan& reference, const Scan& moving, const Eigen::Isometry3d& guess, const Kind&) {
  static pcl_fft_ground::SegmentICP<pcl::PointXYZ, pcl::PointXYZ> icp;
  core::AlignmentParameters parameters;
  parameters.relief = core::ReliefUse::AUTO;
  icp.setAlignmentParameters(parameters);
  icp.setInputSource(moving.cloud);
  if (icp.getInputTarget() != reference.cloud) icp.setInputTarget(reference.cloud);
  const std::clock_t begun = std::clock();
  const core::Alignment& alignment = icp.computeAlignment(guess);
  Outcome outcome{alignment.reference_from_moving, alignment.accepted, alignment.refusal};
  outcome.seconds = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  outcome.covariance = alignment.covariance;
  constexpr const char* NAMES[] = {"none", "segments", "dense", "relief"};
  outcome.how = NAMES[static_cast<int>(alignment.method)];
  return outcome;
}

/// The scan in voxels, with normals, as PCL's methods see it; kept.
const Normals::Ptr& thinnedOf(const Scan& scan, const Kind& kind) {
  static std::map<std::pair<const Scan*, const Kind*>, Normals::Ptr> kept;
  Normals::Ptr& thinned = kept[{&scan, &kind}];
  if (thinned) return thinned;
  Cloud::Ptr voxels(new Cloud);
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  const auto leaf = static_cast<float>(kind.leaf);
  grid.setLeafSize(leaf, leaf, leaf);
  grid.setInputCloud(scan.cloud);
  grid.filter(*voxels);
  thinned.reset(new Normals);
  pcl::copyPointCloud(*voxels, *thinned);
  pcl::NormalEstimation<pcl::PointXYZ, pcl::PointNormal> normals;
  normals.setInputCloud(voxels);
  normals.setKSearch(15);
  normals.compute(*thinned);
  pcl::copyPointCloud(*voxels, *thinned);
  thinned->erase(std::remove_if(thinned->begin(), thinned->end(),
                                [](const pcl::PointNormal& p) { return !std::isfinite(p.normal_x); }),
                 thinned->end());
  return thinned;
}

/// Runs one of PCL's methods. What has converged counts as accepted: they know no refusal.
template <typename PointT>
Outcome byPcl(pcl::Registration<PointT, PointT>& registration, const Scan& reference, const Scan& moving,
              const Eigen::Isometry3d& guess, const Kind& kind) {
  const auto seen = [&](const Scan& scan) {
    typename pcl::PointCloud<PointT>::Ptr cloud(new pcl::PointCloud<PointT>);
    pcl::copyPointCloud(*thinnedOf(scan, kind), *cloud);
    return cloud;
  };
  registration.setInputSource(seen(moving));
  registration.setInputTarget(seen(reference));
  registration.setMaxCorrespondenceDistance(kind.reach);
  registration.setMaximumIterations(60);
  registration.setTransformationEpsilon(1e-8);
  pcl::PointCloud<PointT> aligned;
  Outcome outcome;
  const std::clock_t begun = std::clock();
  registration.align(aligned, guess.matrix().cast<float>());
  outcome.seconds = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  outcome.accepted = registration.hasConverged();
  outcome.pose.matrix() = registration.getFinalTransformation().template cast<double>();
  return outcome;
}

Outcome byGicp(const Scan& reference, const Scan& moving, const Eigen::Isometry3d& guess, const Kind& kind) {
  pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> gicp;
  return byPcl(gicp, reference, moving, guess, kind);
}

Outcome byNdt(const Scan& reference, const Scan& moving, const Eigen::Isometry3d& guess, const Kind& kind) {
  pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ> ndt;
  ndt.setResolution(static_cast<float>(kind.reach));
  ndt.setStepSize(0.1 * kind.reach);
  return byPcl(ndt, reference, moving, guess, kind);
}

Outcome byPlaneIcp(const Scan& reference, const Scan& moving, const Eigen::Isometry3d& guess,
                   const Kind& kind) {
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
  return byPcl(icp, reference, moving, guess, kind);
}

/// Counts of a row of the table.
struct Row {
  std::size_t trials = 0, right = 0, wrong = 0, refused = 0;
  std::vector<double> errors = {}, turns = {}, seconds = {}, surprises = {};
};

struct Benchmark {
  unsigned seed = 501, repeats = 2;
  bool peers = true, verbose = false;
  std::map<std::string, Row> total = {};
};

void print(const std::string& name, const Row& row) {
  if (row.trials == 0) return;
  std::printf("%-44s %5zu %5zu %5zu %7zu %8.1f %8.2f %6.1f %7.2f\n", name.c_str(), row.trials, row.right,
              row.wrong, row.refused, 1000 * medianOf(row.errors), medianOf(row.turns),
              medianOf(row.surprises), medianOf(row.seconds));
  std::fflush(stdout);
}

/// Squared error over its predicted covariance, per degree of freedom; 0 if nothing was predicted.
double surpriseOf(const Outcome& outcome, const Eigen::Isometry3d& truth) {
  if (outcome.covariance.isZero(0)) return 0;
  const Eigen::Isometry3d off = truth * outcome.pose.inverse();
  const Eigen::AngleAxisd turn(off.linear());
  core::Vector6d error;
  error << off.translation(), turn.angle() * turn.axis();
  return error.dot(outcome.covariance.ldlt().solve(error)) / 6;
}

/// Adds a trial; accepted is right if within 5 cm, three spacings more, and 2 degrees.
void add(Row& row, const Outcome& outcome, const Pair& pair) {
  constexpr double TOLERANCE = 0.05, SPACINGS = 3, TURN = 2;
  const Eigen::Vector3d place = pair.moving->centre;
  const double error = (outcome.pose * place - pair.truth * place).norm();
  const Eigen::Matrix3d between = outcome.pose.linear().transpose() * pair.truth.linear();
  const double turn = Eigen::AngleAxisd(between).angle() / DEGREE;
  const double spacing = std::max(pair.moving->spacing, pair.reference->spacing);
  ++row.trials;
  row.seconds.push_back(outcome.seconds);
  if (!outcome.accepted) {
    ++row.refused;
    return;
  }
  ++(error <= TOLERANCE + SPACINGS * spacing && turn <= TURN ? row.right : row.wrong);
  row.errors.push_back(error);
  row.turns.push_back(turn);
  row.surprises.push_back(surpriseOf(outcome, pair.truth));
}

void merge(Row& total, const Row& row) {
  total.trials += row.trials, total.right += row.right;
  total.wrong += row.wrong, total.refused += row.refused;
  const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(total.errors, row.errors), append(total.turns, row.turns);
  append(total.seconds, row.seconds), append(total.surprises, row.surprises);
}

void tell(const Benchmark& benchmark, const std::string& trial, const Outcome& outcome) {
  if (!benchmark.verbose) return;
  std::printf("    %-40s %s\n", trial.c_str(),
              outcome.accepted ? ("by " + outcome.how).c_str() : outcome.refusal.c_str());
}

void benchmarkPairs(const std::vector<Pair>& pairs, Benchmark& benchmark) {
  std::vector<std::pair<std::string, Method>> methods{{"SegmentICP", bySegments}};
  if (benchmark.peers)
    methods.insert(methods.end(), {{"PCL GICP", byGicp}, {"PCL NDT", byNdt}, {"PCL plane ICP", byPlaneIcp}});
  for (const auto& [method_name, method] : methods) {
    for (const Pair& pair : pairs) {
      Random random(benchmark.seed, core::RandomStream::ROUTE);
      Row row;
      for (const double shift : {pair.kind->near, pair.kind->far})
        for (unsigned n = 0; n < benchmark.repeats; ++n) {
          const double turn = shift == pair.kind->near ? 1 : 4;
          const Eigen::Isometry3d guess = perturbed(pair, shift, turn, n % 2 == 1, random);
          const Outcome outcome = method(*pair.reference, *pair.moving, guess, *pair.kind);
          const std::size_t wrong = row.wrong;
          add(row, outcome, pair);
          tell(benchmark, row.wrong > wrong ? "WRONG" : shift == pair.kind->near ? "near" : "far", outcome);
        }
      print(method_name + ": " + pair.name, row);
      merge(benchmark.total[method_name + ", " + pair.kind->name], row);
      merge(benchmark.total[method_name + ", all"], row);
    }
  }
}

/// Any acceptance is wrong.
void addImpossible(Row& row, const Outcome& outcome) {
  ++row.trials;
  ++(outcome.accepted ? row.wrong : row.refused);
  row.seconds.push_back(outcome.seconds);
}

/// Scans of different pairs laid on each other, ground on ground, amid, at any heading.
void benchmarkCrossed(const std::vector<Pair>& pairs, Benchmark& benchmark) {
  Row row;
  Random random(benchmark.seed, core::RandomStream::SELECTION);
  for (const Pair& a : pairs)
    for (const Pair& b : pairs) {
      if (a.reference == b.reference || a.reference == b.moving) continue;
      const double heading = random.uniform(-180, 180);
      const Eigen::Vector3d way = 0.2 * anyDirection(random);
      const Eigen::Isometry3d guess = Eigen::Translation3d(way + a.reference->centre) *
                                      Eigen::AngleAxisd(heading * DEGREE, Eigen::Vector3d::UnitZ()) *
                                      Eigen::Translation3d(-b.moving->centre);
      const Outcome outcome = bySegments(*a.reference, *b.moving, guess, *a.kind);
      tell(benchmark, b.moving->name + " on " + a.reference->name, outcome);
      addImpossible(row, outcome);
    }
  print("SegmentICP: different places", row);
}

/// Pairs of which the moving scan is seen in a mirror.
void benchmarkMirrored(const std::vector<Pair>& pairs, Benchmark& benchmark) {
  Row row;
  Random random(benchmark.seed, core::RandomStream::NOISE);
  for (const Pair& pair : pairs)
    for (const int axis : {0, 1}) {
      Scan mirrored = *pair.moving;
      mirrored.cloud.reset(new Cloud(*pair.moving->cloud));
      for (pcl::PointXYZ& point : *mirrored.cloud) {
        float& coordinate = axis == 0 ? point.x : point.y;
        coordinate = 2 * static_cast<float>(mirrored.centre[axis]) - coordinate;
      }
      const Eigen::Isometry3d guess = perturbed(pair, pair.kind->near, 1, false, random);
      const Outcome outcome = bySegments(*pair.reference, mirrored, guess, *pair.kind);
      tell(benchmark, pair.name, outcome);
      addImpossible(row, outcome);
    }
  print("SegmentICP: mirrored", row);
}

}  // namespace

int main(int argc, char** argv) try {
  Benchmark benchmark;
  std::string data = std::getenv("PCL_FFT_GROUND_DATA") == nullptr ? "" : std::getenv("PCL_FFT_GROUND_DATA");
  std::string only, rows = "pairs,crossed,mirrored";
  bool quick = false, alone = false;
  po::options_description options(
      "real_pairs_benchmark: real pairs of scans, aligned from perturbed guesses");
  auto options_to = options.add_options();
  options_to("data", po::value(&data),
             "folder with pairs/*/{ref.pcd,mov.pcd,truth.txt} (PCL_FFT_GROUND_DATA)");
  options_to("seed", po::value(&benchmark.seed)->default_value(benchmark.seed), "of the guesses");
  options_to("repeats", po::value(&benchmark.repeats)->default_value(benchmark.repeats),
             "guesses of a pair, a direction and a distance; every other one is tilted, too");
  options_to("only", po::value(&only)->default_value(""), "only pairs with this in their name");
  options_to("rows", po::value(&rows)->default_value(rows), "any of pairs, crossed, mirrored");
  options_to("alone", po::bool_switch(&alone), "without PCL's methods");
  options_to("quick", po::bool_switch(&quick), "one guess each, PCL's methods and crossed pairs left out");
  options_to("verbose", po::bool_switch(&benchmark.verbose), "says what came of each trial");
  options_to("help", "show this text");
  po::variables_map values;
  po::store(po::parse_command_line(argc, argv, options), values);
  po::notify(values);
  if (values.count("help") != 0) {
    std::cout << options
              << "\nRight: within 5 cm and three spacings amid the moving scan, and 2 degrees. PCL's "
              << "methods are accepted where they converge;\ntheir settings for each kind of scene:\n";
    for (const Kind& kind : KINDS)
      std::cout << "  " << kind.name << " (up to " << kind.largest << " m): voxels of " << kind.leaf
                << " m, reach (NDT: cells) " << kind.reach << " m; guesses off by " << kind.near
                << " m and 1, " << kind.far << " m and 4 degrees\n";
    return 0;
  }
  if (!std::filesystem::exists(data + "/pairs")) {
    std::cerr << "real_pairs_benchmark: no pairs in '" << data << "': give --data or PCL_FFT_GROUND_DATA\n";
    return 2;
  }
  if (quick) benchmark.repeats = 1, rows = "pairs,mirrored";
  benchmark.peers = !quick && !alone;
  pcl::console::setVerbosityLevel(pcl::console::L_ERROR);
  const std::vector<Pair> pairs = readPairs(data + "/pairs", only);
  if (benchmark.verbose)
    for (const Pair& pair : pairs)
      std::printf("%-44s %s, %.1f m, spacing %.4f m\n", pair.name.c_str(), pair.kind->name,
                  pair.reference->extent, pair.reference->spacing);
  std::printf("%-44s %5s %5s %5s %7s %8s %8s %6s %7s\n", "", "pairs", "right", "wrong", "refused", "mm",
              "degrees", "NEES", "s");
  if (rows.find("pairs") != std::string::npos) benchmarkPairs(pairs, benchmark);
  if (rows.find("crossed") != std::string::npos) benchmarkCrossed(pairs, benchmark);
  if (rows.find("mirrored") != std::string::npos) benchmarkMirrored(pairs, benchmark);
  std::printf("\n");
  for (const auto& [name, row] : benchmark.total) print(name, row);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "real_pairs_benchmark: " << error.what() << "\n";
  return 2;
}
