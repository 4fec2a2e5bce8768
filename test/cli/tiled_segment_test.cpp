#include <algorithm>
#include <chrono>
#include <map>

#include "errors.h"
#include "large_site.h"
#include "las_bytes.h"
#include "segment_fixture.h"

namespace pcl_fft_ground::cli {
namespace {

namespace fs = std::filesystem;

/// `segment --tile` beside the same without, on a site with boulders, piles and a terrace over the seams.
class TiledSegment : public SegmentCommand {
 protected:
  static constexpr std::uint64_t POINTS = 150000;
  static constexpr double SIDE = 11;

  static pcl::PointCloud<pcl::PointXYZL> site() {
    const test::LargeSite site(SIDE, 4);
    pcl::PointCloud<pcl::PointXYZL> cloud;
    for (std::uint64_t n = 0; n < POINTS; ++n) {
      const test::LargeSite::Point point = site.point(n);
      pcl::PointXYZL p;
      p.getVector3fMap() = point.place;
      p.label = point.is_object ? 1 : 0;
      cloud.push_back(p);
    }
    cloud[17].x = std::numeric_limits<float>::quiet_NaN();
    cloud[4711].z = 5e5F;
    cloud.is_dense = false;
    return cloud;
  }

  std::string makeSite() const { return makeCloud("site.pcd", site()); }

