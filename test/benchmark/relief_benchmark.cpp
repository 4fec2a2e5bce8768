// How many pairs of scans are aligned by the relief of the ground alone, how well, and how many wrongly: bare
// simulated surveys, cuts of real scans into disjoint points, surveys read from files, and pairs of different
// places, where every acceptance is wrong.

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/cloud_file.h"
#include "pcl_fft_ground/core/align/relief_alignment.h"
#include "pcl_fft_ground/core/align/rigid_fit.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"
#include "pcl_fft_ground/core/survey/pairing.h"
#include "pcl_fft_ground/core/survey/survey_tables.h"
#include "pcl_fft_ground/simulation/survey_simulation.h"
#include "simulation/simulation_random.h"

namespace {

namespace core = pcl_fft_ground::core;
namespace cli = pcl_fft_ground::cli;
namespace po = boost::program_options;
using core::Points;
using core::Random;

constexpr double DEGREE = 3.14159265358979323846 / 180;

/// Two scans to be aligned.
struct Trial {
  std::string name;
  const Points* moving;
  const Points* reference;
  Eigen::Isometry3d guess;                 ///< reference_from_moving
  std::optional<Eigen::Isometry3d> truth;  ///< nothing: they do not belong together
  core::SearchGates gates;
  double tolerance = 0;  ///< within which a result is right [m]
  double turn = 1;       ///< the same for the turn [degrees]
};

/// A line of the table.
struct Row {
  std::string name;
  std::size_t trials = 0, right = 0, wrong = 0;
  std::vector<double> errors = {}, turns = {}, seconds = {}, squares = {};
};

struct Benchmark {
  std::string only;
  std::ofstream csv;
  unsigned seed = 1, count = 100;
};

Eigen::Isometry3d turnedAbout(const Eigen::Vector3d& centre, double degrees, const Eigen::Vector3d& shift) {
  return Eigen::Translation3d(centre + shift) *
         Eigen::AngleAxisd(degrees * DEGREE, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(-centre);
}

/// Amid those points of the moving scan that lie in the reference's box, in the moving scan's frame.
Eigen::Vector3d middleOf(const Trial& trial) {
  const core::Bounds box = core::boundsOf(*trial.reference);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), all = sum;
  double count = 0;
  for (Eigen::Index n = 0; n < trial.moving->cols(); ++n) {
    const Eigen::Vector3d point = trial.moving->col(n).cast<double>();
    const Eigen::Array2d place = (trial.truth.value_or(trial.guess) * point).head<2>();
    all += point / static_cast<double>(trial.moving->cols());
    if ((place < box.low.head<2>()).any() || (place > box.high.head<2>()).any()) continue;
    sum += point;
    ++count;
  }
  return count > 0 ? Eigen::Vector3d(sum / count) : all;
}

/// Squared error over its predicted variance, per degree of freedom.
double normalisedSquare(const core::ReliefResult& result, const Eigen::Isometry3d& truth) {
  const Eigen::Isometry3d error = truth * result.reference_from_moving.inverse();
  core::Vector6d v;
  const Eigen::AngleAxisd turn(error.linear());
  v << error.translation(), turn.angle() * turn.axis();
  return v.dot(result.covariance.ldlt().solve(v)) / 6;
}

void run(const Trial& trial, Benchmark& benchmark, Row& row) {
  core::ReliefParameters parameters;
  parameters.gates = trial.gates;
  const std::clock_t begun = std::clock();
  const core::ReliefResult result =
      core::alignRelief(*trial.moving, *trial.reference, trial.guess, parameters);
  const double seconds = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  const Eigen::Vector3d middle = middleOf(trial);
  const auto off = [&](const Eigen::Isometry3d& pose) {
    return trial.truth ? (pose * middle - *trial.truth * middle).norm() : -1;
  };
  const auto turned = [&](const Eigen::Isometry3d& pose) {
    return trial.truth ? Eigen::AngleAxisd(trial.truth->linear().transpose() * pose.linear()).angle() / DEGREE
                       : -1;
  };
  const double error = off(result.reference_from_moving), turn = turned(result.reference_from_moving);
  const bool right = trial.truth && error <= trial.tolerance && turn <= trial.turn;
  ++row.trials;
  row.seconds.push_back(seconds);
  if (result.accepted && right) {
    ++row.right;
    row.errors.push_back(error);
    row.turns.push_back(turn);
    row.squares.push_back(normalisedSquare(result, *trial.truth));
  }
  if (result.accepted && !right) ++row.wrong;
  if (!benchmark.csv.is_open()) return;
  const auto line = [&](const char* kind, const core::ReliefPose& pose) {
    benchmark.csv << '"' << row.name << "\"," << trial.name << ',' << kind << ',' << result.accepted << ','
                  << off(pose.reference_from_moving) << ',' << turned(pose.reference_from_moving) << ','
                  << pose.overlap << ',' << pose.residual << ',' << pose.correlation << ',' << pose.evidence
                  << ',' << pose.distance << ',' << result.deviation / result.spacing << ','
                  << trial.tolerance << ',' << seconds << ',' << result.cell_size << ",\"" << result.refusal
                  << "\"\n";
  };
  line("best", result.best);
  for (const core::ReliefPose& rival : result.rivals) line("rival", rival);
  benchmark.csv.flush();
}

void print(const Row& row) {
  if (row.trials == 0) return;
  const auto at = [](const std::vector<double>& values, double share) {
    return core::quantileOf(values, share).value_or(0);
  };
  std::printf("%-34s %6zu %6zu %6zu %6zu %8.4g %8.4g %6.3f %6.3f %6.2f %7.3f\n", row.name.c_str(), row.trials,
              row.right, row.wrong, row.trials - row.right - row.wrong, at(row.errors, 0.5),
              at(row.errors, 0.95), at(row.turns, 0.5), at(row.turns, 0.95), at(row.squares, 0.5),
              at(row.seconds, 0.5));
  std::fflush(stdout);
}

/// A scan with its poses.
struct PlacedScan {
  std::string name;
  Points points;
  Eigen::Isometry3d world_from_scan, world_from_navigation;
};

/// Scales the ground's heights in the world; the noise stays.
void flatten(core::SimulatedScan& scan, double relief) {
  const Eigen::Isometry3d& pose = scan.world_from_scan;
  for (Eigen::Index n = 0; n < scan.points.cols(); ++n) {
    const Eigen::Vector3d point = scan.points.col(n).cast<double>();
    const Eigen::Vector3d ground(point.x(), point.y(),
                                 static_cast<double>(scan.ground_heights[static_cast<std::size_t>(n)]));
    const Eigen::Vector3d lift(0, 0, (relief - 1) * (pose * ground).z());
    scan.points.col(n) = (point + pose.linear().transpose() * lift).cast<float>();
  }
}

std::vector<PlacedScan> bareSurvey(unsigned seed, double relief) {
  core::SurveyParameters parameters = core::surveyParametersFor(core::SceneKind::BARE);
  parameters.seed = seed;
  const core::SurveySimulation simulation(parameters);
  std::vector<PlacedScan> survey;
  for (std::size_t n = 0; n < simulation.size(); ++n) {
    core::SimulatedSubmap submap = simulation.submap(n);
    if (relief != 1) flatten(submap.scan, relief);
    survey.push_back({std::to_string(seed) + "/" + std::to_string(n), std::move(submap.scan.points),
                      submap.scan.world_from_scan, submap.world_from_navigation});
  }
  return survey;
}

std::vector<core::SubmapPair> pairsOf(const std::vector<PlacedScan>& survey, double least_overlap) {
  std::vector<core::ScanCoverage> coverages;
  std::vector<Eigen::Isometry3d> poses;
  for (const PlacedScan& scan : survey) {
    coverages.push_back(core::coverageOf(scan.points, 2.5 * core::voxelSizeFor(scan.points) / 2.5));
    poses.push_back(scan.world_from_scan);
  }
  return core::otherOverlappingPairs(coverages, poses, {}, least_overlap);
}

core::SearchGates gatesFor(double shift, double turn) {
  core::SearchGates gates;
  gates.max_shift = gates.max_rise = shift;
  gates.max_turn = turn;
  return gates;
}

/// Bare surveys by navigation, flatter and flatter.
void benchmarkBare(Benchmark& benchmark) {
  for (const double relief : {1.0, 0.3, 0.1, 0.03}) {
    Row row{"bare, relief x " + std::to_string(relief).substr(0, 4)}, far{row.name + ", 4 m 8 deg"},
        other{row.name + ", other place"};
    if (row.name.find(benchmark.only) == std::string::npos) continue;
    Random random(benchmark.seed, core::RandomStream::NOISE);
    const unsigned surveys = std::max(1U, benchmark.count / 50);
    for (unsigned k = 0; k < surveys; ++k) {
      const auto survey = bareSurvey(benchmark.seed + k, relief);
      for (const core::SubmapPair& pair : pairsOf(survey, 0.15)) {
        const PlacedScan &m = survey[pair.moving], &r = survey[pair.reference];
        Trial trial{m.name + " on " + r.name,
                    &m.points,
                    &r.points,
                    r.world_from_navigation.inverse() * m.world_from_navigation,
                    r.world_from_scan.inverse() * m.world_from_scan,
                    gatesFor(2.5, 5),
                    0.25};
        run(trial, benchmark, row);
        if (relief < 1) continue;
        const double angle = random.uniform(0, 360 * DEGREE), turn = random.chance(0.5) ? 8 : -8;
        trial.guess =
            turnedAbout(*trial.truth * middleOf(trial), turn, {4 * std::cos(angle), 4 * std::sin(angle), 0}) *
            *trial.truth;
        trial.gates = gatesFor(5, 10);
        run(trial, benchmark, far);
      }
      for (std::size_t n = 0; n + 7 < survey.size(); ++n) {
        const PlacedScan &m = survey[n], &r = survey[n + 7];
        const double x = random.uniform(-10, 10), y = random.uniform(-10, 10),
                     turn = random.uniform(-180, 180);
        if ((m.world_from_scan.translation() - r.world_from_scan.translation()).head<2>().norm() < 45)
          continue;
        run({m.name + " on " + r.name,
             &m.points,
             &r.points,
             turnedAbout({0, 0, 0}, turn, {x, y, 0}),
             {},
             gatesFor(2.5, 5)},
            benchmark, other);
      }
    }
    print(row);
    print(far);
    print(other);
  }
}

Points readPoints(const std::string& path, Eigen::Isometry3d& viewpoint) {
  const cli::Cloud cloud = cli::readCloud(path);
  Points points(3, static_cast<Eigen::Index>(cloud.points->size()));
  Eigen::Index count = 0;
  for (const auto& point : *cloud.points)
    if (std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z))
      points.col(count++) = point.getVector3fMap();
  points.conservativeResize(Eigen::NoChange, count);
  viewpoint = cloud.viewpoint.asTransform();
  return points;
}

