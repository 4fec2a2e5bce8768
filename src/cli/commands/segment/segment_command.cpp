#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <limits>
#include <optional>
#include <sstream>

#include "command_line.h"
#include "commands/commands.h"
#include "commands/segment/segment_outputs.h"
#include "commands/segment/segment_report.h"
#include "commands/segment/tiled_segment.h"
#include "errors.h"
#include "io/cloud_stream.h"
#include "io/output_file.h"
#include "io/raster_files.h"
#include "methods/method.h"
#include "pcl_fft_ground/core/segments/object_clusters.h"
#include "pcl_fft_ground/version.h"
#include "printable.h"
#include "progress.h"
#include "reading_options.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

namespace po = boost::program_options;
using nlohmann::ordered_json;

constexpr const char* HELP_BEFORE = R"(Usage: pcl_fft_ground segment CLOUD -o DIR [options]

Splits a scan into ground and objects, and the objects into segments. CLOUD is a PCD, PLY or LAS file, points of
KITTI or nuScenes (.bin) or text with x y z in each line, and maybe more columns; coordinates are in metres, and the
ground is what lies low. All that most scans need is the size of the largest object, --max-object-size; the values in
round brackets hold otherwise.
)";

constexpr const char* HELP_AFTER = R"(
DIR is made if need be and receives
  labelled.pcd                           all points, in order, with label (0 ground, 1 object, 2 neither) and
                                         segment (1.. by falling size, 0 none)
  labelled.las                           where CLOUD is LAS: the same file with other classes (see --classes);
                                         labelled.laz where it is LAZ, which is read where the program is built
                                         with LASzip
  ground.pcd objects.pcd                 the ground points and the object points
  ground_surface.pcd ground_surface.asc  the estimated ground, as points and as an ESRI ASCII grid; with fft the
                                         points tell where it is supported by ground seen nearby, and how
                                         uncertain it is [m]
  ground_surface.tif                     the same as GeoTIFF, in the coordinates of CLOUD: height, uncertainty and
                                         supported, where the program is built with GDAL
  segments.csv                           place, size, volume and fitted body of each segment
  report.json                            parameters, frame, counts, cut-off, peaks, warnings, scores; the origin that
                                         is subtracted in all of these where coordinates are large
  elevation.png ground.png spectrum.png labels.png segments.png
--report result.html makes one page of all that.
Where CLOUD has labels (a field label: 0 ground, 1 object, 2 neither; the classes of LAS; others by --ground-classes
and --ignore-classes), TPR, TNR and F1 of the objects are printed.

Examples:
  pcl_fft_ground segment wreck.pcd -o result --max-object-size 1
  pcl_fft_ground segment street.ply -o result --max-object-size 10
  pcl_fft_ground segment quarry.pcd -o result --max-object-size 40 --max-slope 0.3

Exit status: 0 done, 1 the work failed, 2 wrong usage.
)";

