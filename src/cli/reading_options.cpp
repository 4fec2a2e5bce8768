#include "reading_options.h"

#include <array>

#include "command_line.h"
#include "errors.h"
#include "io/scanner.h"
#include "methods/parameter_setter.h"

namespace pcl_fft_ground::cli {
namespace {

namespace po = boost::program_options;

constexpr std::array<std::pair<const char*, CloudFormat>, 6> FORMATS{{{"pcd", CloudFormat::PCD},
                                                                      {"ply", CloudFormat::PLY},
                                                                      {"text", CloudFormat::TEXT},
                                                                      {"las", CloudFormat::LAS},
                                                                      {"kitti", CloudFormat::KITTI},
                                                                      {"nuscenes", CloudFormat::NUSCENES}}};

std::optional<std::vector<int>> classList(const po::variables_map& values, const std::string& option) {
  if (values.count(option) == 0) return std::nullopt;
  return numberList(option, values[option].as<std::string>());
}

}  // namespace

po::options_description readingOptions(Labels labels) {
  po::options_description options("Reading", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add = options.add_options();
  add("format", po::value<std::string>()->value_name("NAME"),
      "format of the cloud: pcd, ply, text, las, kitti (float32 x y z intensity) or nuscenes (and ring) (by "
      "content, "
      "then by the name's ending)");
  if (labels == Labels::IGNORED) return options;
  add("ground-classes", po::value<std::string>()->value_name("N,.."),
      "labels of the cloud that mean ground; all others but the ignored ones mean object (0; LAS: 2)");
  add("ignore-classes", po::value<std::string>()->value_name("N,.."),
      "labels of the cloud that are not scored (2; LAS: 0,1,7,12,18; none where --ground-classes is given)");
  return options;
}

std::vector<int> numberList(const std::string& option, const std::string& text) {
  std::vector<int> numbers;
  std::string_view rest = text;
  while (true) {
    const std::size_t comma = rest.find(',');
    const auto number = parseNumber<int>(rest.substr(0, comma));
    if (!number)
      throw UsageError("--" + option + " " + text + ": allowed are whole numbers parted by commas");
    numbers.push_back(*number);
    if (comma == std::string_view::npos) return numbers;
    rest.remove_prefix(comma + 1);
  }
}

ReadOptions readOptions(const po::variables_map& values) {
  ReadOptions options;
  if (values.count("format") != 0)
    options.format = valueNamed("format", values["format"].as<std::string>(), FORMATS);
  options.ground_classes = classList(values, "ground-classes");
  options.ignored_classes = classList(values, "ignore-classes");
  return options;
}

void describeReading(const ReadOptions& options, nlohmann::ordered_json& parameters) {
  if (options.format)
    parameters["format"] = {{"value", nameOf(*options.format, FORMATS)}, {"from", "option"}};
  if (options.ground_classes)
    parameters["ground-classes"] = {{"value", *options.ground_classes}, {"from", "option"}};
  if (options.ignored_classes)
    parameters["ignore-classes"] = {{"value", *options.ignored_classes}, {"from", "option"}};
}

}  // namespace pcl_fft_ground::cli
