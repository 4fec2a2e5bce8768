#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "cloud_file_fixture.h"

namespace pcl_fft_ground::cli {
namespace {

TEST_F(CloudFile, ReadsWhatPclWritesAsPcd) {
  const auto original = labelledCloud();
  pcl::PCLPointCloud2 table;
  pcl::toPCLPointCloud2(original, table);  // with PCL's gaps between z and label
  for (const Kind kind : {Kind::ASCII, Kind::BINARY, Kind::COMPRESSED}) {
    SCOPED_TRACE(static_cast<int>(kind));
    writeByPcl(pathOf("a.pcd"), table, kind);
    const Cloud cloud = readCloud(pathOf("a.pcd"));
    EXPECT_EQ(cloud.fields.width, 3u);
    EXPECT_EQ(cloud.fields.height, 2u);
    EXPECT_EQ(cloud.points->width, 3u);
    EXPECT_FALSE(cloud.points->is_dense);
    EXPECT_FALSE(cloud.fields.is_dense);
    EXPECT_EQ(cloud.origin, Eigen::Vector3d::Zero());
    EXPECT_EQ(cloud.labels, (std::vector<int>{0, 1, 2, 0, 1, 2}));
    EXPECT_EQ(cloud.viewpoint.position, Eigen::Vector3d(1.5, -2.25, 3));
    EXPECT_EQ(cloud.viewpoint.rotation.coeffs(), Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5).coeffs());
    ASSERT_EQ(cloud.points->size(), original.size());
    for (std::size_t i = 0; i < original.size(); ++i) {
      EXPECT_EQ((*cloud.points)[i].x, original[i].x);
      EXPECT_EQ((*cloud.points)[i].z, original[i].z);
      if (i != 4) {
        EXPECT_EQ((*cloud.points)[i].y, original[i].y);
      }
    }
    EXPECT_TRUE(std::isnan((*cloud.points)[4].y));
    pcl::PointCloud<pcl::PointXYZL> again;
    pcl::fromPCLPointCloud2(cloud.fields, again);
    EXPECT_EQ(again[5].label, 2u);
    EXPECT_EQ(again[5].z, original[5].z);
  }
}

TEST_F(CloudFile, ReadsWhatPclWritesAsPly) {
  pcl::PointCloud<pcl::PointXYZLNormal> original;
  for (int i = 0; i < 5; ++i) {
    pcl::PointXYZLNormal point;
    point.getVector3fMap() = Eigen::Vector3f(0.5f * static_cast<float>(i), 1.0f, -2.0f);
    point.getNormalVector3fMap() = Eigen::Vector3f(0.0f, static_cast<float>(i), 1.0f);
    point.label = static_cast<std::uint32_t>(i);
    original.push_back(point);
  }
  for (const bool binary : {false, true}) {
    SCOPED_TRACE(binary);
    pcl::PCLPointCloud2 table;
    pcl::toPCLPointCloud2(original, table);
    ASSERT_EQ(pcl::PLYWriter().write(pathOf("a.ply"), table, Eigen::Vector4f::Zero(),
                                     Eigen::Quaternionf::Identity(), binary, true),
              0);
    const Cloud cloud = readCloud(pathOf("a.ply"));
    ASSERT_EQ(cloud.points->size(), 5u);
    EXPECT_TRUE(cloud.points->is_dense);
    EXPECT_EQ((*cloud.points)[3].x, 1.5f);
    EXPECT_EQ((*cloud.points)[3].z, -2.0f);
    EXPECT_EQ(floatsOf(cloud.fields, "normal_y"), (std::vector<float>{0, 1, 2, 3, 4}));
    EXPECT_EQ(floatsOf(cloud.fields, "label"), (std::vector<float>{0, 1, 2, 3, 4}));
  }
}

TEST_F(CloudFile, DoubleUtmCoordinatesKeepTheirCentimetres) {
  const pcl::PCLPointCloud2 utm = utmCloud(50);
  for (const Kind kind : {Kind::ASCII, Kind::BINARY, Kind::COMPRESSED}) {
    SCOPED_TRACE(static_cast<int>(kind));
    writeByPcl(pathOf("a.pcd"), utm, kind);
    expectUtmCloud(readCloud(pathOf("a.pcd")), 50, 1e-6);
  }
  std::string text;
  for (int i = 0; i < 50; ++i) {
    std::array<char, 100> line{};
    std::snprintf(line.data(), line.size(), "%.3f %.3f %.3f\n", 499999.5 + 0.01 * i, 5412345.25 - 0.02 * i,
                  -30.0 + 0.001 * i);
    text += line.data();
  }
  expectUtmCloud(readCloud(makeFile("a.xyz", text)), 50, 1e-6);
  const std::string ply =
      "element vertex 50\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  expectUtmCloud(readCloud(makeFile("a.ply", "ply\nformat ascii 1.0\n" + ply + text)), 50, 1e-6);
  const std::string bytes(utm.data.begin(), utm.data.end());
  expectUtmCloud(readCloud(makeFile("b.ply", "ply\nformat binary_little_endian 1.0\n" + ply + bytes)), 50,
                 1e-6);
}

TEST_F(CloudFile, OneFarOutlierDoesNotMoveTheOrigin) {
  const Cloud small = readCloud(makeFile("a.xyz", "1 2 3\n2 3 4\n1e12 -1e12 1e12\n3 4 5\n2 2 nan\n"));
  EXPECT_EQ(small.origin, Eigen::Vector3d::Zero());
  const Cloud large = readCloud(makeFile("b.xyz", "500000.5 2 3\n500001.25 3 4\n-1e12 4 5\n500002 0 1\n"));
  EXPECT_NEAR(large.origin.x(), 500001.0, 1.0);
  EXPECT_EQ(large.origin.tail<2>(), Eigen::Vector2d::Zero());
  EXPECT_EQ((*large.points)[1].x + large.origin.x(), 500001.25);
}

TEST_F(CloudFile, WrittenCloudsAreReadBackByUsAndByPcl) {
  auto original = labelledCloud();
  pcl::PCLPointCloud2 table;
  pcl::toPCLPointCloud2(original, table);
  const Eigen::Vector3d position(6000000.123456, -0.1, 1e-9);
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(0.1, 0.2, 0.3, 0.4).normalized();
  writePcd(pathOf("a.pcd"), table, {position, rotation});
  EXPECT_EQ(names(), std::vector<std::string>{"a.pcd"});
  const Cloud cloud = readCloud(pathOf("a.pcd"));
  EXPECT_EQ(cloud.viewpoint.position, position);
  EXPECT_EQ(cloud.viewpoint.rotation.coeffs(), rotation.coeffs());
  EXPECT_EQ(cloud.fields.height, 2u);
  EXPECT_EQ(cloud.labels, (std::vector<int>{0, 1, 2, 0, 1, 2}));
  pcl::PointCloud<pcl::PointXYZL> by_pcl;
  ASSERT_EQ(pcl::io::loadPCDFile(pathOf("a.pcd"), by_pcl), 0);
  ASSERT_EQ(by_pcl.size(), original.size());
  EXPECT_EQ(by_pcl.sensor_origin_.head<3>(), position.cast<float>());
  EXPECT_EQ(by_pcl[3].x, original[3].x);
  EXPECT_EQ(by_pcl[5].label, 2u);
}

TEST_F(CloudFile, ACloudWithoutPointsIsWrittenButNotRead) {
  pcl::PCLPointCloud2 table;
  pcl::toPCLPointCloud2(pcl::PointCloud<pcl::PointXYZL>(), table);
  writePcd(pathOf("a.pcd"), table);
  EXPECT_NE(contentOf(pathOf("a.pcd")).find("FIELDS x y z label\n"), std::string::npos);
  EXPECT_NE(errorOf(pathOf("a.pcd")).find("holds no points"), std::string::npos);
  EXPECT_THROW(writePcd(pathOf("missing/a.pcd"), table), WorkError);
}

TEST_F(CloudFile, EveryFieldTypeIsKept) {
  const std::string header =
      "FIELDS i1 u1 x i2 u2 y i4 u4 z i8 u8 h\nSIZE 1 1 8 2 2 4 4 4 4 8 8 8\nTYPE I U F I U F I U I I U F\n"
      "COUNT 1 1 1 1 1 1 1 1 1 1 1 3\n";
  const Cloud cloud =
      readCloud(makeFile("a.pcd", asciiPcd(header + extent("1", "1", "1"),
                                           "-128 255 1.5 -32768 65535 2.5 -2147483648 4294967295 "
                                           "-7 -9007199254740992 9007199254740992 0.1 0.2 0.3\n")));
  EXPECT_EQ(cloud.fields.fields.size(), 12u);
  EXPECT_EQ((*cloud.points)[0].getVector3fMap(), Eigen::Vector3f(1.5f, 2.5f, -7.0f));
  EXPECT_EQ(findField(cloud.fields, "z")->datatype, static_cast<int>(pcl::PCLPointField::FLOAT32));
  EXPECT_EQ(findField(cloud.fields, "h")->count, 3u);
  const std::vector<std::pair<std::string, double>> expected{{"i1", -128},
                                                             {"u1", 255},
                                                             {"i2", -32768},
                                                             {"u2", 65535},
                                                             {"i4", -2147483648.0},
                                                             {"u4", 4294967295.0},
                                                             {"i8", -9007199254740992.0},
                                                             {"u8", 9007199254740992.0},
                                                             {"h", 0.1}};
  for (const auto& [name, value] : expected) {
    EXPECT_EQ(fieldNumbers(cloud.fields, *findField(cloud.fields, name)).front(), value) << name;
  }
  writePcd(pathOf("b.pcd"), cloud.fields);
  const Cloud again = readCloud(pathOf("b.pcd"));
  EXPECT_EQ(again.fields.data, cloud.fields.data);
}

TEST_F(CloudFile, PaddingIsDroppedInEveryKindOfPcd) {
  const std::string header =
      "FIELDS x _ y z _ label\nSIZE 4 1 4 4 2 4\nTYPE F U F F U I\nCOUNT 1 3 1 1 2 1\n" +
      extent("2", "1", "2");
  const std::string point_1("\0\0\x80\x3f***\0\0\0\x40\0\0\x40\x40----\x01\0\0\0", 23);
  const std::string point_2("\0\0\0\x40***\0\0\x40\x40\0\0\x80\x3f----\x02\0\0\0", 23);
  const std::string columns(
      "\0\0\x80\x3f\0\0\0\x40\0\0\0\x40\0\0\x40\x40\0\0\x40\x40\0\0\x80\x3f\x01\0\0\0\x02\0\0\0", 32);
  const std::string literal_run(1, '\x1f');  // LZF: 32 plain bytes follow
  const std::string sizes("\x21\0\0\0\x20\0\0\0", 8);
  makeFile("a.pcd", asciiPcd(header, "1 7 7 7 2 3 8 8 1\n2 7 7 7 3 1 8 8 2\n"));
  makeFile("b.pcd", header + "DATA binary\n" + point_1 + point_2);
  makeFile("c.pcd", header + "DATA binary_compressed\n" + sizes + literal_run + columns);
  for (const char* name : {"a.pcd", "b.pcd", "c.pcd"}) {
    SCOPED_TRACE(name);
    const Cloud cloud = readCloud(pathOf(name));
    EXPECT_EQ(cloud.fields.fields.size(), 4u);
    EXPECT_EQ(cloud.fields.point_step, 16u);
    EXPECT_EQ((*cloud.points)[0].getVector3fMap(), Eigen::Vector3f(1.0f, 2.0f, 3.0f));
    EXPECT_EQ((*cloud.points)[1].getVector3fMap(), Eigen::Vector3f(2.0f, 3.0f, 1.0f));
    EXPECT_EQ(cloud.labels, (std::vector<int>{1, 2}));
  }
}

TEST_F(CloudFile, OfFieldsWithTheSameNameTheFirstCounts) {
  const std::string header =
      "FIELDS x y z x label label\nSIZE 4 4 4 4 4 4\nTYPE F F F F I I\nCOUNT 1 1 1 1 1 1\n";
  const Cloud cloud = readCloud(makeFile("a.pcd", asciiPcd(header + extent("1", "1", "1"), "1 2 3 4 5 6\n")));
  EXPECT_EQ((*cloud.points)[0].x, 1.0f);
  EXPECT_NE(cloud.label_fault.find("its labels are 5:"), std::string::npos) << cloud.label_fault;
  EXPECT_EQ(cloud.fields.fields.size(), 6u);
}

TEST_F(CloudFile, LabelsOfAnyTypeAreRead) {
  for (const char* type : {"I 1", "U 2", "I 8", "F 4", "F 8"}) {
    SCOPED_TRACE(type);
    const std::string header = "FIELDS x y z label\nSIZE 4 4 4 " + std::string(1, type[2]) + "\nTYPE F F F " +
                               std::string(1, type[0]) + "\nCOUNT 1 1 1 1\n";
    const Cloud cloud =
        readCloud(makeFile("a.pcd", asciiPcd(header + extent("2", "1", "2"), "1 2 3 0\n4 5 6 1\n")));
    EXPECT_EQ(cloud.labels, (std::vector<int>{0, 1}));
  }
  const std::string header = "FIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n";
  const Cloud odd =
      readCloud(makeFile("a.pcd", asciiPcd(header + extent("2", "1", "2"), "1 2 3 nan\n4 5 6 1\n")));
  EXPECT_EQ(odd.labels, (std::vector<int>{2, 1}));
  EXPECT_TRUE(readCloud(makeFile("b.xyz", "1 2 3\n")).labels.empty());
}

TEST_F(CloudFile, NothingButNaNIsReturned) {
  const Cloud cloud = readCloud(makeFile("a.xyz", "nan nan nan\nnan inf -inf\n"));
  EXPECT_EQ(cloud.points->size(), 2u);
  EXPECT_FALSE(cloud.points->is_dense);
  EXPECT_EQ(cloud.origin, Eigen::Vector3d::Zero());
}

TEST_F(CloudFile, FieldsAreRenamedWithoutLosingOne) {
  Cloud cloud = readCloud(makeFile("a.csv", "x,y,z,label,truth,truth_2\n1,2,3,4,5,6\n"));
  renameField(cloud.fields, "segment", "truth_segment");  // there is none
  renameField(cloud.fields, "label", "truth");
  EXPECT_EQ(findField(cloud.fields, "label"), nullptr);
  EXPECT_EQ(floatsOf(cloud.fields, "truth"), std::vector<float>{4});
  EXPECT_EQ(floatsOf(cloud.fields, "truth_2"), std::vector<float>{6});
  EXPECT_EQ(floatsOf(cloud.fields, "truth_3"), std::vector<float>{5});
}

TEST_F(CloudFile, Int32FieldsAreAppendedAndReplaced) {
  pcl::PCLPointCloud2 table;
  pcl::toPCLPointCloud2(labelledCloud(), table);
  setInt32Field(table, "segment", {-1, 2147483647, 3, 4, 5, 6});
  setInt32Field(table, "label", {6, 5, 4, 3, 2, 1});
  EXPECT_EQ(table.fields.size(), 5u);
  EXPECT_EQ(table.height, 2u);
  EXPECT_EQ(floatsOf(table, "label"), (std::vector<float>{6, 5, 4, 3, 2, 1}));
  EXPECT_EQ(fieldNumbers(table, *findField(table, "segment"))[1], 2147483647.0);
  EXPECT_EQ(floatsOf(table, "z"), (std::vector<float>{3, 4, 5, 6, 7, 8}));
  EXPECT_THROW(setInt32Field(table, "label", {1, 2}), std::invalid_argument);
}

TEST_F(CloudFile, PointsAreSelectedInTheGivenOrder) {
  pcl::PCLPointCloud2 table;
  pcl::toPCLPointCloud2(labelledCloud(), table);
  const pcl::PCLPointCloud2 subset = selectPoints(table, {5, 0, 5});
  EXPECT_EQ(subset.width, 3u);
  EXPECT_EQ(subset.height, 1u);
  EXPECT_EQ(floatsOf(subset, "z"), (std::vector<float>{8, 3, 8}));
  EXPECT_EQ(floatsOf(subset, "label"), (std::vector<float>{2, 0, 2}));
  EXPECT_EQ(pointCount(selectPoints(table, {})), 0u);
  EXPECT_THROW(selectPoints(table, {6}), std::out_of_range);
  EXPECT_THROW(selectPoints(table, {-1}), std::out_of_range);
}

TEST_F(CloudFile, WhatIsNoFileIsRefused) {
  EXPECT_NE(errorOf(pathOf("missing.pcd")).find("No such file"), std::string::npos);
  EXPECT_NE(errorOf(folder_.string()).find("folder"), std::string::npos);
  EXPECT_NE(errorOf("/dev/zero").find("not a regular file"), std::string::npos);
  EXPECT_NE(errorOf("").find("No such file"), std::string::npos);
  for (const char* name : {"a.pcd", "a.ply", "a.xyz"}) expectError(name, "", "is empty");
}

TEST_F(CloudFile, AnUnreadableFileIsRefused) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const std::string path = makeFile("a.pcd", "1 2 3\n");
  std::filesystem::permissions(path, std::filesystem::perms::none);
  EXPECT_NE(errorOf(path).find("Permission denied"), std::string::npos);
}

TEST_F(CloudFile, GarbageIsRefused) {
  std::mt19937 random(7);
  std::string garbage(5000, '\0');
  for (char& byte : garbage) byte = static_cast<char>(random());
  for (const char* name : {"a.pcd", "a.ply", "a.xyz", "a.jpg"}) expectError(name, garbage, "");
}

TEST_F(CloudFile, ReadingIsSilent) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  errorOf(makeFile("a.ply",
                   "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nnonsense\nend_header\n1\n"));
  errorOf(makeFile("a.pcd", asciiPcd(xyz_header + extent("5", "1", "5"), "1 2 3\n")));
  readCloud(makeFile("b.pcd", asciiPcd(xyz_header + extent("1", "1", "1"), "1 2 3\n")));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace pcl_fft_ground::cli