/// A part of a scan: every point belongs to one of two halves by chance, so that two parts share none.
Points cut(const Points& points, const Eigen::AlignedBox2d& box, const Eigen::Isometry3d& part_from_scan,
           bool second, double noise, unsigned seed) {
  Random halves(seed, core::RandomStream::SELECTION),
      errors(seed + (second ? 1 : 0), core::RandomStream::NOISE);
  Points part(3, points.cols());
  Eigen::Index count = 0;
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const bool of_second = halves.chance(0.5);
    const Eigen::Vector3d point = part_from_scan * points.col(n).cast<double>();
    if (of_second != second || !box.contains(Eigen::Vector2d(point.head<2>()))) continue;
    const double x = errors.normal(noise), y = errors.normal(noise), z = errors.normal(noise);
    part.col(count++) = (point + Eigen::Vector3d(x, y, z)).cast<float>();
  }
  part.conservativeResize(Eigen::NoChange, count);
  return part;
}

double spacingOf(const Points& points) {
  const core::Bounds bounds = core::boundsOf(points);
  return std::sqrt((bounds.high - bounds.low).head<2>().prod() / static_cast<double>(points.cols()));
}

/// Two windows of a real scan, side by side, sharing `overlap` of either's area; of no overlap, apart.
void benchmarkCuts(const std::string& name, const std::string& path, double share_of_side,
                   Benchmark& benchmark) {
  if (name.find(benchmark.only) == std::string::npos) return;
  Eigen::Isometry3d unused;
  const Points scan = readPoints(path, unused);
  const core::Bounds bounds = core::boundsOf(scan);
  const Eigen::Vector3d centre = (0.5 * (bounds.low + bounds.high)).matrix();
  const Eigen::Array2d extent = (bounds.high - bounds.low).head<2>();
  for (const double overlap : {1.0, 0.8, 0.6, 0.4, 0.2, 0.0}) {
    char title[64];
    std::snprintf(title, sizeof title, "%s, overlap %.1f", name.c_str(), overlap);
    Row row{title};
    Random random(benchmark.seed, core::RandomStream::ROUTE);
    for (unsigned n = 0; n < benchmark.count; ++n) {
      // Windows along x or along y, anywhere where both fit.
      const bool along_x = random.chance(0.5);
      const double length = along_x ? extent.x() : extent.y(), breadth = along_x ? extent.y() : extent.x();
      const double side = share_of_side > 0 ? share_of_side * extent.minCoeff() : length / (2 - overlap);
      const double across = share_of_side > 0 ? side : breadth;
      const double step = side * (1 - overlap);
      const double u = random.uniform(0, 1) * std::max(0.0, length - side - step) - 0.5 * length;
      const double v = random.uniform(0, 1) * std::max(0.0, breadth - across) - 0.5 * breadth;
      const bool swapped = random.chance(0.5);
      const auto window = [&](double shift) {
        const Eigen::Vector2d low = along_x ? Eigen::Vector2d(u + shift, v) : Eigen::Vector2d(v, u + shift);
        const Eigen::Vector2d size = along_x ? Eigen::Vector2d(side, across) : Eigen::Vector2d(across, side);
        return Eigen::AlignedBox2d(low, low + size);
      };
      const Eigen::Isometry3d part_from_scan(Eigen::Translation3d(-centre));
      const unsigned seed = benchmark.seed * 1000003 + n;
      const Points probe = cut(scan, window(0), part_from_scan, false, 0, seed);
      if (probe.cols() < 50) continue;
      const double spacing = spacingOf(probe);
      const Points first = cut(scan, window(0), part_from_scan, swapped, 0.1 * spacing, seed);
      const Points second = cut(scan, window(step), part_from_scan, !swapped, 0.1 * spacing, seed);
      const double size = std::min(side, across);
      const double angle = random.uniform(0, 360 * DEGREE), turn = random.chance(0.5) ? 5 : -5;
      const Eigen::Vector3d shift(0.1 * size * std::cos(angle), 0.1 * size * std::sin(angle), 0);
      Trial trial{std::to_string(n),
                  &second,
                  &first,
                  Eigen::Isometry3d::Identity(),
                  Eigen::Isometry3d::Identity(),
                  gatesFor(0.125 * size, 6.25),
                  spacing};
      const Eigen::Vector3d middle = middleOf(trial);
      trial.guess = turnedAbout(middle, turn, shift);
      if (overlap == 0) {  // laid on each other
        const core::Bounds a = core::boundsOf(first), b = core::boundsOf(second);
        const Eigen::Vector3d between = (0.5 * (a.low + a.high - b.low - b.high)).matrix();
        trial.guess = Eigen::Translation3d(between) * trial.guess;
        trial.truth.reset();
      }
      run(trial, benchmark, row);
    }
    print(row);
  }
}

