// What the files of `segment` hold.

#include <array>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>

#include "segment_fixture.h"

namespace pcl_fft_ground::cli {
namespace {

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
  EXPECT_EQ(line.rfind("segment,points,cx,cy,cz,ex,ey,ez,height,length,width,", 0), 0U) << line;
  EXPECT_EQ(std::count(line.begin(), line.end(), ','), 28);
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
  const std::vector<double> p_ground = valuesOf(readByPcl(outputOf("labelled.pcd")), "p_ground");
  ASSERT_EQ(p_ground.size(), label.size());
  const double tolerance = report()["ground"]["height_tolerance"];
  ASSERT_EQ(heights.size(), label.size());
  EXPECT_GT(std::count_if(heights.begin(), heights.end(), [&](double h) { return h > tolerance; }), 100);
  int likely_ground = 0;
  for (std::size_t n = 0; n < heights.size(); ++n)
    if (label[n] == 1) {
      EXPECT_GT(heights[n], tolerance) << n;
      likely_ground += p_ground[n] > 0.5 ? 1 : 0;
    } else if (heights[n] <= 0) {
      EXPECT_EQ(p_ground[n], 1) << n;
    }
  EXPECT_LT(likely_ground, 10);  // the tolerance cuts off a few at the border
  segment(scan, {"--height", "--method", "naive"});
  EXPECT_EQ(findField(readByPcl(outputOf("labelled.pcd")), "p_ground"), nullptr);
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

}  // namespace
}  // namespace pcl_fft_ground::cli
