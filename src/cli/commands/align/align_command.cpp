#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "command_line.h"
#include "commands/align/align_report.h"
#include "commands/commands.h"
#include "errors.h"
#include "io/output_file.h"
#include "io/scanner.h"
#include "printable.h"
#include "progress.h"
#include "reading_options.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

namespace po = boost::program_options;
using nlohmann::ordered_json;

constexpr const char* HELP_BEFORE = R"(Usage: pcl_fft_ground align REFERENCE MOVING -o DIR [options]

Aligns two overlapping scans by the objects in them (S-ICP): both are segmented, segments that are the same thing are
matched, and ICP with correspondences in matched segments only moves MOVING on to REFERENCE. The files are PCD, PLY,
LAS, .bin or text, in metres, z roughly up. Where the scans lie to each other is first taken from their VIEWPOINT (the
pose of the scan by navigation) or from --guess; the default search mends 0.6 m and 8 degrees, --search wide 2.5 m and
25 degrees. --sensor X Y Z [X Y Z] says where the sensors stood, of both scans or of each in the order of the files:
what a scan could have seen is then judged by ray. What cannot be aligned with confidence is refused, and the reason
printed: a refusal is a result, too (exit status 0).
)";

constexpr const char* HELP_AFTER = R"(
DIR is made if need be and receives
  transform.txt   4 x 4 matrix that maps the coordinates of MOVING to those of REFERENCE; only if aligned
  aligned.pcd     MOVING in the coordinates of REFERENCE, with all its fields; only if aligned. Where they are large,
                  a whole-metre origin is subtracted, which alignment.json gives; the VIEWPOINT says the same
  alignment.json  the same matrix, its covariance (x y z rotation vector, about that origin), matches, score, crispness
                  (Nx), parameters
  alignment.png   both scans from above before and after: REFERENCE blue, its segments turquoise, MOVING red, its
                  segments yellow, matched segments black

Example:
  pcl_fft_ground simulate survey wreck -o wreck --points 200000
  pcl_fft_ground align wreck/submap_00.pcd wreck/submap_01.pcd -o pair --max-object-size 1

Exit status: 0 done (aligned or refused), 1 the work failed, 2 wrong usage.
)";

po::options_description commandOptions() {
  po::options_description options("General", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add = options.add_options();
  add("output,o", po::value<std::string>()->value_name("DIR"),
      "directory for the results; other files in it stay");
  add("method", po::value<std::string>()->default_value("fft")->value_name("NAME"),
      ("how ground is told from objects: " + methodChoice()).c_str());
  add("guess", po::value<std::string>()->value_name("X,Y,Z,YAW"),
      "place [m] and heading [degrees] of MOVING in the coordinates of REFERENCE, in place of the "
      "VIEWPOINTs");
  addThreadsOption(options);
  addReportOption(options);
  add("json", po::bool_switch(), "print the report as JSON");
  add("quiet", po::bool_switch(), "print nothing but errors");
  add("help,h", po::bool_switch(), "show this text");
  return options;
}

/// "1,2,0,30" as a pose.
Eigen::Isometry3d parseGuess(const std::string& text) {
  std::string words = text;
  for (char& c : words) c = c == ',' ? ' ' : c;
  std::string_view rest = words;
  std::array<double, 4> numbers{};
  bool valid = true;
  for (double& number : numbers) {
    const std::optional<double> parsed = parseNumber<double>(takeWord(rest));
    valid = valid && parsed && std::abs(*parsed) <= Viewpoint::FARTHEST;
    number = parsed.value_or(0);
  }
  if (!valid || !takeWord(rest).empty())
    throw UsageError("--guess " + text + ": allowed are four numbers, X,Y,Z,YAW, up to 1e8");
  return Eigen::Translation3d(numbers[0], numbers[1], numbers[2]) *
         Eigen::AngleAxisd(numbers[3] * EIGEN_PI / 180, Eigen::Vector3d::UnitZ());
}

/// reference_from_moving of the clouds' points, as far as it is known.
Eigen::Isometry3d initialGuess(const po::variables_map& values, const Cloud& reference, const Cloud& moving) {
  if (values.count("guess") == 0)
    return reference.viewpoint.asTransform().inverse() * moving.viewpoint.asTransform();
  return Eigen::Translation3d(-reference.origin) * parseGuess(values["guess"].as<std::string>()) *
         Eigen::Translation3d(moving.origin);
}

/// \throws WorkError naming the file if it cannot be read or its VIEWPOINT is no pose
InputScan readScan(const std::string& path, const ReadOptions& reading, Progress& progress) {
  progress.begin("read", "reading " + path);
  InputScan scan{path, readCloud(path, reading)};
  if (!scan.cloud.pose_fault.empty()) throw WorkError(path + ": " + scan.cloud.pose_fault);
  return scan;
}

/// Where the sensors stood, in the coordinates of the files, if it was told.
struct Sensors {
  std::optional<Eigen::Vector3d> reference, moving;
};

/// Takes the option out of the values: the segmenter is told of each scan's by what describes it.
Sensors takeSensors(po::variables_map& values) {
  if (values.count("sensor") == 0) return {};
  const auto text = values["sensor"].as<std::string>();
  values.erase("sensor");
  std::string_view rest = text;
  std::vector<double> numbers;
  for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest))
    numbers.push_back(parseNumber<double>(word).value_or(std::numeric_limits<double>::quiet_NaN()));
  const bool are_finite =
      std::all_of(numbers.begin(), numbers.end(), [](double n) { return std::isfinite(n); });
  if (!are_finite || (numbers.size() != 3 && numbers.size() != 6))
    throw UsageError("--sensor " + text + ": allowed are three numbers, X Y Z, or three for each scan");
  return {Eigen::Vector3d::Map(numbers.data()), Eigen::Vector3d::Map(numbers.data() + numbers.size() - 3)};
}