/// Sub-maps with true poses: their pairs, and those that are wrong for each other.
void benchmarkFiles(const std::string& folder, double shift, double turn, Benchmark& benchmark) {
  if (std::string("files").find(benchmark.only) == std::string::npos) return;
  std::vector<PlacedScan> scans;
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".pcd") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  for (const auto& path : paths) {
    PlacedScan scan{path.stem().string(), {}, {}, {}};
    scan.points = readPoints(path.string(), scan.world_from_scan);
    scans.push_back(std::move(scan));
  }
  Row other{"files, wrong sub-map"};
  Random random(benchmark.seed, core::RandomStream::ROUTE);
  for (std::size_t a = 0; a < scans.size(); ++a)
    for (std::size_t b = 0; b < scans.size(); ++b) {
      if (a == b) continue;
      const Eigen::Isometry3d truth = scans[b].world_from_scan.inverse() * scans[a].world_from_scan;
      Trial trial{scans[a].name + " on " + scans[b].name,
                  &scans[a].points,
                  &scans[b].points,
                  truth,
                  truth,
                  gatesFor(1.25 * shift, 5),
                  0.3};
      const double overlap = core::overlapShare(core::coverageOf(scans[b].points, 1),
                                                core::coverageOf(scans[a].points, 1), truth);
      Row row{scans[a].name + " on " + scans[b].name + " " + std::to_string(overlap).substr(0, 4)};
      for (int n = 0; n < 4; ++n) {
        const double angle = random.uniform(0, 360 * DEGREE);
        const Eigen::Vector3d error(shift * std::cos(angle), shift * std::sin(angle), 0);
        const Eigen::Vector3d middle = middleOf(trial);
        trial.guess = turnedAbout(truth * middle, random.chance(0.5) ? turn : -turn, error) * truth;
        if (overlap > 0.02) {
          trial.truth = truth;
          run(trial, benchmark, row);
        } else {
          const double along = random.uniform(-5, 5), across = random.uniform(-5, 5),
                       any = random.uniform(-180, 180);
          trial.guess = turnedAbout({0, 0, 0}, any, {along, across, 0});
          trial.truth.reset();
          run(trial, benchmark, other);
        }
      }
      print(row);
    }
  print(other);
}

