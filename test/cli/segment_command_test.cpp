#include "segment/segment_command.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "command_fixture.h"
#include "pcl_fft_ground/fft_ground_segmentation.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::json;

const Words OUR_FILES{"elevation.png",      "ground.pcd",   "ground.png",   "ground_surface.asc",
                      "ground_surface.pcd", "labelled.pcd", "labels.png",   "objects.pcd",
                      "report.json",        "segments.csv", "segments.png", "spectrum.png"};

class SegmentCommand : public CommandFixture {
 protected:
  Words outputNames() const {
    Words result;
    for (const auto& entry : std::filesystem::directory_iterator(output()))
      result.push_back(entry.path().filename().string());
    std::sort(result.begin(), result.end());
    return result;
  }

  json report() const { return json::parse(contentOf(outputOf("report.json"))); }

  std::vector<double> labels() const { return valuesOf(readByPcl(outputOf("labelled.pcd")), "label"); }

  /// The filter with the parameters of segment(), run on the scan: what the outputs are compared with.
  template <typename PointT>
  static void runFilter(const pcl::PointCloud<PointT>& cloud, FFTGroundSegmentation<pcl::PointXYZ>& filter,
                        pcl::PointIndices& ground, pcl::PointIndices& objects) {
    pcl::PointCloud<pcl::PointXYZ>::Ptr points(new pcl::PointCloud<pcl::PointXYZ>);
    pcl::copyPointCloud(cloud, *points);
    filter.setCellSize(0.04);
    filter.setMaximumObjectSize(0.6);
    filter.setInputCloud(points);
    filter.segment(ground, objects);
  }
};

TEST_F(SegmentCommand, WritesItsFilesAndNothingElse) {
  segment(makeScan());
  EXPECT_EQ(outputNames(), OUR_FILES);
}

TEST_F(SegmentCommand, ReplacesItsFilesAndLeavesForeignOnesAlone) {
  std::filesystem::create_directories(output() + "/notes");
  makeFile("out/notes/today.txt", "mine");
  makeFile("out/labelled.txt", "mine, too");
  makeFile("out/report.json", "old");
  segment(makeScan());
  EXPECT_EQ(contentOf(outputOf("notes/today.txt")), "mine");
  EXPECT_EQ(contentOf(outputOf("labelled.txt")), "mine, too");
  EXPECT_NE(contentOf(outputOf("report.json")), "old");
  EXPECT_EQ(outputNames().size(), OUR_FILES.size() + 2);
}

TEST_F(SegmentCommand, LabelsAreThoseOfTheFilter) {
  segment(makeScan());
  FFTGroundSegmentation<pcl::PointXYZ> filter;
  pcl::PointIndices ground, objects;
  runFilter(boxScan(), filter, ground, objects);
  std::vector<double> expected(boxScan().size(), 2);
  for (const pcl::index_t n : ground.indices) expected[static_cast<std::size_t>(n)] = 0;
  for (const pcl::index_t n : objects.indices) expected[static_cast<std::size_t>(n)] = 1;
  EXPECT_EQ(labels(), expected);
  EXPECT_GT(objects.indices.size(), 200u);
  EXPECT_GT(ground.indices.size(), 1000u);
}

