#include "simulate_command.h"

#include <algorithm>
#include <array>
#include <boost/program_options.hpp>
#include <cstring>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>

#include "cloud_fields.h"
#include "command_line.h"
#include "errors.h"
#include "pcd_cloud.h"
#include "pcl_fft_ground/core/simulation.h"
#include "segment_report.h"

namespace pcl_fft_ground::cli {

namespace {

namespace po = boost::program_options;

constexpr const char* help_before = R"(Usage: pcl_fft_ground simulate wreck|pipes|reef -o FILE [options]

Simulates one scan of the sea floor whose truth is known: what a structured-light laser 3 m above the bottom
sees. wreck is 4 m x 4 m with amphorae, half buried, alone or piled, on a mound; pipes is 6 m x 1.5 m of flat to
gently rolling bottom with pipe segments; reef is 4 m x 4 m of undulating ground with boulders. The file is a
binary PCD with x y z [m], label (0 ground, 1 object, 2 neither: outliers, and object points lower than four
standard deviations of the noise) and segment (number of the object, 0 none); its VIEWPOINT is the true pose.
Equal seeds give equal files.

)";

constexpr const char* help_after = R"(
Example: a thinner scan of a crowded wreck, with some of the bottom missing, for the segmentation to find:
  pcl_fft_ground simulate wreck -o wreck.pcd --seed 7 --points 200000 --object-share 0.6 --gap-share 0.05
  pcl_fft_ground segment wreck.pcd -o result --max-object-size 1
)";

struct Request {
  core::SimulationParameters parameters;
  long long seed = parameters.seed;
  long long points = static_cast<long long>(parameters.points);
  std::string scene;
  std::string output;
  bool help = false;
  bool quiet = false;
  bool json = false;
};