/// Small grids of different seeds laid on each other.
void benchmarkDifferent(Benchmark& benchmark) {
  Row row{"different places, 10 m"};
  if (row.name.find(benchmark.only) == std::string::npos) return;
  std::vector<Points> places;
  const Eigen::AlignedBox2d box(Eigen::Vector2d(-5, -5), Eigen::Vector2d(5, 5));
  Random random(benchmark.seed, core::RandomStream::ROUTE);
  for (unsigned n = 0; places.size() < std::max(8.0, std::sqrt(3.0 * benchmark.count)); ++n)
    for (const PlacedScan& scan : bareSurvey(benchmark.seed + n, std::pow(10, random.uniform(-1, 0.3))))
      places.push_back(cut(scan.points, box, Eigen::Isometry3d::Identity(), false, 0, n));
  for (unsigned n = 0; n < benchmark.count; ++n) {
    const auto a = static_cast<std::size_t>(random.uniform(0, static_cast<double>(places.size())));
    const auto b =
        (a + 24 + static_cast<std::size_t>(random.uniform(0, static_cast<double>(places.size() - 48)))) %
        places.size();
    const double x = random.uniform(-4, 4), y = random.uniform(-4, 4), turn = random.uniform(-180, 180);
    run({std::to_string(a) + " on " + std::to_string(b),
         &places[a],
         &places[b],
         turnedAbout({0, 0, 0}, turn, {x, y, 0}),
         {},
         gatesFor(2.5, 10)},
        benchmark, row);
  }
  print(row);
}

}  // namespace