TEST_F(SegmentCommand, KeepsPointsInOrderWithTheirFieldsShapeAndViewpoint) {
  pcl::PointCloud<pcl::PointXYZRGBNormal> cloud(100, 100);
  const pcl::PointCloud<pcl::PointXYZL> scan = boxScan();
  for (std::size_t n = 0; n < cloud.size(); ++n) {
    cloud[n].getVector3fMap() = scan[n].getVector3fMap();
    cloud[n].rgba = static_cast<std::uint32_t>(n);
    cloud[n].curvature = 0.5f * static_cast<float>(n);
  }
  cloud[7].y = cloud[4711].z = std::numeric_limits<float>::quiet_NaN();
  cloud.is_dense = false;
  cloud.sensor_origin_ = Eigen::Vector4f(1, -2, 3.5f, 0);
  cloud.sensor_orientation_ = Eigen::Quaternionf(0.5f, -0.5f, 0.5f, 0.5f);
  segment(makeCloud("fields.pcd", cloud));

  pcl::PCLPointCloud2 labelled;
  Eigen::Vector4f origin;
  Eigen::Quaternionf orientation;
  int version = 0;
  ASSERT_EQ(pcl::PCDReader().read(outputOf("labelled.pcd"), labelled, origin, orientation, version), 0);
  EXPECT_EQ(origin.head<3>(), cloud.sensor_origin_.head<3>());
  EXPECT_EQ(orientation.coeffs(), cloud.sensor_orientation_.coeffs());
  EXPECT_EQ(labelled.width, 100u);
  EXPECT_EQ(labelled.height, 100u);
  for (const char* name : {"label", "segment"}) {
    ASSERT_NE(findField(labelled, name), nullptr);
    EXPECT_EQ(findField(labelled, name)->datatype, pcl::PCLPointField::INT32);
  }
  pcl::PointCloud<pcl::PointXYZRGBNormal> back;
  pcl::fromPCLPointCloud2(labelled, back);
  ASSERT_EQ(back.size(), cloud.size());
  for (std::size_t n = 0; n < cloud.size(); ++n) {
    ASSERT_EQ(std::memcmp(back[n].data, cloud[n].data, 3 * sizeof(float)), 0) << n;
    ASSERT_EQ(back[n].rgba, cloud[n].rgba) << n;
    ASSERT_EQ(back[n].curvature, cloud[n].curvature) << n;
  }
  const std::vector<double> label = valuesOf(labelled, "label"), number = valuesOf(labelled, "segment");
  EXPECT_EQ(std::count(label.begin(), label.end(), 2), 2);
  for (const std::size_t n : {7u, 4711u}) {
    EXPECT_EQ(label[n], 2);
    EXPECT_EQ(number[n], 0);
  }
  EXPECT_EQ(report()["counts"]["neither"], 2);
}

TEST_F(SegmentCommand, LabelAndSegmentOfTheInputBecomeTheTruth) {
  pcl::PCLPointCloud2 cloud;
  pcl::toPCLPointCloud2(boxScan(), cloud);
  std::vector<std::int32_t> numbers(pointCount(cloud));
  std::iota(numbers.begin(), numbers.end(), 0);
  setInt32Field(cloud, "segment", numbers);
  writePcd(pathOf("truth.pcd"), cloud);
  segment(pathOf("truth.pcd"));
  const pcl::PCLPointCloud2 labelled = readByPcl(outputOf("labelled.pcd"));
  Words names;
  for (const auto& field : labelled.fields) names.push_back(field.name);
  EXPECT_EQ(names, (Words{"x", "y", "z", "truth", "truth_segment", "label", "segment"}));
  EXPECT_EQ(valuesOf(labelled, "truth"), valuesOf(cloud, "label"));
  EXPECT_EQ(valuesOf(labelled, "truth_segment"), std::vector<double>(numbers.begin(), numbers.end()));
}

TEST_F(SegmentCommand, GroundAndObjectsAreTheTwoPartsOfLabelled) {
  segment(makeScan());
  const pcl::PCLPointCloud2 labelled = readByPcl(outputOf("labelled.pcd"));
  const std::vector<double> label = valuesOf(labelled, "label");
  for (const auto& [name, kept] : std::map<std::string, double>{{"ground.pcd", 0}, {"objects.pcd", 1}}) {
    pcl::Indices indices;
    for (std::size_t n = 0; n < label.size(); ++n)
      if (label[n] == kept) indices.push_back(static_cast<pcl::index_t>(n));
    EXPECT_EQ(readByPcl(outputOf(name)).data, selectPoints(labelled, indices).data) << name;
  }
}

