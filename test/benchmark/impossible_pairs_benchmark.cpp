// How many alignments are accepted where none may be: scans of different places laid on each other, simulated
// and real, scans seen in a mirror, and patterns that fit at many places. Every acceptance is wrong, and is
// printed with what it takes to see it again.

#include <pcl/console/print.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "io/cloud_file.h"
#include "pcl_fft_ground/core/align/segment_alignment.h"
#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/simulation/survey_simulation.h"
#include "simulation/simulation_random.h"

namespace {

namespace cli = pcl_fft_ground::cli;
namespace core = pcl_fft_ground::core;
namespace fs = std::filesystem;
namespace po = boost::program_options;
using core::Points;
using core::Random;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

constexpr double DEGREE = 3.14159265358979323846 / 180;

struct Request {
  std::string data;
  std::size_t attempts = 1000;  ///< of each family
  Eigen::Index points = 12000;  ///< of a scan at most
  unsigned seed = 1, surveys = 4;
  std::string only;
  std::optional<std::size_t> attempt;  ///< only this one of each family
};

/// A scan, and the place that it shows.
struct Scan {
  std::string name, place;
  core::ScanSegments described, mirrored;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double extent = 0;  ///< the larger horizontal one [m]
};

/// Scans of which any two of different places may be laid on each other.
struct Family {
  std::string name;
  std::vector<Scan> scans;
  bool is_lattice = false;  ///< two scans of one place fit at many
  bool is_mirrored = false;
};

Points thinned(const Points& points, Eigen::Index most) {
  const Eigen::Index one_in = std::max<Eigen::Index>(1, (points.cols() + most - 1) / most);
  Points result(3, points.cols() / one_in);
  for (Eigen::Index n = 0; n < result.cols(); ++n) result.col(n) = points.col(n * one_in);
  return result;
}

core::ScanSegments described(const Points& points) {
  Cloud::Ptr cloud(new Cloud);
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    cloud->push_back({points(0, n), points(1, n), points(2, n)});
  pcl_fft_ground::FFTGroundSegmentation<pcl::PointXYZ> filter;
  filter.setInputCloud(cloud);
  pcl::PointIndices ground, objects;
  filter.segment(ground, objects);
  core::Labels labels(cloud->size(), core::Label::GROUND);
  for (const pcl::index_t n : objects.indices) labels[static_cast<std::size_t>(n)] = core::Label::OBJECT;
  return core::describeScan(points, labels);
}

Scan makeScan(const std::string& name, const std::string& place, const Points& points, bool with_mirror) {
  Scan scan{name, place, described(points), {}};
  if (with_mirror) {
    Points mirrored = points;
    mirrored.row(0) *= -1;
    scan.mirrored = described(mirrored);
  }
  scan.middle = points.cast<double>().rowwise().mean();
  scan.extent =
      static_cast<double>((points.rowwise().maxCoeff() - points.rowwise().minCoeff()).head<2>().maxCoeff());
  return scan;
}

Family simulated(const char* name, core::SceneKind kind, const Request& request) {
  Family family{name, {}};
  for (unsigned n = 0; n < request.surveys; ++n) {
    core::SurveyParameters parameters = core::surveyParametersFor(kind);
    parameters.seed = 5000 + 100 * request.seed + n;
    parameters.points = static_cast<std::size_t>(request.points);
    const core::SurveySimulation survey(parameters);
    const std::string place = std::string(name) + " " + std::to_string(parameters.seed);
    for (std::size_t k = 0; k < survey.size(); ++k)
      family.scans.push_back(
          makeScan(place + "/" + std::to_string(k), place, survey.submap(k).scan.points, true));
  }
  return family;
}

/// What repeats itself on a level floor.
struct Pattern {
  enum { LATTICE, RINGS, WAVES } kind = LATTICE;
  double pitch = 0.5;   ///< between equal things; of rings along the circle 2.5 m wide [m]
  double skew = 0;      ///< by which each row of a lattice is shifted, in pitches
  double radius = 0.1;  ///< of the half spheres [m]; of waves twice the height
  double noise = 0.001;

