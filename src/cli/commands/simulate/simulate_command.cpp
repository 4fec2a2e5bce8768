#include <algorithm>
#include <boost/program_options.hpp>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "command_line.h"
#include "commands/commands.h"
#include "commands/simulate/simulated_scan.h"
#include "errors.h"
#include "io/output_file.h"
#include "pcl_fft_ground/simulation/simulation.h"
#include "printable.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {

namespace {

namespace po = boost::program_options;

constexpr const char* help_before = R"(Usage: pcl_fft_ground simulate wreck|pipes|reef -o FILE [options]
       pcl_fft_ground simulate survey wreck|pipes|bare -o DIR [options]   (see `simulate survey --help`)

Simulates one scan of the sea floor whose truth is known: what a structured-light laser 3 m above the bottom
sees. wreck is 4 m x 4 m with amphorae, half buried, alone or piled, on a mound; pipes is 6 m x 1.5 m of flat to
gently rolling bottom with pipe segments; reef is 4 m x 4 m of undulating ground with boulders. The file is a
binary PCD with x y z [m], label (0 ground, 1 object, 2 neither: outliers, and object points lower than four
standard deviations of the noise) and segment (number of the object, 0 none); its VIEWPOINT is the true pose.
Equal seeds give equal files. One scan is made by one thread, whatever --threads says: the sub-maps of a survey are
shared.

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
  bool ground_heights = false;
  std::string objects;
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
  add("ground-heights", po::bool_switch(&request.ground_heights),
      "add a field 'ground': height of the true ground at each point's x and y [m], by which evaluate judges "
      "surfaces");
  add("objects", po::value(&request.objects)->value_name("FILE"),
      "CSV file to write, too: a row for each object with its number, kind, centre, axis, length, largest "
      "radius, volume "
      "above the ground and the share of it that is seen from above");
  add("quiet", po::bool_switch(&request.quiet), "print nothing");
  add("json", po::bool_switch(&request.json), "print the summary as JSON");
  addThreadsOption(options);
  add("help,h", po::bool_switch(&request.help), "show this text");
  return options;
}

core::SceneKind sceneNamed(const std::string& name) {
  if (name == "wreck") return core::SceneKind::WRECK;
  if (name == "pipes") return core::SceneKind::PIPES;
  if (name == "reef") return core::SceneKind::REEF;
  throw UsageError("simulate: scene '" + name + "': allowed is wreck, pipes or reef, or survey");
}

po::variables_map parse(const std::vector<std::string>& arguments, const po::options_description& options,
                        Request& request) {
  po::options_description all;
  all.add(options).add_options()("scene", po::value(&request.scene));
  po::positional_options_description positional;
  positional.add("scene", 1);
  return parseArguments("simulate", arguments, all, positional);
}

void checkComplete(Request& request) {
  if (request.scene.empty())
    throw UsageError("simulate: no scene given: allowed is wreck, pipes or reef, or survey");
  request.parameters.scene = sceneNamed(request.scene);
  request.parameters.seed = toCount<std::uint32_t>("seed", request.seed, 4294967295);
  request.parameters.points = toCount<std::size_t>("points", request.points, 100000000);
  if (request.output.empty()) throw UsageError("simulate: no output given: name a PCD file by -o FILE");
}

core::SimulatedScan simulate(const core::SimulationParameters& parameters) {
  core::SimulatedScan scan;
  withOptionNames([&] { scan = core::simulateScan(parameters); });
  return scan;
}

/// The truth of the objects as a table; metres, in the scan's own frame.
std::string objectTable(const core::SimulationParameters& parameters) {
  const char* const kind = parameters.scene == core::SceneKind::WRECK   ? "amphora"
                           : parameters.scene == core::SceneKind::PIPES ? "pipe"
                                                                        : "boulder";
  std::ostringstream csv;
  csv << "segment,kind,cx,cy,cz,axis_x,axis_y,axis_z,length,radius,volume,share_seen\n" << std::fixed;
  for (const core::SimulatedObject& object : core::simulatedObjects(parameters)) {
    csv << object.segment << ',' << kind << std::setprecision(4);
    for (const Eigen::Vector3d& vector : {object.centre, object.axis})
      for (const double coordinate : vector) csv << ',' << coordinate;
    csv << ',' << object.length << ',' << object.radius << ',' << std::setprecision(6) << object.volume << ','
        << std::setprecision(3) << object.share_seen << '\n';
  }
  return csv.str();
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
            << printable(request.output) << "\n";
}

}  // namespace

void runSimulate(const std::vector<std::string>& arguments) {
  if (!arguments.empty() && arguments.front() == "survey") {
    runSimulateSurvey({arguments.begin() + 1, arguments.end()});
    return;
  }
  Request request;
  const po::options_description options = describeOptions(request);
  const po::variables_map values = parse(arguments, options, request);
  if (request.help) {
    std::cout << help_before << options << help_after;
    return;
  }
  const core::Threads threads(threadsOf(values));
  checkComplete(request);
  const core::SimulatedScan scan = simulate(request.parameters);
  writeSimulatedScan(request.output, scan, scan.world_from_scan,
                     request.ground_heights ? GroundHeights::WRITE : GroundHeights::OMIT);
  if (!request.objects.empty()) writeText(request.objects, objectTable(request.parameters));
  const Summary summary = summarise(scan);
  if (request.json) {
    printJson(request, summary);
  } else if (!request.quiet) {
    printLine(request, summary);
  }
}

}  // namespace pcl_fft_ground::cli