TEST_F(SegmentCommand, SegmentsAreDescribedByTheirPoints) {
  segment(makeScan(), {"--min-cluster-size", "5"});
  FFTGroundSegmentation<pcl::PointXYZ> filter;
  pcl::PointIndices ground, objects;
  runFilter(boxScan(), filter, ground, objects);
  const std::vector<double> number = valuesOf(readByPcl(outputOf("labelled.pcd")), "segment");
  std::ifstream csv(outputOf("segments.csv"));
  std::string line;
  ASSERT_TRUE(std::getline(csv, line));
  EXPECT_EQ(line, "segment,points,cx,cy,cz,ex,ey,ez,height");
  std::size_t row = 0;
  for (double last = 1e9; std::getline(csv, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::array<double, 9> v{};
    for (double& value : v) words >> value;
    ASSERT_EQ(v[0], static_cast<double>(++row));
    EXPECT_LE(v[1], last);
    EXPECT_GE(v[1], 5);
    last = v[1];
    Eigen::AlignedBox3d box;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double points = 0, height = -1e9;
    for (std::size_t n = 0; n < number.size(); ++n) {
      if (number[n] != v[0]) continue;
      const Eigen::Vector3d p = boxScan()[n].getVector3fMap().cast<double>();
      box.extend(p);
      sum += p;
      height = std::max(height, filter.getGroundSurface().heightAbove(p));
      ++points;
    }
    ASSERT_EQ(points, v[1]);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(v[2 + static_cast<std::size_t>(k)], sum[k] / points, 1e-4);
      EXPECT_NEAR(v[5 + static_cast<std::size_t>(k)], box.sizes()[k], 1e-4);
    }
    EXPECT_NEAR(v[8], height, 1e-4);
  }
  EXPECT_GE(row, 1u);
  EXPECT_EQ(report()["counts"]["segments"], row);
}

/// How many labels differ; all if the numbers of labels do.
std::size_t differing(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size());
  std::size_t count = 0;
  for (std::size_t n = 0; n < a.size(); ++n) count += a[n] != b[n] ? 1 : 0;
  return count;
}

/// A turned and tilted scan: neither axis of the grid is one of the input.
pcl::PointCloud<pcl::PointXYZ> turnedScan() {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  pcl::copyPointCloud(boxScan(), cloud);
  const Eigen::Isometry3f turn(Eigen::AngleAxisf(0.5f, Eigen::Vector3f::UnitZ()) *
                               Eigen::AngleAxisf(0.2f, Eigen::Vector3f::UnitX()));
  for (pcl::PointXYZ& p : cloud) p.getVector3fMap() = turn * p.getVector3fMap();
  return cloud;
}

TEST_F(SegmentCommand, GroundSurfaceLiesOnTheSurfaceOfTheFilter) {
  segment(makeCloud("turned.pcd", turnedScan()));
  FFTGroundSegmentation<pcl::PointXYZ> filter;
  pcl::PointIndices ground, objects;
  runFilter(turnedScan(), filter, ground, objects);
  const core::GroundSurface& surface = filter.getGroundSurface();

  pcl::PointCloud<pcl::PointXYZ> cells;
  pcl::fromPCLPointCloud2(readByPcl(outputOf("ground_surface.pcd")), cells);
  ASSERT_EQ(static_cast<Eigen::Index>(cells.size()), surface.height.size());
  for (const pcl::PointXYZ& p : cells)
    EXPECT_NEAR(surface.heightAbove(p.getVector3fMap().cast<double>()), 0, 1e-5);

  std::ifstream grid(outputOf("ground_surface.asc"));
  std::map<std::string, double> header;
  for (const char* name : {"ncols", "nrows", "xllcorner", "yllcorner", "cellsize", "NODATA_value"}) {
    std::string key;
    grid >> key >> header[name];
    ASSERT_EQ(key, name);
  }
  EXPECT_EQ(header["cellsize"], 0.04);
  double known = 0, z = 0;
  for (double row = header["nrows"] - 1; row >= 0; --row)
    for (double column = 0; column < header["ncols"]; ++column) {
      ASSERT_TRUE(grid >> z);
      if (z == header["NODATA_value"]) continue;
      const double x = header["xllcorner"] + (column + 0.5) * 0.04,
                   y = header["yllcorner"] + (row + 0.5) * 0.04;
      EXPECT_NEAR(surface.heightAbove({x, y, z}), 0, 1e-4);  // four digits
      ++known;
    }
  EXPECT_FALSE(grid >> z);
  const double area = std::cos(0.2) * 2 * 2 / (0.04 * 0.04);  // of the tilted scan as seen from above
  EXPECT_NEAR(known, area, 0.08 * area);
  EXPECT_LT(known, 0.8 * header["nrows"] * header["ncols"]);  // the corners beside the turned scan
}