  double heightAt(double x, double y) const {
    const auto halfSphere = [this](double dx, double dy) {
      return std::sqrt(std::max(0.0, radius * radius - dx * dx - dy * dy));
    };
    if (kind == WAVES)
      return 0.5 * radius * std::cos(2 * M_PI * x / pitch) * std::cos(2 * M_PI * (y - skew * x) / pitch);
    if (kind == RINGS) {
      constexpr double BREADTH = 2.5, RADII[] = {0.8, 1.25, 1.7};
      const double step = 2 * M_PI / std::round(M_PI * BREADTH / pitch);
      const double angle = step * std::round(std::atan2(y, x) / step);
      double height = 0;
      for (const double ring : RADII)
        height = std::max(height, halfSphere(x - ring * std::cos(angle), y - ring * std::sin(angle)));
      return height;
    }
    const double row = std::round(y / pitch), shifted = x + skew * pitch * row;
    return halfSphere(shifted - std::round(shifted / pitch) * pitch, y - row * pitch);
  }
};

/// A window on a pattern, 4 m wide, at a place drawn; rings are seen from their centre.
Points windowOn(const Pattern& pattern, const Request& request, Random& random) {
  constexpr double SIDE = 4;
  const bool has_centre = pattern.kind == Pattern::RINGS;
  const double x0 = has_centre ? 0 : random.uniform(0, pattern.pitch),
               y0 = has_centre ? 0 : random.uniform(0, pattern.pitch);
  Points points(3, request.points);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const double x = random.uniform(-SIDE / 2, SIDE / 2), y = random.uniform(-SIDE / 2, SIDE / 2);
    const double height = pattern.heightAt(x + x0, y + y0) + random.normal(pattern.noise);
    points.col(n) = Eigen::Vector3d(x, y, height).cast<float>();
  }
  return points;
}

/// Patterns of a kind, so narrow that navigation allows several places at which each fits.
Family repeated(const char* name, Pattern pattern, const Request& request) {
  Family family{name, {}, true};
  Random random(request.seed, core::RandomStream::SELECTION);
  constexpr int PATTERNS = 12, WINDOWS = 4;
  for (int n = 0; n < PATTERNS; ++n) {
    pattern.skew = 0.25 * (n % 3);
    pattern.noise = 0.001 * (1 + n % 3);
    if (pattern.kind == Pattern::RINGS) {
      pattern.pitch = random.uniform(0.12, 0.17);  // 5.5 to 7.8 degrees
      pattern.radius = random.uniform(0.03, 0.05);
    } else {
      pattern.pitch = random.uniform(0.35, 0.6);
      pattern.radius = random.uniform(0.1, 0.35) * pattern.pitch;
    }
    const std::string place = std::string(name) + " " + std::to_string(n);
    for (int k = 0; k < WINDOWS; ++k)
      family.scans.push_back(
          makeScan(place + "/" + std::to_string(k), place, windowOn(pattern, request, random), false));
  }
  return family;
}

Points finitePoints(const fs::path& path) {
  const cli::Cloud cloud = cli::readCloud(path.string());
  Points points(3, static_cast<Eigen::Index>(cloud.points->size()));
  Eigen::Index count = 0;
  for (const auto& point : *cloud.points)
    if (std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z))
      points.col(count++) = point.getVector3fMap();
  points.conservativeResize(Eigen::NoChange, count);
  return points;
}

/// Windows side by side: different places of the same kind of land.
void addWindows(const fs::path& path, const Request& request, Family& family) {
  constexpr int WINDOWS = 3;  // along a side
  constexpr Eigen::Index FEWEST = 2000;
  const Points points = finitePoints(path);
  const Eigen::Array2f low = points.topRows<2>().rowwise().minCoeff(),
                       side = (points.topRows<2>().rowwise().maxCoeff().array() - low) / WINDOWS;
  std::vector<std::vector<Eigen::Index>> members(WINDOWS * WINDOWS);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Eigen::Array2f cell = (points.col(n).head<2>().array() - low) / side;
    const int x = std::min(WINDOWS - 1, static_cast<int>(cell.x())),
              y = std::min(WINDOWS - 1, static_cast<int>(cell.y()));
    members[static_cast<std::size_t>(x * WINDOWS + y)].push_back(n);
  }
  for (std::size_t w = 0; w < members.size(); ++w) {
    if (static_cast<Eigen::Index>(members[w].size()) < FEWEST) continue;
    Points window = points(Eigen::all, members[w]);
    const Eigen::Vector3f middle = window.rowwise().mean();
    window.colwise() -= middle;
    const std::string name = path.stem().string() + "/" + std::to_string(w);
    family.scans.push_back(makeScan(name, name, thinned(window, request.points), true));
  }
}