  /// `segment INPUT -o DIR --max-object-size 1 ...`
  Printed segmentTo(const std::string& directory, const std::string& input, const Words& more) const {
    Words words{input, "-o", pathOf(directory), "--max-object-size", "1", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return run(runSegment, words);
  }

  template <typename Error>
  std::string errorOf(const std::string& input, const Words& more) const {
    try {
      segmentTo("out", input, more);
      ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  /// The files of a result by name, report.json without its seconds.
  std::map<std::string, std::string> filesOf(const std::string& directory) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(pathOf(directory))) {
      const std::string name = entry.path().filename().string();
      if (entry.is_directory()) continue;
      files[name] = contentOf(entry.path().string());
      if (name != "report.json") continue;
      json report = json::parse(files[name]);
      report.erase("seconds");
      files[name] = report.dump();
    }
    return files;
  }

  /// Cuts a run off while it writes its points: labelled.pcd cannot take its place.
  void cutOff(const std::string& input) const {
    fs::create_directories(outputOf("labelled.pcd/in_the_way"));
    errorOf<WorkError>(input, {"--tile", "4"});
    fs::remove_all(outputOf("labelled.pcd"));
  }
};

double share(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  std::size_t same = 0;
  for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n) same += a[n] == b[n] ? 1 : 0;
  return static_cast<double>(same) / static_cast<double>(a.size());
}

/// Of the segments of one result with at least 50 points, the share that the other one has with an
/// intersection over union of 0.9 or more.
double shareFoundAgain(const std::vector<double>& segments, const std::vector<double>& others) {
  std::map<double, std::size_t> sizes, sizes_of_others;
  std::map<std::pair<double, double>, std::size_t> common;
  for (std::size_t n = 0; n < segments.size(); ++n) {
    ++sizes[segments[n]];
    ++sizes_of_others[others[n]];
    ++common[{segments[n], others[n]}];
  }
  std::map<double, double> best;
  for (const auto& [pair, count] : common)
    if (pair.second != 0)
      best[pair.first] =
          std::max(best[pair.first],
                   static_cast<double>(count) /
                       static_cast<double>(sizes[pair.first] + sizes_of_others[pair.second] - count));
  double looked_at = 0, found = 0;
  for (const auto& [number, size] : sizes) {
    if (number == 0 || size < 50) continue;
    ++looked_at;
    found += best[number] >= 0.9 ? 1 : 0;
  }
  EXPECT_GE(looked_at, 20);
  return found / looked_at;
}

TEST_F(TiledSegment, AgreesWithARunThatHoldsAllPoints) {
  const std::string input = makeSite();
  segmentTo("whole", input, {"--height"});
  segmentTo("out", input, {"--height", "--tile", "4"});
  const Words names = outputNames();
  std::map<std::string, std::string> whole_files = filesOf("whole");
  ASSERT_EQ(names.size(), whole_files.size());
  for (const std::string& name : names) EXPECT_EQ(whole_files.count(name), 1U) << name;

  const pcl::PCLPointCloud2 whole = readByPcl(pathOf("whole/labelled.pcd")),
                            tiled = readByPcl(outputOf("labelled.pcd"));
  ASSERT_EQ(tiled.fields.size(), whole.fields.size());
  for (const char* name : {"x", "y", "z", "truth"}) {
    const std::vector<double> expected = valuesOf(whole, name), values = valuesOf(tiled, name);
    for (std::size_t n = 0; n < expected.size(); ++n)
      ASSERT_TRUE(values[n] == expected[n] || (std::isnan(values[n]) && std::isnan(expected[n]))) << n;
  }
  const std::vector<double> labels = valuesOf(tiled, "label");
  EXPECT_GE(share(labels, valuesOf(whole, "label")), 0.9995);
  EXPECT_GE(shareFoundAgain(valuesOf(whole, "segment"), valuesOf(tiled, "segment")), 0.95);
  EXPECT_GE(shareFoundAgain(valuesOf(tiled, "segment"), valuesOf(whole, "segment")), 0.95);
  const std::vector<double> of_all = valuesOf(whole, "p_ground"), p_ground = valuesOf(tiled, "p_ground");
  double different = 0;
  for (std::size_t n = 0; n < of_all.size(); ++n) {
    ASSERT_EQ(std::isnan(p_ground[n]), std::isnan(of_all[n])) << n;
    if (!std::isnan(of_all[n])) different += std::abs(p_ground[n] - of_all[n]) > 0.1 ? 1 : 0;
  }
  EXPECT_LT(different, 0.005 * static_cast<double>(of_all.size()));
  EXPECT_EQ(labels[17], 2);
  EXPECT_EQ(labels[4711], 1);

  const json of_whole = json::parse(contentOf(pathOf("whole/report.json"))), of_tiled = report();
  EXPECT_EQ(of_tiled["counts"]["points"], of_whole["counts"]["points"]);
  EXPECT_EQ(of_tiled["counts"]["far"], 1);
  EXPECT_EQ(of_tiled["elevation"]["rows"], of_whole["elevation"]["rows"]);
  EXPECT_EQ(of_tiled["elevation"]["cols"], of_whole["elevation"]["cols"]);
  EXPECT_NEAR(of_tiled["counts"]["segments"].get<double>(), of_whole["counts"]["segments"].get<double>(), 20);
  EXPECT_NEAR(of_tiled["ground"]["spread"].get<double>(), of_whole["ground"]["spread"].get<double>(), 1e-4);
  EXPECT_GT(of_tiled["scores"]["f1"].get<double>(), of_whole["scores"]["f1"].get<double>() - 0.01);
  for (const auto& [key, value] : of_whole.items()) EXPECT_TRUE(of_tiled.contains(key)) << key;
}

TEST_F(TiledSegment, SegmentsAreNumberedBySizeAndCrossSeams) {
  segmentTo("out", makeSite(), {"--tile", "4"});
  const pcl::PCLPointCloud2 cloud = readByPcl(outputOf("labelled.pcd"));
  const std::vector<double> numbers = valuesOf(cloud, "segment"), labels = valuesOf(cloud, "label");
  std::map<int, std::size_t> sizes;
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    if (numbers[n] == 0) continue;
    EXPECT_EQ(labels[n], 1);
    ++sizes[static_cast<int>(numbers[n])];
  }
  std::size_t before = numbers.size();
  for (const auto& [number, size] : sizes) {
    EXPECT_LE(size, before) << number;
    EXPECT_GE(size, 10U);
    before = size;
  }
  std::istringstream csv(contentOf(outputOf("segments.csv")));
  std::string line;
  std::getline(csv, line);
  std::size_t rows = 0;
  while (std::getline(csv, line)) {
    const auto number = static_cast<int>(++rows);
    EXPECT_EQ(line.substr(0, line.find(',', line.find(',') + 1)),
              std::to_string(number) + "," + std::to_string(sizes[number]));
  }
  EXPECT_EQ(rows, sizes.size());
}

TEST_F(TiledSegment, GoesOnWhereItWasCutOff) {
  const std::string input = makeSite();
  segmentTo("clean", input, {"--tile", "4"});
  EXPECT_FALSE(fs::exists(pathOf("clean/.tiles")));
  cutOff(input);
  ASSERT_TRUE(fs::exists(outputOf(".tiles/0.ground")));
  const auto written = fs::last_write_time(outputOf(".tiles/0.ground"));
  fs::remove(outputOf(".tiles/1.segments"));  // as if it had been cut off earlier
  fs::remove(outputOf(".tiles/2.labels"));
  cutOff(input);
  EXPECT_EQ(fs::last_write_time(outputOf(".tiles/0.ground")), written);
  segmentTo("out", input, {"--tile", "4"});
  EXPECT_FALSE(fs::exists(outputOf(".tiles")));
  const auto clean = filesOf("clean"), resumed = filesOf("out");
  ASSERT_EQ(clean.size(), resumed.size());
  for (const auto& [name, content] : clean) EXPECT_TRUE(resumed.at(name) == content) << name;
}

TEST_F(TiledSegment, AnotherFileAndOtherOptionsAreRefusedWhereARunWasCutOff) {
  const std::string input = makeSite();
  cutOff(input);
  EXPECT_NE(errorOf<WorkError>(input, {"--tile", "5"}).find("other options"), std::string::npos);
  fs::last_write_time(input, fs::last_write_time(input) + std::chrono::seconds(5));
  const std::string changed = errorOf<WorkError>(input, {"--tile", "4"});
  EXPECT_NE(changed.find("has changed"), std::string::npos) << changed;
  EXPECT_NE(changed.find(outputOf(".tiles")), std::string::npos) << changed;
  EXPECT_TRUE(fs::exists(outputOf(".tiles/0.ground")));
}

TEST_F(TiledSegment, ADamagedTileIsNamed) {
  const std::string input = makeSite();
  cutOff(input);
  std::string bytes = contentOf(outputOf(".tiles/1.ground"));
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] + 1);
  std::ofstream(outputOf(".tiles/1.ground"), std::ios::binary) << bytes;
  fs::remove(outputOf(".tiles/1.labels"));
  const std::string damaged = errorOf<WorkError>(input, {"--tile", "4"});
  EXPECT_NE(damaged.find(outputOf(".tiles/1.ground")), std::string::npos) << damaged;
}

