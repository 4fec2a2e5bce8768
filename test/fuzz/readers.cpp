#include <pcl/conversions.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <optional>
#include <sstream>

#include "commands/commands.h"
#include "commands/survey/survey_pairs.h"
#include "commands/survey/survey_scans.h"
#include "errors.h"
#include "fuzz.h"
#include "io/cloud_file.h"
#include "io/cloud_stream.h"
#include "io/pose_table.h"
#include "report/report.h"
#include "temporary_folder.h"

namespace pcl_fft_ground::fuzz {
namespace {

using namespace pcl_fft_ground::cli;
using Words = std::vector<std::string>;
namespace fs = std::filesystem;

/// A folder that is removed when the program ends.
struct WorkFolder {
  const std::string path = makeTemporaryFolder();
  ~WorkFolder() { fs::remove_all(path); }
};

const std::string& folder() {
  static const WorkFolder made;
  return made.path;
}

std::string fileOf(const std::string& name, std::string_view content) {
  const std::string path = folder() + "/" + name;
  std::ofstream(path, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
  return path;
}

/// Does it, unless it is refused in one line.
template <typename Work>
void doOrRefuse(const Work& work) {
  try {
    work();
  } catch (const WorkError& error) {
    require(std::string_view(error.what()).find('\n') == std::string_view::npos, "a refusal is one line");
  }
}

/// The same points, bit for bit.
void requireEqual(const pcl::PCLPointCloud2& a, const pcl::PCLPointCloud2& b, const std::string& promise) {
  require(a.width == b.width && a.height == b.height && a.point_step == b.point_step && a.data == b.data,
          promise);
}

/// A cloud file: its points and fields fit each other, and what is written of it is read again.
void cloudPromise(Bytes bytes, const std::string& name, std::optional<CloudFormat> format) {
  const std::string path = fileOf(name, bytes.rest());
  doOrRefuse([&] {
    const Cloud cloud = readCloud(path, {format, {}, {}});
    const std::size_t points = cloud.points->size();
    require(points > 0 && points == std::size_t{cloud.fields.width} * cloud.fields.height, "as many points");
    require(cloud.fields.data.size() == points * cloud.fields.point_step, "as many bytes");
    require(cloud.labels.empty() || cloud.labels.size() == points, "as many labels");
    const std::string copy = folder() + "/copy.pcd";
    writePcd(copy, cloud.fields, cloud.viewpoint);
    const Cloud again = readCloud(copy);
    // Where coordinates are beyond float, those that are left may be far from their origin again.
    if (again.origin.isZero()) requireEqual(cloud.fields, again.fields, "what is written is read again");
  });
  doOrRefuse([&] {
    CloudStream stream(path, {format, {}, {}});
    stream.read(0, std::min<std::size_t>(stream.points(), 2));
  });
}

void anyCloud(Bytes bytes) {
  cloudPromise(bytes, "cloud", std::nullopt);
}
void pcd(Bytes bytes) {
  cloudPromise(bytes, "cloud.pcd", CloudFormat::PCD);
}
void ply(Bytes bytes) {
  cloudPromise(bytes, "cloud.ply", CloudFormat::PLY);
}
void text(Bytes bytes) {
  cloudPromise(bytes, "cloud.txt", CloudFormat::TEXT);
}
void las(Bytes bytes) {
  cloudPromise(bytes, "cloud.las", CloudFormat::LAS);
}
void floats(Bytes bytes) {
  for (const auto format : {CloudFormat::KITTI, CloudFormat::NUSCENES})
    cloudPromise(bytes, "cloud.bin", format);
  cloudPromise(bytes, "cloud.bin", std::nullopt);
}

/// The poses of sub-maps: what is written of them is read again.
void poses(Bytes bytes) {
  const std::string path = fileOf("poses.csv", bytes.rest());
  doOrRefuse([&] {
    const std::vector<NamedPose> read = readPoses(path);
    for (const NamedPose& pose : read)
      require(pose.world_from_submap.matrix().allFinite(), "a pose has finite numbers");
    require(readPoses(fileOf("again.csv", asCsv(read))).size() == read.size(), "poses are read again");
  });
}

/// The true poses of a survey of two sub-maps.
void truth(Bytes bytes) {
  const std::string survey = folder() + "/survey";
  fs::create_directory(survey);
  for (const char* const name : {"survey/a.pcd", "survey/b.pcd"})
    fileOf(name, "FIELDS x y z\nWIDTH 2\nDATA ascii\n0 0 0\n1 1 1\n");
  fileOf("survey/truth.csv", bytes.rest());
  doOrRefuse([&] {
    require(readSurvey(survey, {}, [](std::size_t) {}).truth.size() == 2, "each sub-map has its pose");
  });
}

/// What an earlier run left of a survey, behind each other: parameters, pairs.csv, a journal, parted by bytes
/// of 0xFF. A run goes on from there or refuses to; the table that it leaves is read again.
void record(Bytes bytes) {
  const std::string survey = folder() + "/record";
  fs::create_directory(survey);
  std::string_view rest = bytes.rest();
  const auto part = [&] {
    const std::size_t end = std::min(rest.find('\xff'), rest.size());
    const std::string_view taken = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return taken;
  };
  const nlohmann::ordered_json parameters = {{"submaps", {"a.pcd", "b.pcd"}}};
  const std::string_view given = part();
  fileOf("record/parameters.json", given == "same" ? std::string_view(asText(parameters)) : given);
  fileOf("record/pairs.csv", part());
  fileOf("record/pairs.journal", part());
  doOrRefuse([&] {
    const Words names{"a.pcd", "b.pcd"};
    SurveyRecord record(survey, parameters, names, std::nullopt);
    core::PairResult added;
    added.method = "fft";
    added.moving = 1;
    record.add(added);
    require(record.find("fft", {0, 1}) != nullptr, "a pair that was added is found");
    record.finish({});
    require(!readPairs(survey + "/pairs.csv", names).empty(), "the pairs are read again");
  });
  fs::remove_all(survey);
}

/// Hides what is printed while it lives.
class Silence {
 public:
  Silence() : out_(std::cout.rdbuf(text_.rdbuf())), err_(std::cerr.rdbuf(text_.rdbuf())) {}
  ~Silence() {
    std::cout.rdbuf(out_);
    std::cerr.rdbuf(err_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  std::ostringstream text_;
  std::streambuf *out_, *err_;
};

/// The words of a command, a line each, in an empty folder. No word names another folder, and nothing is
/// simulated: the only work that needs no file.
void commandLine(Bytes bytes) {
  std::istringstream lines{std::string(bytes.rest())};
  std::string command;
  std::getline(lines, command);
  Words words;
  for (std::string word; std::getline(lines, word);) {
    if (word.find('/') != std::string::npos) return;
    words.push_back(word);
  }
  fs::create_directories(folder() + "/in/this");
  fs::current_path(folder() + "/in/this");
  const Silence silence;
  try {
    if (command == "segment") runSegment(words);
    if (command == "evaluate") runEvaluate(words);
    if (command == "align") runAlign(words);
    if (command == "survey") runSurvey(words);
    if (command == "simulate") {
      words.push_back("--object-share=9");
      runSimulate(words);
    }
  } catch (const UsageError&) {
    // as promised
  } catch (const WorkError&) {
    // as promised
  }
  fs::current_path(folder());
  require(fs::is_empty("in/this"), "no words make a file where there is no cloud");
}

}  // namespace

std::vector<Target> readerTargets() {
  return {{"cloud", anyCloud}, {"pcd", pcd},          {"ply", ply},     {"text", text},
          {"las", las},        {"floats", floats},    {"poses", poses}, {"truth", truth},
          {"record", record},  {"words", commandLine}};
}

}  // namespace pcl_fft_ground::fuzz