Family windowsOfLand(const Request& request) {
  Family family{"windows of real scans", {}};
  for (const char* folder : {"land", "isprs", "oakland", "mosd", "underwater"}) {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(fs::path(request.data) / folder))
      if (entry.path().extension() == ".pcd") paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    for (const fs::path& path : paths) addWindows(path, request, family);
  }
  return family;
}

Family realPairs(const Request& request) {
  Family family{"real pairs, crossed", {}};
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(fs::path(request.data) / "pairs"))
    if (fs::exists(entry.path() / "ref.pcd")) folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  for (const fs::path& folder : folders)
    for (const char* file : {"ref.pcd", "mov.pcd"}) {
      const std::string place = folder.filename().string();
      family.scans.push_back(makeScan(place + "/" + file, place,
                                      thinned(finitePoints(folder / file), 2 * request.points), true));
    }
  return family;
}

/// What came of a family.
struct Row {
  std::size_t attempts = 0, accepted = 0;
  double seconds = 0;
};

/// Tries one pair at any heading, ground on ground, the middles near each other.
void tryPair(const Family& family, const Scan& moving, const core::ScanSegments& moving_scan,
             const Scan& reference, const Request& request, Random& random, Row& row) {
  constexpr double FARTHEST = 0.25;  // of the smaller extent
  core::AlignmentParameters parameters;
  parameters.relief = core::ReliefUse::AUTO;
  parameters.gates =
      core::gatesOf(row.attempts % 2 == 0 ? core::SearchMode::NAVIGATION : core::SearchMode::WIDE);
  const double reach = FARTHEST * std::min(moving.extent, reference.extent);
  const double heading = family.is_lattice ? random.uniform(-20, 20) : random.uniform(-180, 180);
  const double x = random.uniform(-reach, reach), y = random.uniform(-reach, reach);
  Eigen::Vector3d middle = moving.middle;
  if (&moving_scan == &moving.mirrored) middle.x() *= -1;
  const Eigen::Isometry3d guess = Eigen::Translation3d(reference.middle + Eigen::Vector3d(x, y, 0)) *
                                  Eigen::AngleAxisd(heading * DEGREE, Eigen::Vector3d::UnitZ()) *
                                  Eigen::Translation3d(-middle);
  if (request.attempt && *request.attempt != row.attempts++) return;
  const std::clock_t begun = std::clock();
  const core::Alignment alignment = core::alignScans(moving_scan, reference.described, guess, parameters);
  row.seconds += static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  if (!request.attempt) ++row.attempts;
  if (!alignment.accepted) return;
  ++row.accepted;
  constexpr const char* METHODS[] = {"none", "segments", "dense", "relief"};
  std::printf(
      "  accepted: %s%s on %s, attempt %zu, by %s, score %.2f, overlap %.2f, guess %.3f %.3f %.2f deg\n",
      moving.name.c_str(), family.is_mirrored ? " mirrored" : "", reference.name.c_str(), row.attempts - 1,
      METHODS[static_cast<int>(alignment.method)], alignment.score, alignment.overlap, x, y, heading);
  std::fflush(stdout);
}

void print(const std::string& name, std::size_t scans, const Row& row) {
  if (row.attempts == 0) return;
  const auto attempts = static_cast<double>(row.attempts);
  std::printf("%-40s %6zu %9zu %9zu %8.4f\n", name.c_str(), scans, row.attempts, row.accepted,
              row.seconds / attempts);
  std::fflush(stdout);
}

bool mayBeLaidOnEachOther(const Family& family, const Scan& a, const Scan& b) {
  constexpr double ALIKE = 3;  // ratio of extents: scans of quite other sizes are refused at once
  if (family.is_mirrored) return &a == &b || a.place == b.place;
  if (std::max(a.extent, b.extent) > ALIKE * std::min(a.extent, b.extent)) return false;
  return family.is_lattice ? a.place == b.place && &a != &b : a.place != b.place;
}