int main(int argc, char** argv) try {
  Benchmark benchmark;
  std::string data, csv;
  po::options_description options("relief_benchmark: pairs of scans aligned by the relief of the ground");
  auto add = options.add_options();
  add("data", po::value(&data)->default_value(""),
      "folder with underwater/ and surveys/bathymetry/, if there");
  add("seed", po::value(&benchmark.seed)->default_value(benchmark.seed), "of everything random");
  add("count", po::value(&benchmark.count)->default_value(benchmark.count), "trials of each row, roughly");
  add("only", po::value(&benchmark.only)->default_value(""), "only rows with this in their name");
  add("csv", po::value(&csv)->value_name("FILE"), "writes a line for each pose that was considered");
  add("help", "show this text");
  po::variables_map values;
  po::store(po::parse_command_line(argc, argv, options), values);
  po::notify(values);
  if (values.count("help") != 0) {
    std::cout << options;
    return 0;
  }
  if (!csv.empty()) {
    benchmark.csv.open(csv);
    benchmark.csv
        << "row,pair,pose,accepted,error,turn,overlap,residual,correlation,evidence,distance,deviation,"
           "tolerance,seconds,cell,refusal\n";
  }
  std::printf("%-34s %6s %6s %6s %6s %8s %8s %6s %6s %6s %7s\n", "", "pairs", "right", "wrong", "refus.",
              "median m", "95 % m", "deg", "95 %", "NEES", "s");
  benchmarkBare(benchmark);
  benchmarkDifferent(benchmark);
  if (!data.empty()) {
    benchmarkCuts("reef", data + "/underwater/reef_horseshoe_1cm.pcd", 0, benchmark);
    benchmarkCuts("reef 2 m", data + "/underwater/reef_horseshoe_1cm.pcd", 0.25, benchmark);
    benchmarkCuts("parguera", data + "/underwater/laparguera_slope.pcd", 0, benchmark);
    benchmarkFiles(data + "/surveys/bathymetry", 2, 3, benchmark);
  }
  return 0;
} catch (const std::exception& error) {
  std::cerr << "relief_benchmark: " << error.what() << "\n";
  return 2;
}