po::options_description describeOptions(Request& request) {
  core::SimulationParameters& p = request.parameters;
  const auto number = [](auto& value) { return po::value(&value)->default_value(value); };
  const auto share = [](double& value, const char* shown) {
    return po::value(&value)->default_value(value, shown)->value_name("SHARE");
  };
  po::options_description options("Options", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add = options.add_options();
  add("output,o", po::value(&request.output)->value_name("FILE"), "PCD file to write; its folder exists");
  add("seed", number(request.seed)->value_name("N"), "equal seeds give equal scans: 0 to 4294967295");
  add("points", number(request.points)->value_name("N"), "number of points: 1 to 100000000");
  add("object-share", share(p.object_share, "0.5"), "object points among ground and object points: 0 to 0.8");
  add("noise", po::value(&p.noise)->default_value(p.noise, "0.003")->value_name("M"),
      "standard deviation of the range [m]: 0 to 0.1");
  add("gap-share", share(p.gap_share, "0"), "share of the footprint without points: 0 to 0.9");
  add("outlier-share", share(p.outlier_share, "0"), "points that are up to 10 m off: 0 to 0.5");
  add("tilt", po::value(&p.tilt_degrees)->default_value(p.tilt_degrees, "0")->value_name("DEG"),
      "turn of the whole scan about its x axis [degrees]: -45 to 45");
  add("quiet", po::bool_switch(&request.quiet), "print nothing");
  add("json", po::bool_switch(&request.json), "print the summary as JSON");
  add("help,h", po::bool_switch(&request.help), "show this text");
  return options;
}

/// A count, read as a signed number because the parser would take -1 for the largest unsigned one.
template <typename Count>
Count toCount(const char* option, long long value, long long most) {
  if (value < 0 || value > most)
    throw UsageError(std::string("--") + option + " " + std::to_string(value) +
                     ": allowed is a whole number from 0 to " + std::to_string(most));
  return static_cast<Count>(value);
}

core::SceneKind sceneNamed(const std::string& name) {
  if (name == "wreck") return core::SceneKind::WRECK;
  if (name == "pipes") return core::SceneKind::PIPES;
  if (name == "reef") return core::SceneKind::REEF;
  throw UsageError("simulate: scene '" + name + "': allowed is wreck, pipes or reef");
}

void parse(const std::vector<std::string>& arguments, const po::options_description& options,
           Request& request) {
  po::options_description all;
  all.add(options).add_options()("scene", po::value(&request.scene));
  po::positional_options_description positional;
  positional.add("scene", 1);
  parseArguments("simulate", arguments, all, positional);
}

void checkComplete(Request& request) {
  if (request.scene.empty()) throw UsageError("simulate: no scene given: allowed is wreck, pipes or reef");
  request.parameters.scene = sceneNamed(request.scene);
  request.parameters.seed = toCount<std::uint32_t>("seed", request.seed, 4294967295);
  request.parameters.points = toCount<std::size_t>("points", request.points, 100000000);
  if (request.output.empty()) throw UsageError("simulate: no output given: name a PCD file by -o FILE");
}

/// The option that sets a parameter of the core, for its messages.
std::string asOption(std::string message) {
  const std::size_t end = message.find(' ');
  std::string name = message.substr(0, end);
  if (name == "tilt_degrees") name = "tilt";
  std::replace(name.begin(), name.end(), '_', '-');
  return "--" + name + message.substr(end);
}

core::SimulatedScan simulate(const core::SimulationParameters& parameters) {
  try {
    return core::simulateScan(parameters);
  } catch (const std::invalid_argument& error) {
    throw UsageError(asOption(error.what()));
  }
}

pcl::PCLPointCloud2 asCloud(const core::SimulatedScan& scan) {
  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z"}) appendField(cloud, name, pcl::PCLPointField::FLOAT32, 1);
  allocatePoints(cloud, scan.labels.size(), 1);
  for (std::size_t i = 0; i < scan.labels.size(); ++i) {
    const Eigen::Vector3f point = scan.points.col(static_cast<Eigen::Index>(i));
    std::memcpy(cloud.data.data() + i * cloud.point_step, point.data(), sizeof(float) * 3);
  }
  setInt32Field(cloud, "label", scan.labels);
  setInt32Field(cloud, "segment", scan.segments);
  return cloud;
}

void write(const core::SimulatedScan& scan, const std::string& path) {
  Eigen::Vector4f position = Eigen::Vector4f::Zero();
  position.head<3>() = scan.world_from_scan.translation().cast<float>();
  const Eigen::Quaternionf orientation(Eigen::Quaterniond(scan.world_from_scan.linear()).cast<float>());
  writePcd(path, asCloud(scan), position, orientation);
}

struct Summary {
  std::size_t points;
  std::size_t objects;  ///< seen by the scanner
  double object_share;  ///< among ground and object points
};

Summary summarise(const core::SimulatedScan& scan) {
  const std::set<std::int32_t> segments(scan.segments.begin(), scan.segments.end());
  const auto count = [&](std::int32_t label) {
    return static_cast<double>(std::count(scan.labels.begin(), scan.labels.end(), label));
  };
  const double judged = count(0) + count(1);
  return {scan.labels.size(), segments.size() - segments.count(0), judged > 0.0 ? count(1) / judged : 0.0};
}

void printJson(const Request& request, const Summary& summary) {
  const nlohmann::ordered_json report = {{"file", request.output},
                                         {"scene", request.scene},
                                         {"seed", request.parameters.seed},
                                         {"points", summary.points},
                                         {"object_share", summary.object_share},
                                         {"objects", summary.objects}};
  std::cout << asText(report);
}

void printLine(const Request& request, const Summary& summary) {
  std::cout << request.scene << ": " << summary.points << " points, " << std::fixed << std::setprecision(1)
            << 100.0 * summary.object_share << " % on " << summary.objects << " objects, written to "
            << request.output << "\n";
}

}  // namespace

void runSimulate(const std::vector<std::string>& arguments) {
  Request request;
  const po::options_description options = describeOptions(request);
  parse(arguments, options, request);
  if (request.help) {
    std::cout << help_before << options << help_after;
    return;
  }
  checkComplete(request);
  const core::SimulatedScan scan = simulate(request.parameters);
  write(scan, request.output);
  const Summary summary = summarise(scan);
  if (request.json) {
    printJson(request, summary);
  } else if (!request.quiet) {
    printLine(request, summary);
  }
}

}  // namespace pcl_fft_ground::cli