TEST_F(SegmentCommand, TheAsciiGridOfALongScanAcrossTheAxesStaysSmall) {
  pcl::PointCloud<pcl::PointXYZ> corridor;
  for (int n = 0; n < 30000; ++n) {
    const float along = 0.01f * static_cast<float>(n), across = 0.1f * static_cast<float>(n % 5);
    corridor.push_back({along - across, along + across, 0});
  }
  segment(makeCloud("corridor.pcd", corridor));
  const double cells =
      report()["elevation"]["rows"].get<double>() * report()["elevation"]["cols"].get<double>();
  std::ifstream grid(outputOf("ground_surface.asc"));
  std::string key;
  double columns = 0, rows = 0;
  grid >> key >> columns >> key >> rows;
  EXPECT_GT(columns, 100);
  EXPECT_LE(columns * rows, 16 * cells * 1.001);
}

TEST_F(SegmentCommand, ReportTellsWhatWasDone) {
  const std::string input = makeCloud("turned.pcd", turnedScan());
  segment(input, {"--filter-order", "3"});
  const json report = this->report();
  FFTGroundSegmentation<pcl::PointXYZ> filter;
  filter.setFilterOrder(3);
  pcl::PointIndices ground, objects;
  runFilter(turnedScan(), filter, ground, objects);

  EXPECT_EQ(report["input"], input);
  EXPECT_EQ(report["parameters"]["cell-size"], (json{{"value", 0.04}, {"from", "option"}}));
  EXPECT_EQ(report["parameters"]["filter-order"], (json{{"value", 3}, {"from", "option"}}));
  EXPECT_EQ(report["parameters"]["height-tolerance"]["value"], filter.getHeightTolerance());
  EXPECT_EQ(report["parameters"]["height-tolerance"]["from"], "data");
  EXPECT_EQ(report["ground"]["spread"], filter.getGroundSpread());
  EXPECT_EQ(report["parameters"]["leaf-size"], (json{{"value", 0.04}, {"from", "cell-size"}}));
  EXPECT_EQ(report["origin"], (json{0.0, 0.0, 0.0}));
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      EXPECT_EQ(report["frame_from_input"][static_cast<std::size_t>(row)][static_cast<std::size_t>(column)],
                filter.getFrame().matrix()(row, column));
  EXPECT_EQ(report["counts"]["points"], 10000);
  EXPECT_EQ(report["counts"]["ground"], ground.indices.size());
  EXPECT_EQ(report["counts"]["objects"], objects.indices.size());
  EXPECT_EQ(report["spectrum"]["cutoff_frequency"], filter.getCutoffFrequency());
  EXPECT_EQ(report["spectrum"]["peak_count"], filter.getSpectrumPeaks().size());
  ASSERT_FALSE(filter.getSpectrumPeaks().empty());
  EXPECT_EQ(report["spectrum"]["peaks"][0]["frequency"], filter.getSpectrumPeaks()[0].radius);
  EXPECT_EQ(report["elevation"]["empty_cell_share"], filter.getEmptyCellShare());
  EXPECT_EQ(report["warnings"], filter.getWarnings());
  EXPECT_TRUE(report["scores"].is_null());
  for (const char* stage : {"read", "segment", "cluster", "write", "pictures"})
    EXPECT_GE(report["seconds"].at(stage), 0.0) << stage;
}

TEST_F(SegmentCommand, HeightsAboveTheGroundAreAFieldWhereAskedFor) {
  const std::string scan = makeScan();
  segment(scan);
  EXPECT_EQ(findField(readByPcl(outputOf("labelled.pcd")), "height"), nullptr);
  segment(scan, {"--height"});
  const std::vector<double> heights = valuesOf(readByPcl(outputOf("labelled.pcd")), "height");
  const std::vector<double> label = labels();
  const double tolerance = report()["ground"]["height_tolerance"];
  ASSERT_EQ(heights.size(), label.size());
  EXPECT_GT(std::count_if(heights.begin(), heights.end(), [&](double h) { return h > tolerance; }), 100);
  for (std::size_t n = 0; n < heights.size(); ++n)
    if (label[n] == 1) {
      EXPECT_GT(heights[n], tolerance) << n;
    }
}