/// In the coordinates of a cloud's points.
std::optional<Eigen::Vector3d> placedIn(const Cloud& cloud, const std::optional<Eigen::Vector3d>& sensor) {
  return sensor ? std::optional<Eigen::Vector3d>(*sensor - cloud.origin) : std::nullopt;
}

nlohmann::ordered_json asJson(const Sensors& sensors) {
  const auto list = [](const Eigen::Vector3d& v) { return nlohmann::ordered_json{v.x(), v.y(), v.z()}; };
  return {{"reference", list(*sensors.reference)}, {"moving", list(*sensors.moving)}};
}

/// \throws WorkError naming the file on which the method cannot work
void alignClouds(AlignedPair& pair, const AlignmentSettings& settings, const Segmenter& segmenter,
                 const Sensors& sensors) {
  SegmentICP<Point, Point>& icp = pair.icp;
  icp.setSensorPosition(placedIn(pair.moving.cloud, sensors.moving),
                        placedIn(pair.reference.cloud, sensors.reference));
  icp.setAlignmentParameters(settings.alignment);
  icp.setSegmentParameters(settings.segments);
  icp.setGroundSegmentation(segmenter.filter, segmenter.filter);
  icp.setInputSource(pair.moving.cloud.points);
  icp.setInputTarget(pair.reference.cloud.points);
  icp.computeAlignment(pair.guess);
  if (!icp.getTargetError().empty()) throw WorkError(pair.reference.path + ": " + icp.getTargetError());
  if (!icp.getSourceError().empty()) throw WorkError(pair.moving.path + ": " + icp.getSourceError());
}

void printSummary(const AlignedPair& pair, const ordered_json& report) {
  const core::Alignment& alignment = pair.icp.getAlignment();
  if (!alignment.accepted) {
    std::cout << "not aligned: " << printable(alignment.refusal) << "\n";
    return;
  }
  const Eigen::Isometry3d& found = alignment.reference_from_moving;
  const Eigen::Vector3d middle = pair.icp.getSourceScan().surface.cast<double>().rowwise().mean();
  const double turn =
      Eigen::AngleAxisd(pair.guess.linear().transpose() * found.linear()).angle() * 180 / EIGEN_PI;
  std::cout << "aligned by " << report["method"].get<std::string>() << ": " << alignment.matches.size()
            << " matches, score " << fixedNumber(alignment.score, 2) << ", moved by "
            << fixedNumber((found * middle - pair.guess * middle).norm(), 3) << " m and "
            << fixedNumber(turn, 2) << " degrees, Nx "
            << fixedNumber(report["crispness"]["delta_nx_percent"].get<double>(), 2) << " %\n";
}

void align(po::variables_map values) {
  const std::vector<std::string> clouds = values.count("cloud") == 0
                                              ? std::vector<std::string>()
                                              : values["cloud"].as<std::vector<std::string>>();
  const core::Threads threads(threadsOf(values));
  if (clouds.size() != 2) throw UsageError("align: allowed are two scans, REFERENCE and MOVING");
  if (values.count("output") == 0 || values["output"].as<std::string>().empty())
    throw UsageError("align: no output given: name a folder by -o DIR");
  const Sensors sensors = takeSensors(values);
  AlignmentSettings settings = alignmentSettings(values);
  if (sensors.reference) settings.described["sensor"] = asJson(sensors);
  const Segmenter segmenter =
      makeAlignmentSegmenter(values["method"].as<std::string>(), values, settings.version);
  const std::string directory = values["output"].as<std::string>();
  const std::string page = reportPath(values, directory);

  const bool quiet = values["quiet"].as<bool>();
  Progress progress(quiet);
  const ReadOptions reading = readOptions(values);
  AlignedPair pair{readScan(clouds[0], reading, progress),
                   readScan(clouds[1], reading, progress),
                   Eigen::Isometry3d::Identity(),
                   {}};
  pair.guess = initialGuess(values, pair.reference.cloud, pair.moving.cloud);
  if (!quiet)
    for (const InputScan* scan : {&pair.reference, &pair.moving})
      for (const std::string& remark : scan->cloud.remarks) printWarning(scan->path + ": " + remark);
  progress.begin("align", "aligning");
  alignClouds(pair, settings, segmenter, sensors);
  progress.begin("write", "writing " + directory);
  const OutputFolder folder(directory);
  const ordered_json report = makeAlignmentReport(pair, settings, segmenter);
  writeAlignment(directory, pair, report);
  if (!page.empty()) writeText(page, alignmentPage(directory, pair, report));
  progress.end();
  if (values["json"].as<bool>())
    std::cout << asText(report);
  else if (!quiet)
    printSummary(pair, report);
}

}  // namespace

void runAlign(const std::vector<std::string>& arguments) {
  po::options_description shown;
  shown.add(commandOptions())
      .add(alignmentOptions("dense"))
      .add(readingOptions(Labels::IGNORED))
      .add(segmenterOptions());
  po::options_description all;
  all.add(shown).add_options()("cloud", po::value<std::vector<std::string>>());
  po::positional_options_description positional;
  positional.add("cloud", -1);
  const po::variables_map values = parseArguments("align", arguments, all, positional);
  if (values["help"].as<bool>())
    std::cout << HELP_BEFORE << shown << HELP_AFTER;
  else
    align(values);
}

}  // namespace pcl_fft_ground::cli