TEST_F(TiledSegment, WhatCannotBeReadInPartsIsRefused) {
  const std::string text = makeFile("points.txt", "0 0 0\n1 0 0\n0 1 0\n");
  const std::string message = errorOf<WorkError>(text, {"--tile", "4"});
  EXPECT_NE(message.find("binary PCD"), std::string::npos) << message;
  const std::string site = makeSite();
  const std::string truncated = makeFile("truncated.pcd", contentOf(site).substr(0, 500000));
  EXPECT_NE(errorOf<WorkError>(truncated, {"--tile", "4"}).find("truncated"), std::string::npos);
  EXPECT_FALSE(hasOutput());
}

TEST_F(TiledSegment, WrongUsage) {
  const std::string input = makeScan();
  for (const Words& words : std::vector<Words>{{"--tile", "0"},
                                               {"--tile", "-4"},
                                               {"--tile", "nan"},
                                               {"--tile", "4", "--method", "planar"},
                                               {"--memory", "0"}})
    EXPECT_THROW(segmentTo("out", input, words), UsageError) << words.back();
  EXPECT_FALSE(hasOutput());
}

TEST_F(TiledSegment, ACloudThatDoesNotFitNamesTheWayOut) {
  const std::string message = errorOf<WorkError>(makeScan(), {"--memory", "0.5"});
  EXPECT_NE(message.find("--tile"), std::string::npos) << message;
  EXPECT_FALSE(hasOutput());
}

TEST_F(TiledSegment, LasFilesKeepTheirBytesButForTheClasses) {
  std::vector<LasPoint> points;
  for (int j = 0; j < 60; ++j)
    for (int i = 0; i < 60; ++i)
      points.push_back({{5 * i, 5 * j, i > 20 && i < 28 && j > 28 && j < 36 ? 200 : (i * 7 + j * 3) % 5}, 1});
  const std::string input = makeFile("site.las", lasFile(2, 3, points));
  segmentTo("whole", input, {});
  segmentTo("out", input, {"--tile", "1.5"});
  const std::string whole = contentOf(pathOf("whole/labelled.las")),
                    tiled = contentOf(outputOf("labelled.las"));
  ASSERT_EQ(whole.size(), tiled.size());
  std::size_t different = 0;
  for (std::size_t n = 0; n < whole.size(); ++n) different += whole[n] == tiled[n] ? 0U : 1U;
  EXPECT_LE(different, 4U);  // classes of points at the foot of the box
}

}  // namespace
}  // namespace pcl_fft_ground::cli
