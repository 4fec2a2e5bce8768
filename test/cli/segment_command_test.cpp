#include "commands/commands.h"

#include <array>
#include <fstream>
#include <limits>

#include "io/raster_files.h"
#include "segment_fixture.h"

namespace pcl_fft_ground::cli {
namespace {

/// The files that each run writes, in the order of their names.
Words ourFiles() {
  Words files{"elevation.png",      "ground.pcd",   "ground.png",   "ground_surface.asc",
              "ground_surface.pcd", "labelled.pcd", "labels.png",   "objects.pcd",
              "report.json",        "segments.csv", "segments.png", "spectrum.png"};
  if (canWriteGeoTiff()) files.insert(files.begin() + 5, "ground_surface.tif");
  return files;
}

TEST_F(SegmentCommand, WritesItsFilesAndNothingElse) {
  segment(makeScan());
  EXPECT_EQ(outputNames(), ourFiles());
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
  EXPECT_EQ(outputNames().size(), ourFiles().size() + 2);
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

TEST_F(SegmentCommand, JsonIsTheReport) {
  const Printed printed = segment(makeScan(), {"--json"});
  EXPECT_EQ(printed.out, contentOf(outputOf("report.json")));
  EXPECT_TRUE(json::accept(printed.out));
}

TEST_F(SegmentCommand, QuietPrintsNothing) {
  const Printed printed = segment(makeScan(), {"--quiet", "--max-cluster-size", "1000"});
  EXPECT_EQ(printed.out + printed.err, "");
  EXPECT_EQ(outputNames(), ourFiles());
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
  EXPECT_EQ(outputNames(), ourFiles());
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
  segment(pathOf("ceiling.pcd"), {"--up-direction", "0", "0", "1"});
  EXPECT_GT(report()["frame_from_input"][2][2], 0.9);
  EXPECT_EQ(report()["up"]["side_from"], "given");
  EXPECT_GT(differing(label, labels()), 0u);  // the boxes hang below what is then the ground
}

/// An even floor of 10 m x 10 m with nine boxes on it, as x, height and y.
pcl::PointCloud<pcl::PointXYZL> floorWithBoxes(bool z_is_depth) {
  pcl::PointCloud<pcl::PointXYZL> cloud;
  for (int n = 0; n < 10000; ++n) {
    const int i = n % 100, j = n / 100;
    const bool on_box = i % 33 > 8 && i % 33 < 18 && j % 33 > 12 && j % 33 < 19;
    pcl::PointXYZL p;
    p.x = 0.1F * static_cast<float>(i) + 0.003F * static_cast<float>(n * 7 % 10);
    p.y = 0.1F * static_cast<float>(j) + 0.003F * static_cast<float>(n * 3 % 10);
    const float height = 0.002F * static_cast<float>(n * 13 % 7) + (on_box ? 0.6F : 0);
    p.z = z_is_depth ? 30 - height : height;
    p.label = on_box ? 1 : 0;
    cloud.push_back(p);
  }
  return cloud;
}

TEST_F(SegmentCommand, DepthsThatArePositiveDownAreFound) {
  run(runSegment, {makeCloud("depths.pcd", floorWithBoxes(true)), "-o", output(), "--max-object-size", "2"});
  EXPECT_LT(report()["frame_from_input"][2][2], -0.9);
  const json up = report()["up"];
  EXPECT_LT(up["axis"][2], -0.9);
  EXPECT_EQ(up["side_from"], "objects");
  EXPECT_GT(up["axis_confidence"], 0.9);
  EXPECT_GT(up["side_confidence"], 0.7);
  EXPECT_FALSE(up["reasons"].empty());
  EXPECT_GT(report()["scores"]["f1"], 0.99);
}

TEST_F(SegmentCommand, TheSensorTellsTheSide) {
  pcl::PointCloud<pcl::PointXYZL> bare = floorWithBoxes(false);
  for (pcl::PointXYZL& p : bare) p.z = p.label == 1 ? p.z - 0.6F : p.z;
  run(runSegment,
      {makeCloud("bare.pcd", bare), "-o", output(), "--max-object-size", "2", "--sensor", "5", "5", "-3"});
  EXPECT_LT(report()["up"]["axis"][2], -0.9);
  EXPECT_EQ(report()["up"]["side_from"], "sensor");
  EXPECT_EQ(report()["parameters"]["sensor"]["value"], json({5.0, 5.0, -3.0}));
  run(runSegment, {pathOf("bare.pcd"), "-o", output(), "--max-object-size", "2"});
  EXPECT_GT(report()["up"]["axis"][2], 0.9);
  EXPECT_EQ(report()["up"]["side_from"], "prior");
}

TEST_F(SegmentCommand, AnotherUnitIsWarnedOf) {
  pcl::PointCloud<pcl::PointXYZL> millimetres = floorWithBoxes(false);
  for (pcl::PointXYZL& p : millimetres) p.getVector3fMap() *= 1000;
  const Printed printed =
      run(runSegment, {makeCloud("mm.pcd", millimetres), "-o", output(), "--max-object-size", "2"});
  EXPECT_NE(printed.err.find("warning: "), std::string::npos);
  EXPECT_NE(printed.err.find("metres"), std::string::npos);
  EXPECT_NE(report()["warnings"].dump().find("--max-object-size"), std::string::npos);
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