TEST_F(SegmentCommand, TheLowPassEstimatorIsThePublishedMethod) {
  const std::string scan = makeScan();
  segment(scan, {"--estimator", "low-pass"});
  const std::vector<double> by_estimator = labels();
  segment(scan, {"--method", "fft-lowpass"});
  EXPECT_EQ(labels(), by_estimator);
  EXPECT_TRUE(report()["ground"].is_null());
  segment(scan);
  EXPECT_GT(differing(labels(), by_estimator), 0u);
}

TEST_F(SegmentCommand, TheSurfaceTellsWhereItIsSupportedIfTheMethodKnows) {
  const std::string scan = makeScan();
  segment(scan, {"--method", "fft-lowpass"});
  EXPECT_EQ(findField(readByPcl(outputOf("ground_surface.pcd")), "supported"), nullptr);
  segment(scan);
  const pcl::PCLPointCloud2 surface = readByPcl(outputOf("ground_surface.pcd"));
  const std::vector<double> supported = valuesOf(surface, "supported");
  const double count = std::accumulate(supported.begin(), supported.end(), 0.0);
  EXPECT_NEAR(count / static_cast<double>(supported.size()), report()["ground"]["supported_share"], 1e-9);
  for (const double uncertainty : valuesOf(surface, "uncertainty"))
    EXPECT_GE(uncertainty, 0.999 * report()["ground"]["spread"].get<double>());
}

TEST_F(SegmentCommand, ScoresComeFromTheLabelsOfTheInput) {
  pcl::PointCloud<pcl::PointXYZL> cloud = boxScan();
  for (std::size_t n = 0; n < 500; ++n) cloud[n].label = 2;  // not scored
  const Printed printed = segment(makeCloud("truth.pcd", cloud));
  const std::vector<double> label = labels();
  double tp = 0, fp = 0, tn = 0, fn = 0;
  for (std::size_t n = 500; n < label.size(); ++n)
    ++(cloud[n].label == 1 ? (label[n] == 1 ? tp : fn) : (label[n] == 1 ? fp : tn));
  const json scores = report()["scores"];
  EXPECT_EQ(scores["tp"], tp);
  EXPECT_EQ(scores["tn"], tn);
  EXPECT_DOUBLE_EQ(scores["tpr"], tp / (tp + fn));
  EXPECT_DOUBLE_EQ(scores["tnr"], tn / (tn + fp));
  EXPECT_DOUBLE_EQ(scores["f1"], 2 * tp / (2 * tp + fp + fn));
  EXPECT_NE(printed.out.find("f1"), std::string::npos) << printed.out;
}

TEST_F(SegmentCommand, JsonIsTheReport) {
  const Printed printed = segment(makeScan(), {"--json"});
  EXPECT_EQ(printed.out, contentOf(outputOf("report.json")));
  EXPECT_TRUE(json::accept(printed.out));
}

TEST_F(SegmentCommand, QuietPrintsNothing) {
  const Printed printed = segment(makeScan(), {"--quiet", "--max-cluster-size", "1000"});
  EXPECT_EQ(printed.out + printed.err, "");
  EXPECT_EQ(outputNames(), OUR_FILES);
}

TEST_F(SegmentCommand, WarnsOnTheErrorStreamAndInTheReport) {
  const Printed printed = run(runSegment, {makeScan(), "-o", output(), "--max-object-size", "7"});
  ASSERT_EQ(report()["warnings"].size(), 1u);
  EXPECT_NE(printed.err.find(report()["warnings"][0].get<std::string>()), std::string::npos) << printed.err;
}

TEST_F(SegmentCommand, NamesMayHoldBlanksAndAnyLetters) {
  const std::string input = makeCloud("M\xc3\xb6we \xe6\xb5\xb7 1.pcd", boxScan());
  const std::string directory = pathOf(
      "\xc3\x9c"
      "ber sicht");
  const Printed printed = run(runSegment, {input, "-o", directory + "/", "--json"});
  EXPECT_EQ(json::parse(printed.out)["input"], input);
  EXPECT_TRUE(std::filesystem::exists(directory + "/labels.png"));
}

TEST_F(SegmentCommand, ANameThatIsNoUtf8StillMakesValidJson) {
  const Printed printed = segment(makeCloud("M\xf6we.pcd", boxScan()), {"--json"});
  EXPECT_TRUE(json::accept(printed.out));
  EXPECT_EQ(outputNames(), OUR_FILES);
}