po::options_description commandOptions() {
  po::options_description options("General", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add = options.add_options();
  add("output,o", po::value<std::string>()->value_name("DIR"),
      "directory for the results; other files in it stay");
  add("method", po::value<std::string>()->default_value("fft")->value_name("NAME"),
      ("how ground is told from objects: " + methodChoice()).c_str());
  add("clusters", po::value<std::string>()->value_name("NAME"),
      "what becomes a segment: objects, things that touch told apart; or contact, all that touches, as in "
      "the paper (objects; fft-lowpass: contact)");
  add("min-object-size", po::value<double>()->value_name("M"),
      "objects: size of the smallest object [m], above 0: of a heap, nothing smaller is cut off (an eighth "
      "of --max-object-size; without that 4.5 leaf sizes)");
  add("leaf-size", po::value<double>()->value_name("M"),
      "side of the voxels that cluster the objects [m], above 0; no less than the spacing of the points (the "
      "cell size)");
  add("min-cluster-size", po::value<long long>()->value_name("N"),
      "points of the smallest segment, at least 1 (10)");
  add("max-cluster-size", po::value<long long>()->value_name("N"),
      "points of the largest segment (no limit)");
  add("height", po::bool_switch(),
      "add to labelled.pcd the height above the ground [m] as a field 'height' and, with the robust "
      "estimator, how likely the point is ground as 'p_ground', 0 to 1; both NaN where a point is not "
      "finite");
  add("classes", po::value<std::string>()->value_name("G,O,B"),
      "classes of ground, objects and objects below the ground in labelled.las (2,1,7)");
  add("crs", po::value<std::string>()->value_name("EPSG:N"),
      "coordinate reference system of ground_surface.tif (the one that a LAS file names)");
  add("raster-resolution", po::value<double>()->value_name("M"),
      "side of a cell of ground_surface.tif [m], above 0 (the cell size)");
  addThreadsOption(options);
  add("tile", po::value<double>()->value_name("M"),
      "work tile by tile, tiles of this side [m], several times the largest object: memory follows the tile "
      "and not CLOUD, which is binary PCD or PLY, or LAS; a run that is cut off goes on where it was when it "
      "is started again (methods fft)");
  add("memory", po::value<double>()->value_name("MIB"),
      "memory that a run without --tile may take [MiB], above 0 (three quarters of what is free)");
  addReportOption(options);
  add("json", po::bool_switch(), "print the report as JSON");
  add("quiet", po::bool_switch(), "print nothing but errors");
  add("help,h", po::bool_switch(), "show this text");
  return options;
}

std::size_t clusterSize(const po::variables_map& values, const std::string& option, std::size_t fallback) {
  if (values.count(option) == 0) return fallback;
  constexpr long long MOST = std::numeric_limits<pcl::index_t>::max();
  const auto size = values[option].as<long long>();
  if (size < 1 || size > MOST)
    throw UsageError("--" + option + " " + std::to_string(size) + ": allowed is a whole number from 1 to " +
                     std::to_string(MOST));
  return static_cast<std::size_t>(size);
}

/// A length that the user gave, if any.
std::optional<double> lengthOption(const po::variables_map& values, const std::string& option) {
  if (values.count(option) == 0) return std::nullopt;
  const auto length = values[option].as<double>();
  if (std::isfinite(length) && length > 0) return length;
  std::ostringstream message;
  message << "--" << option << " " << length << ": allowed is a finite number of metres above 0";
  throw UsageError(message.str());
}

Clusters clustersNamed(const po::variables_map& values) {
  if (values.count("clusters") == 0)
    return values["method"].as<std::string>() == "fft-lowpass" ? Clusters::CONTACT : Clusters::OBJECTS;
  const auto name = values["clusters"].as<std::string>();
  if (name == "objects") return Clusters::OBJECTS;
  if (name == "contact") return Clusters::CONTACT;
  throw UsageError("--clusters " + name + ": allowed is objects or contact");
}

ClusterParameters clusterParameters(const po::variables_map& values) {
  ClusterParameters parameters;
  parameters.clusters = clustersNamed(values);
  parameters.leaf_size = lengthOption(values, "leaf-size").value_or(parameters.leaf_size);
  lengthOption(values, "min-object-size");
  parameters.min_cluster_size = clusterSize(values, "min-cluster-size", parameters.min_cluster_size);
  parameters.max_cluster_size = clusterSize(values, "max-cluster-size", parameters.max_cluster_size);
  if (parameters.max_cluster_size < parameters.min_cluster_size)
    throw UsageError("--max-cluster-size " + std::to_string(parameters.max_cluster_size) +
                     ": allowed is at least --min-cluster-size, " +
                     std::to_string(parameters.min_cluster_size));
  return parameters;
}

/// Fills in the lengths that follow from what the segmenter found or was told.
void chooseLengths(const po::variables_map& values, double cell_size, ClusterParameters& clusters) {
  if (values.count("leaf-size") == 0) clusters.leaf_size = cell_size;
  const std::optional<double> largest = lengthOption(values, "max-object-size");
  const double smallest =
      largest ? core::MINIMUM_OBJECT_SHARE * *largest : core::MINIMUM_OBJECT_LEAVES * clusters.leaf_size;
  clusters.minimum_object_size = lengthOption(values, "min-object-size").value_or(smallest);
}

ordered_json describeClusterParameters(ordered_json parameters, const ClusterParameters& clusters,
                                       const po::variables_map& values) {
  const auto source = [&](const std::string& option, const char* otherwise) {
    return values.count(option) != 0 ? "option" : otherwise;
  };
  const bool objects = clusters.clusters == Clusters::OBJECTS;
  parameters["clusters"] = {{"value", objects ? "objects" : "contact"},
                            {"from", source("clusters", "default")}};
  const char* const smallest = values.count("max-object-size") != 0 ? "max-object-size" : "leaf-size";
  if (objects)
    parameters["min-object-size"] = {{"value", clusters.minimum_object_size},
                                     {"from", source("min-object-size", smallest)}};
  parameters["leaf-size"] = {{"value", clusters.leaf_size}, {"from", source("leaf-size", "cell-size")}};
  parameters["min-cluster-size"] = {{"value", clusters.min_cluster_size},
                                    {"from", source("min-cluster-size", "default")}};
  if (values.count("max-cluster-size") != 0)
    parameters["max-cluster-size"] = {{"value", clusters.max_cluster_size}, {"from", "option"}};
  return parameters;
}

std::string required(const po::variables_map& values, const std::string& option, const std::string& what) {
  if (values.count(option) == 0 || values[option].as<std::string>().empty())
    throw UsageError("segment: no " + what);
  return values[option].as<std::string>();
}

LasClasses lasClasses(const po::variables_map& values) {
  if (values.count("classes") == 0) return {};
  const std::string text = values["classes"].as<std::string>();
  const std::vector<int> numbers = numberList("classes", text);
  const bool in_range = std::all_of(numbers.begin(), numbers.end(), [](int c) { return c >= 0 && c <= 255; });
  if (numbers.size() != 3 || !in_range)
    throw UsageError("--classes " + text + ": allowed are three whole numbers from 0 to 255, G,O,B");
  return {numbers[0], numbers[1], numbers[2]};
}

RasterOptions rasterOptions(const po::variables_map& values) {
  RasterOptions options;
  if (values.count("raster-resolution") != 0) options.resolution = values["raster-resolution"].as<double>();
  const bool is_given = values.count("raster-resolution") != 0 || values.count("crs") != 0;
  if (is_given && !canWriteGeoTiff())
    throw UsageError(
        "--crs and --raster-resolution: this program is built without GDAL and writes no GeoTIFF");
  if (values.count("raster-resolution") != 0 &&
      !(options.resolution > 0 && std::isfinite(options.resolution))) {
    std::ostringstream message;
    message << "--raster-resolution " << options.resolution
            << ": allowed is a finite number of metres above 0";
    throw UsageError(message.str());
  }
  if (values.count("crs") == 0) return options;
  options.crs = values["crs"].as<std::string>();
  if (!isKnownCrs(options.crs))
    throw UsageError("--crs " + options.crs + ": allowed is what GDAL knows, such as EPSG:25832 or WKT");
  return options;
}

/// What there is to say about the file, the warnings of the filter, and one where the clustering found
/// nothing.
std::vector<std::string> warningsOf(const Cloud& cloud, const Segmenter& segmenter,
                                    const Segmentation& segmentation, const ClusterParameters& clusters) {
  std::vector<std::string> warnings = cloud.remarks;
  if (!cloud.pose_fault.empty()) warnings.push_back(cloud.pose_fault + ": taken for none");
  if (!cloud.label_fault.empty()) warnings.push_back(cloud.label_fault);
  const std::vector<std::string> of_filter = segmenter.filter->getWarnings();
  warnings.insert(warnings.end(), of_filter.begin(), of_filter.end());
  if (segmentation.clusters.empty() && segmentation.objects.indices.size() >= clusters.min_cluster_size)
    warnings.push_back("no segment has " + std::to_string(clusters.min_cluster_size) +
                       " points: a larger --leaf-size or a smaller --min-cluster-size may help");
  return warnings;
}

/// The options as text, but for those that no result hangs on.
std::string settingsOf(const po::variables_map& values) {
  std::ostringstream text;
  text << PCL_FFT_GROUND_VERSION << std::setprecision(17);
  for (const auto& [name, value] : values) {
    if (name == "output" || name == "memory" || name == "threads" || name == "json" || name == "quiet" ||
        name == "cloud")
      continue;
    text << " --" << name << ' ';
    if (const auto* word = boost::any_cast<std::string>(&value.value())) text << *word;
    if (const auto* number = boost::any_cast<double>(&value.value())) text << *number;
    if (const auto* count = boost::any_cast<long long>(&value.value())) text << *count;
    if (const auto* is_on = boost::any_cast<bool>(&value.value())) text << *is_on;
  }
  return text.str();
}

/// The parameters of the robust estimator, for work that the filter does not do itself.
core::RobustParameters robustParameters(const po::variables_map& values,
                                        const FFTGroundSegmentation<Point>& fft) {
  const auto given = [&](const char* option, double value) {
    return values.count(option) != 0 ? std::optional<double>(value) : std::nullopt;
  };
  core::RobustParameters parameters;
  if (values.count("relative-max-object-size") != 0)
    parameters.relative_max_object_size = fft.getRelativeMaximumObjectSize();
  parameters.max_object_size = given("max-object-size", fft.getMaximumObjectSize());
  parameters.cell_size = given("cell-size", fft.getCellSize());
  parameters.height_tolerance = given("height-tolerance", fft.getHeightTolerance());
  parameters.finest_wavelength = given("finest-wavelength", fft.getFinestWavelength());
  if (fft.getMaximumSlope() > 0) parameters.max_slope = fft.getMaximumSlope();
  if (values.count("cell-statistic") != 0) parameters.statistic = fft.getCellStatistic();
  parameters.filter_order = fft.getFilterOrder();
  parameters.passband_ripple = fft.getPassbandRipple();
  return parameters;
}

/// The memory that is free, as the system estimates it [MiB]; nothing where it does not tell.
std::optional<double> freeMemory() {
  std::ifstream stream("/proc/meminfo");
  std::string name;
  double kibibytes = 0;
  while (stream >> name >> kibibytes) {
    if (name == "MemAvailable:") return kibibytes / 1024;
    stream.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return std::nullopt;
}

/// Refuses a cloud that would not fit into memory.
void requireMemory(const po::variables_map& values, const std::string& input, const ReadOptions& reading) {
  // Copies of each record and what else a point takes while it is read, segmented and written, at the most.
  constexpr double COPIES = 4, BYTES = 120, MIB = 1 << 20, SHARE = 0.75;
  std::optional<double> most = freeMemory();
  if (most) *most *= SHARE;
  if (values.count("memory") != 0) {
    most = values["memory"].as<double>();
    if (!(*most > 0)) {
      std::ostringstream message;
      message << "--memory " << *most << ": allowed is a number of MiB above 0";
      throw UsageError(message.str());
    }
  }
  const std::optional<CloudSize> size = sizeOfCloud(input, reading);
  if (!most || !size) return;
  const double needed =
      static_cast<double>(size->points) * (COPIES * static_cast<double>(size->record_bytes) + BYTES) / MIB;
  if (needed > *most)
    throw WorkError(input + ": its " + std::to_string(size->points) + " points need about " +
                    std::to_string(std::llround(needed)) + " MiB of memory, and " +
                    std::to_string(std::llround(*most)) +
                    " MiB may be taken: --tile METRES works piece by piece, --memory allows more");
}

void finish(const po::variables_map& values, const std::string& directory, const ordered_json& report) {
  const bool quiet = values["quiet"].as<bool>();
  const std::string text = asText(report);
  writeText(directory + "/report.json", text);
  for (const ordered_json& warning : report["warnings"])
    if (!quiet) printWarning(report["input"].get<std::string>() + ": " + warning.get<std::string>());
  if (values["json"].as<bool>())
    std::cout << text;
  else if (!quiet)
    printSummary(std::cout, report);
}

void segmentTiled(const po::variables_map& values, const std::string& input, const std::string& directory,
                  const Segmenter& segmenter, const ClusterParameters& clusters) {
  if (segmenter.fft == nullptr || segmenter.fft->getEstimator() != Estimator::ROBUST)
    throw UsageError("--tile: allowed with --method fft only, not with " + segmenter.method);
  if (values.count("report") != 0) throw UsageError("--report: not allowed with --tile");
  TiledRequest request;
  request.site.frame.up_estimation = segmenter.filter->getUpEstimation();
  request.site.frame.yaw = segmenter.filter->getYaw();
  if (values.count("up-direction") != 0) request.site.frame.up_direction = segmenter.filter->getUpDirection();
  request.site.robust = robustParameters(values, *segmenter.fft);
  request.site.sensor = segmenter.sensor;
  request.site.tile_size = *lengthOption(values, "tile");
  request.site.settings = settingsOf(values);
  request.reading = readOptions(values);
  request.raster = rasterOptions(values);
  request.classes = lasClasses(values);
  request.heights = values["height"].as<bool>();
  request.clusters = [&](double cell_size) {
    ClusterParameters chosen = clusters;
    chooseLengths(values, cell_size, chosen);
    return chosen;
  };
  request.parameters = [&](const ClusterParameters& chosen, const std::vector<core::RobustChoice>& choices) {
    ordered_json parameters =
        describeClusterParameters(withChoices(segmenter.parameters, choices), chosen, values);
    describeReading(request.reading, parameters);
    parameters["tile"] = {{"value", request.site.tile_size}, {"from", "option"}};
    return parameters;
  };
  CloudStream stream(input, request.reading);
  if (values.count("classes") != 0 && stream.format() != CloudFormat::LAS)
    throw UsageError("--classes: only a LAS file gets classes, and '" + input + "' is none");
  const OutputFolder folder(directory);
  Progress progress(values["quiet"].as<bool>());
  const ordered_json report = segmentByTiles(stream, directory, segmenter.method, request, progress);
  finish(values, directory, report);
  forgetTiles(directory);
}

void segment(const po::variables_map& values) {
  const std::string input = required(values, "cloud", std::string("cloud given: name a ") + CLOUD_FILES);
  const std::string directory = required(values, "output", "output given: name a directory by -o DIR");
  const core::Threads threads(threadsOf(values));
  Segmenter segmenter = makeSegmenter(values["method"].as<std::string>(), values);
  ClusterParameters clusters = clusterParameters(values);
  const ReadOptions reading = readOptions(values);
  const LasClasses classes = lasClasses(values);
  const RasterOptions raster = rasterOptions(values);
  const std::string page = reportPath(values, directory);
  if (values.count("tile") != 0) return segmentTiled(values, input, directory, segmenter, clusters);
  requireMemory(values, input, reading);

  Progress progress(values["quiet"].as<bool>());
  progress.begin("read", "Reading " + input);
  const Cloud cloud = readCloud(input, reading);
  if (values.count("classes") != 0 && cloud.format != CloudFormat::LAS)
    throw UsageError("--classes: only a LAS file gets classes, and '" + input + "' is none");
  progress.begin("segment", "Separating ground from objects");
  Segmentation segmentation = segmentCloud(input, cloud, segmenter);
  if (values["height"].as<bool>()) {
    segmentation.heights = segmenter.filter->getHeightAboveGround();
    if (segmenter.fft != nullptr) segmentation.ground_probability = segmenter.fft->getGroundProbability();
  }
  progress.begin("cluster", "Clustering the objects");
  chooseLengths(values, segmenter.cellSize(), clusters);
  clusterObjects(cloud, clusters, segmentation);
  progress.begin("write", "Writing to " + directory);
  const OutputFolder folder(directory);
  writeClouds(directory, cloud, segmentation);
  if (cloud.format == CloudFormat::LAS) writeLas(directory, input, cloud, segmenter, segmentation, classes);
  writeGroundSurface(directory, cloud, segmentation, raster);
  writeSegments(directory, cloud, segmentation);
  progress.begin("pictures", "Drawing pictures to " + directory);
  writePictures(directory, segmenter, segmentation, cloud);
  progress.end();

  ordered_json parameters = describeClusterParameters(segmenter.parametersInForce(), clusters, values);
  describeReading(reading, parameters);
  const std::vector<std::string> warnings = warningsOf(cloud, segmenter, segmentation, clusters);
  const ordered_json report =
      makeReport(input, cloud, segmenter, segmentation, parameters, warnings, progress);
  if (!page.empty()) writeText(page, segmentPage(directory, cloud, segmentation, report));
  finish(values, directory, report);
}

}  // namespace

void runSegment(const std::vector<std::string>& arguments) {
  po::options_description shown;
  shown.add(segmenterOptions()).add(readingOptions(Labels::USED)).add(commandOptions());
  po::options_description all;
  all.add(shown).add_options()("cloud", po::value<std::string>());
  po::positional_options_description positional;
  positional.add("cloud", 1);
  const po::variables_map values = parseArguments("segment", arguments, all, positional);
  if (values["help"].as<bool>())
    std::cout << HELP_BEFORE << shown << HELP_AFTER;
  else
    segment(values);
}

}  // namespace pcl_fft_ground::cli