Row attemptAll(const Family& family, const Request& request) {
  Row row;
  Random random(request.seed, core::RandomStream::ROUTE);
  std::size_t draws = 0;
  while (row.attempts < request.attempts && draws++ < 1000 * request.attempts) {
    const auto draw = [&] {
      const double n = random.uniform(0, static_cast<double>(family.scans.size()));
      return std::min(static_cast<std::size_t>(n), family.scans.size() - 1);
    };
    const Scan &moving = family.scans[draw()], &reference = family.scans[draw()];
    if (!mayBeLaidOnEachOther(family, moving, reference)) continue;
    tryPair(family, moving, family.is_mirrored ? moving.mirrored : moving.described, reference, request,
            random, row);
  }
  print(family.name, family.scans.size(), row);
  return row;
}

void runAll(const Request& request) {
  std::printf("%-40s %6s %9s %9s %8s\n", "", "scans", "attempts", "accepted", "s each");
  std::vector<Family> families;
  const auto wants = [&](const char* name) {
    return std::string(name).find(request.only) != std::string::npos;
  };
  if (wants("pipes")) families.push_back(simulated("pipes", core::SceneKind::PIPES, request));
  if (wants("wreck")) families.push_back(simulated("wreck", core::SceneKind::WRECK, request));
  if (wants("bare")) families.push_back(simulated("bare", core::SceneKind::BARE, request));
  if (wants("lattices")) families.push_back(repeated("lattices", {Pattern::LATTICE}, request));
  if (wants("rings")) families.push_back(repeated("rings", {Pattern::RINGS}, request));
  if (wants("waves")) families.push_back(repeated("waves", {Pattern::WAVES}, request));
  if (!request.data.empty()) {
    if (wants("windows")) families.push_back(windowsOfLand(request));
    if (wants("real pairs")) families.push_back(realPairs(request));
  }
  Row total;
  std::size_t scans = 0;
  const auto add = [&](const Row& row) {
    total.attempts += row.attempts, total.accepted += row.accepted, total.seconds += row.seconds;
  };
  for (Family& family : families) {
    scans += family.scans.size();
    add(attemptAll(family, request));
    if (family.is_lattice) continue;
    family.is_mirrored = true;
    family.name += ", mirrored";
    add(attemptAll(family, request));
  }
  print("all", scans, total);
  if (total.accepted == 0 && total.attempts > 0)
    std::printf(
        "none of them: a rate below %.1e at 95 %%, were the attempts independent; pairs of one scan are "
        "not\n",
        3.0 / static_cast<double>(total.attempts));
}

}  // namespace

int main(int argc, char** argv) try {
  Request request;
  if (const char* data = std::getenv("PCL_FFT_GROUND_DATA")) request.data = data;
  po::options_description options("impossible_pairs_benchmark: alignments that none may be accepted of");
  auto add = options.add_options();
  add("data", po::value(&request.data),
      "folder of real scans (PCL_FFT_GROUND_DATA); without it simulated only");
  add("attempts", po::value(&request.attempts)->default_value(request.attempts), "of each family");
  add("points", po::value(&request.points)->default_value(request.points), "of a scan, at most");
  add("surveys", po::value(&request.surveys)->default_value(request.surveys), "simulated of each kind");
  add("seed", po::value(&request.seed)->default_value(request.seed), "of sites and guesses");
  add("only", po::value(&request.only)->default_value(""),
      "a family by part of its name: pipes, wreck, bare, lattices, rings, waves, windows, real pairs");
  add("attempt", po::value<std::size_t>(), "only this one of each family, to see it again");
  add("help", "show this text");
  po::variables_map values;
  po::store(po::parse_command_line(argc, argv, options), values);
  po::notify(values);
  if (values.count("attempt") != 0) request.attempt = values["attempt"].as<std::size_t>();
  if (values.count("help") != 0) {
    std::cout << options << "Every other attempt is by the wide search; relief is asked, too.\n";
    return 0;
  }
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  runAll(request);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "impossible_pairs_benchmark: " << error.what() << "\n";
  return 2;
}