TEST_F(SegmentCommand, TextOfNumbersIsRead) {
  std::ostringstream text;
  text << "# a scan\nx,y,z,label\n";
  for (const pcl::PointXYZL& p : boxScan()) text << p.x << ',' << p.y << ',' << p.z << ',' << p.label << '\n';
  segment(makeFile("scan.csv", text.str()));
  const std::vector<double> from_text = labels();
  EXPECT_FALSE(report()["scores"].is_null());
  segment(makeScan());
  EXPECT_LT(differing(from_text, labels()), 100u);  // the text has six digits
}

TEST_F(SegmentCommand, LargeCoordinatesKeepTheirCentimetres) {
  std::ostringstream text;
  text << std::fixed;
  for (const pcl::PointXYZL& p : boxScan())
    text << 432100.0 + static_cast<double>(p.x) << ' ' << 5412345.0 + static_cast<double>(p.y) << ' ' << p.z
         << '\n';
  segment(makeFile("utm.xyz", text.str()));
  const json origin = report()["origin"];
  EXPECT_NEAR(origin[0].get<double>(), 432100, 10);
  EXPECT_NEAR(origin[1].get<double>(), 5412345, 10);
  EXPECT_EQ(origin[2], 0.0);
  const pcl::PCLPointCloud2 labelled = readByPcl(outputOf("labelled.pcd"));
  const std::vector<double> x = valuesOf(labelled, "x"), y = valuesOf(labelled, "y");
  ASSERT_EQ(x.size(), 10000u);
  for (std::size_t n = 0; n < x.size(); n += 101) {
    EXPECT_NEAR(x[n] + origin[0].get<double>(), 432100.0 + static_cast<double>(boxScan()[n].x), 1e-5);
    EXPECT_NEAR(y[n] + origin[1].get<double>(), 5412345.0 + static_cast<double>(boxScan()[n].y), 1e-5);
  }
}

TEST_F(SegmentCommand, UpMayBeDown) {
  pcl::PointCloud<pcl::PointXYZL> cloud = boxScan();
  for (pcl::PointXYZL& p : cloud) p.z = -p.z;
  segment(makeCloud("ceiling.pcd", cloud), {"--up-direction", "0", "0", "-1"});
  EXPECT_LT(report()["frame_from_input"][2][2], -0.9);
  FFTGroundSegmentation<pcl::PointXYZ> filter;
  filter.setUpDirection({0, 0, -1});
  pcl::PointIndices ground, objects;
  runFilter(cloud, filter, ground, objects);
  const std::vector<double> label = labels();
  for (const pcl::index_t n : ground.indices) ASSERT_EQ(label[static_cast<std::size_t>(n)], 0) << n;
  for (const pcl::index_t n : objects.indices) ASSERT_EQ(label[static_cast<std::size_t>(n)], 1) << n;
  segment(pathOf("ceiling.pcd"));
  EXPECT_GT(report()["frame_from_input"][2][2], 0.9);
  EXPECT_GT(differing(label, labels()), 100u);  // the boxes hang below what is then the ground
}

TEST_F(SegmentCommand, AFarPointIsReportedAndChangesNoOtherLabel) {
  segment(makeScan());
  const std::vector<double> before = labels();
  pcl::PointCloud<pcl::PointXYZ> cloud;
  pcl::copyPointCloud(boxScan(), cloud);
  for (const Eigen::Vector3f& far :
       {Eigen::Vector3f(1e6f, 0, 0), Eigen::Vector3f(0, 0, -1e6f), Eigen::Vector3f(1e30f, 1e30f, 1e30f)}) {
    pcl::PointCloud<pcl::PointXYZ> with_far = cloud;
    with_far.push_back({far.x(), far.y(), far.z()});
    const Printed printed = segment(makeCloud("far.pcd", with_far));
    std::vector<double> after = labels();
    ASSERT_EQ(after.size(), before.size() + 1);
    EXPECT_EQ(after.back(), 1);
    after.pop_back();
    EXPECT_EQ(after, before);
    EXPECT_EQ(report()["counts"]["far"], 1);
    EXPECT_NE(printed.err.find("warning"), std::string::npos);
  }
}

}  // namespace
}  // namespace pcl_fft_ground::cli
