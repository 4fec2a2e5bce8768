#include "io/cloud_file.h"

#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <random>

#include "errors.h"
#include "temporary_folder.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

class CloudFile : public TemporaryFolder {
 protected:
  /// The one-line WorkError, naming the file, that reading it must end in.
  static std::string errorOf(const std::string& path) {
    try {
      readCloud(path);
    } catch (const WorkError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("'" + path + "'"), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      return message;
    }
    ADD_FAILURE() << path << " was read";
    return {};
  }

  void expectError(const std::string& name, std::string_view content, const std::string& words) const {
    SCOPED_TRACE(name);
    const std::string message = errorOf(makeFile(name, content));
    EXPECT_NE(message.find(words), std::string::npos) << message;
  }
};

/// A small organised labelled cloud with a NaN, as a filter of PCL would hand it on.
pcl::PointCloud<pcl::PointXYZL> labelledCloud() {
  pcl::PointCloud<pcl::PointXYZL> cloud(3, 2);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto value = static_cast<float>(i);
    cloud[i].getVector3fMap() = Eigen::Vector3f(0.1f * value, -1.5f * value, 3.0f + value);
    cloud[i].label = static_cast<std::uint32_t>(i % 3);
  }
  cloud[4].y = nan;
  cloud.is_dense = false;
  return cloud;
}

/// x, y, z FLOAT64 with this many points a few centimetres apart around a UTM position.
pcl::PCLPointCloud2 utmCloud(std::size_t points) {
  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z"}) appendField(cloud, name, pcl::PCLPointField::FLOAT64, 1);
  allocatePoints(cloud, points, 1);
  for (std::size_t i = 0; i < points; ++i) {
    const auto step = static_cast<double>(i);
    const std::array<double, 3> xyz{499999.5 + 0.01 * step, 5412345.25 - 0.02 * step, -30.0 + 0.001 * step};
    std::memcpy(cloud.data.data() + i * cloud.point_step, xyz.data(), sizeof xyz);
  }
  return cloud;
}

void expectUtmCloud(const Cloud& cloud, std::size_t points, double tolerance) {
  ASSERT_EQ(cloud.points->size(), points);
  EXPECT_EQ(cloud.origin, cloud.origin.array().round().matrix());
  EXPECT_NEAR(cloud.origin.x(), 499999.5, 10.0);
  EXPECT_NEAR(cloud.origin.y(), 5412345.25, 10.0);
  EXPECT_EQ(cloud.origin.z(), 0.0);
  for (std::size_t i = 0; i < points; ++i) {
    const Eigen::Vector3d xyz = (*cloud.points)[i].getVector3fMap().cast<double>() + cloud.origin;
    const auto step = static_cast<double>(i);
    EXPECT_NEAR(xyz.x(), 499999.5 + 0.01 * step, tolerance);
    EXPECT_NEAR(xyz.y(), 5412345.25 - 0.02 * step, tolerance);
    EXPECT_NEAR(xyz.z(), -30.0 + 0.001 * step, tolerance);
  }
}

std::vector<float> floatsOf(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  const pcl::PCLPointField* const field = findField(cloud, name);
  EXPECT_NE(field, nullptr) << name;
  if (field == nullptr) return {};
  const std::vector<double> numbers = fieldNumbers(cloud, *field);
  return {numbers.begin(), numbers.end()};
}

std::string asciiPcd(const std::string& header, const std::string& body) {
  return "# .PCD v0.7\nVERSION 0.7\n" + header + "DATA ascii\n" + body;
}

const std::string xyz_header = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";

std::string extent(const std::string& width, const std::string& height, const std::string& points) {
  return "WIDTH " + width + "\nHEIGHT " + height + "\nPOINTS " + points + "\n";
}

/// The three kinds of PCD, as PCL writes them.
enum class Kind { ASCII, BINARY, COMPRESSED };

void writeByPcl(const std::string& path, const pcl::PCLPointCloud2& cloud, Kind kind) {
  const Eigen::Vector4f position(1.5f, -2.25f, 3.0f, 0.0f);
  const Eigen::Quaternionf rotation(0.5f, 0.5f, -0.5f, 0.5f);
  pcl::PCDWriter writer;
  switch (kind) {
    case Kind::ASCII:
      ASSERT_EQ(writer.writeASCII(path, cloud, position, rotation, 12), 0);
      break;
    case Kind::BINARY:
      ASSERT_EQ(writer.writeBinary(path, cloud, position, rotation), 0);
      break;
    case Kind::COMPRESSED:
      ASSERT_EQ(writer.writeBinaryCompressed(path, cloud, position, rotation), 0);
      break;
  }
}

// ----------------------------------------------------------------------------------------------------------
// round trips

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
    EXPECT_EQ(cloud.sensor_origin, Eigen::Vector4f(1.5f, -2.25f, 3.0f, 0.0f));
    EXPECT_EQ(cloud.sensor_orientation.coeffs(), Eigen::Quaternionf(0.5f, 0.5f, -0.5f, 0.5f).coeffs());
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
    EXPECT_EQ(cloud.labels, (std::vector<int>{0, 1, 2, 3, 4}));
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
  const Eigen::Vector4f position(500000.53f, -0.1f, 1e-9f, 0.0f);
  const Eigen::Quaternionf rotation = Eigen::Quaternionf(0.1f, 0.2f, 0.3f, 0.4f).normalized();
  writePcd(pathOf("a.pcd"), table, position, rotation);
  EXPECT_EQ(names(), std::vector<std::string>{"a.pcd"});
  const Cloud cloud = readCloud(pathOf("a.pcd"));
  EXPECT_EQ(cloud.sensor_origin, position);
  EXPECT_EQ(cloud.sensor_orientation.coeffs(), rotation.coeffs());
  EXPECT_EQ(cloud.fields.height, 2u);
  EXPECT_EQ(cloud.labels, (std::vector<int>{0, 1, 2, 0, 1, 2}));
  pcl::PointCloud<pcl::PointXYZL> by_pcl;
  ASSERT_EQ(pcl::io::loadPCDFile(pathOf("a.pcd"), by_pcl), 0);
  ASSERT_EQ(by_pcl.size(), original.size());
  EXPECT_EQ(by_pcl.sensor_origin_, position);
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

// ------------------------------------------------------------------------------------------------------
// kinds of fields

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
  EXPECT_EQ(cloud.labels, std::vector<int>{5});
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
      readCloud(makeFile("a.pcd", asciiPcd(header + extent("2", "1", "2"), "1 2 3 nan\n4 5 6 1e30\n")));
  EXPECT_EQ(odd.labels, (std::vector<int>{2, 2}));
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

// -----------------------------------------------------------------------------------------------------------------
// text

TEST_F(CloudFile, TextInManySpellings) {
  const std::vector<std::pair<std::string, std::string>> files{
      {"blanks.xyz", "1 2 3 0\n4 5 6 1\n"},
      {"tabs.txt", "\t1\t2\t3\t0\n\n  4 \t5 6 1  \n"},
      {"commas.csv", "1,2,3,0\r\n4, 5 ,6,1\r\n"},
      {"semicolons.csv", "1;2;3;0\n4;5;6;1"},
      {"comments.asc", "# made by hand\n1 2 3 0 # first\n#1 1 1 1\n4 5 6 1\n"},
      {"signs.pts", "2\n+1.0 2e0 .3E+1 0\n4. 5 6 +1\n"},
      {"names.csv", "X,Y,Z,Label\n1,2,3,0\n4,5,6,1\n"},
      {"shuffled.csv", "\"label\";\"Z\";\"name\";\"y\";\"x\"\n0;3;rock;2;1\n1;6;;5;4\n"},
      {"cloudcompare.asc", "//X Y Z label\n1 2 3 0\n4 5 6 1\n"},
      {"title.xyz", "easting northing height class\n1 2 3 0\n4 5 6 1\n"},
      {"mark.xyz",
       "\xEF\xBB\xBF"
       "1 2 3 0\n4 5 6 1\n"},
      {"no_extension", "1 2 3 0\n4 5 6 1\n"}};
  for (const auto& [name, content] : files) {
    SCOPED_TRACE(name);
    const Cloud cloud = readCloud(makeFile(name, content));
    ASSERT_EQ(cloud.points->size(), 2u);
    EXPECT_EQ((*cloud.points)[0].getVector3fMap(), Eigen::Vector3f(1, 2, 3));
    EXPECT_EQ((*cloud.points)[1].getVector3fMap(), Eigen::Vector3f(4, 5, 6));
    EXPECT_EQ(cloud.labels, (std::vector<int>{0, 1}));
    EXPECT_EQ(cloud.fields.width, 2u);
    EXPECT_EQ(cloud.fields.height, 1u);
  }
}

TEST_F(CloudFile, OtherTextColumns) {
  const Cloud named = readCloud(makeFile("a.csv", "x,y,z,intensity,name\n1,2,3,0.5,rock\n4,5,6,,sand\n"));
  EXPECT_EQ(floatsOf(named.fields, "intensity").front(), 0.5f);
  EXPECT_TRUE(std::isnan(floatsOf(named.fields, "intensity").back()));
  EXPECT_TRUE(named.labels.empty());
  const Cloud counted = readCloud(makeFile("a.xyz", "1 2 3 0.5 255 0\n"));
  EXPECT_EQ(counted.fields.fields.size(), 3u);
  EXPECT_TRUE(counted.labels.empty());
  EXPECT_EQ(readCloud(makeFile("b.xyz", "1 2 3 nan\n4 5 6 1\n")).labels, (std::vector<int>{2, 1}));
}

TEST_F(CloudFile, MalformedTextNamesTheLine) {
  expectError("a.xyz", "1 2 3\n# a comment\n4 5 abc\n", "line 3 is malformed: '4 5 abc'");
  expectError("b.xyz", "1 2 3\n4 5\n", "line 2 is malformed: '4 5'");
  expectError("c.xyz", "1 2 3\n4 5 6 7\n", "line 2 is malformed: '4 5 6 7'");
  expectError("d.csv", "1,2,3\n4,,6\n", "line 2 is malformed: '4,,6'");
  expectError("e.xyz", "x y z\nx y z\n1 2 3\n", "line 2 is malformed");
  expectError("f.xyz", "1 2\n3 4\n", "line 1 is malformed");
  expectError("g.xyz", "1 2 3 0\n1 2 3 0.5\n", "the label a whole number");
  expectError("h.xyz", "1 2 1e999\n", "line 1 is malformed");
  expectError("i.xyz", "x y height\n1 2 3\n", "x, y and z");
  expectError("j.xyz", "1 2 0x3\n", "line 1 is malformed");
  expectError("k.xyz", "1 2 \x1b[31m\x07" + std::string(5000, 'a') + "\n",
              "line 1 is malformed: '1 2 ?[31m?aaa");
  expectError("l.xyz", "# nothing here\n\n", "holds no points");
  expectError("m.xyz", "x y z\n", "holds no points");
  expectError("n.xyz", std::string("1 2 3\n\0\n", 8), "neither PCD nor PLY nor text");
}

// -------------------------------------------------------------------------------------------------------------------
// PLY

TEST_F(CloudFile, PlyWithFacesListsAndOtherElementsInFront) {
  const std::string header =
      "comment made by hand\nobj_info none\nelement camera 1\nproperty float view\nproperty list uchar int "
      "tags\n"
      "element nothing 1000000000\n"
      "element vertex 2\nproperty double x\nproperty list uchar short extra\nproperty float y\nproperty int "
      "z\n"
      "property uchar label\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  makeFile("a.ply", "ply\nformat ascii 1.0\n" + header + "9.5 2 1 2\n1 3 7 7 7 2 3 0\n4 0 5 6 1\n3 0 1 0\n");
  const auto big = [](auto value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return std::string(bytes.rbegin(), bytes.rend());
  };
  const std::string camera = big(9.5f) + '\x01' + big(std::int32_t{5});
  const std::string vertices = big(1.0) + '\x01' + big(std::int16_t{7}) + big(2.0f) + big(std::int32_t{3}) +
                               '\0' + big(4.0) + '\0' + big(5.0f) + big(std::int32_t{6}) + '\x01';
  makeFile("b.ply", "ply\r\nformat binary_big_endian 1.0\r\n" + header + camera + vertices);
  for (const char* name : {"a.ply", "b.ply"}) {
    SCOPED_TRACE(name);
    const Cloud cloud = readCloud(pathOf(name));
    ASSERT_EQ(cloud.points->size(), 2u);
    EXPECT_EQ((*cloud.points)[0].getVector3fMap(), Eigen::Vector3f(1, 2, 3));
    EXPECT_EQ((*cloud.points)[1].getVector3fMap(), Eigen::Vector3f(4, 5, 6));
    EXPECT_EQ(cloud.labels, (std::vector<int>{0, 1}));
  }
}

TEST_F(CloudFile, BadPlyIsRefused) {
  const std::string ascii = "ply\nformat ascii 1.0\n";
  const std::string binary = "ply\nformat binary_little_endian 1.0\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\nend_header\n";
  expectError("a.ply", ascii + "element vertex 1000000000000\n" + xyz + "1 2 3\n", "1000000000000");
  expectError("b.ply", ascii + "element vertex 2000000000\n" + xyz + "1 2 3\n", "truncated");
  expectError("c.ply", binary + "element vertex 2000000000\n" + xyz + "123456789012", "truncated");
  expectError("d.ply", ascii + "element vertex -1\n" + xyz, "'-1'");
  expectError("e.ply", ascii + "element vertex 0\n" + xyz, "holds no points");
  expectError("f.ply", ascii + "element vertex 3\n" + xyz + "1 2 3\n4 5 6\n7 8\n", "truncated");
  expectError("g.ply", ascii + "element vertex 1\n" + xyz + "1 two 3\n", "'two'");
  expectError("h.ply", ascii + "element vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n",
              "'z'");
  expectError("i.ply", ascii + "element vertex 1\nproperty list uchar float x\nend_header\n1 2\n", "x, y, z");
  expectError("j.ply", ascii + "element vertex 1\nproperty half x\nend_header\n1\n", "'half'");
  expectError("k.ply", ascii + "element vertex 1\nproperty float x\n", "end_header");
  expectError("l.ply", ascii + "element face 0\nend_header\n", "'vertex'");
  expectError("m.ply", ascii + "element vertex 2147483647\nend_header\n", "x, y, z");
  expectError("n.ply", "ply\nformat fancy 1.0\nend_header\n", "'fancy'");
  expectError("o.ply", "ply\nelement vertex 1\n" + xyz + "1 2 3\n", "format");
  expectError("p.ply", "1 2 3\n4 5 6\n", "no PLY file");
  expectError("q.ply", ascii + "what is this\n", "'what is this'");
  expectError("r.ply",
              binary + "element face 1\nproperty list uint int vertex_indices\nelement vertex 1\n" + xyz +
                  "\xff\xff\xff\xff" + std::string(20, 'a'),
              "truncated");
}

// -------------------------------------------------------------------------------------------------------------------
// PCD

TEST_F(CloudFile, OlderAndOddPcdHeadersAreRead) {
  makeFile("old.pcd", "COLUMNS x y z\nPOINTS 2\nDATA ascii\n1 2 3\n4 5 6\n");
  makeFile("crlf.pcd",
           "FIELDS x y z\r\nSIZE 4 4 4\r\nTYPE F F F\r\nWIDTH 2\r\nDATA ascii\r\n1 2 3\r\n\r\n4 5 6\r\n");
  makeFile("shuffled.pcd",
           "POINTS 2\nTYPE F F F\nHEIGHT 1\nSIZE 4 4 4\nWIDTH 2\n# by hand\nFIELDS x y z\nDATA ascii\n"
           "1 2 3\n4 5 6");
  makeFile("by_content.txt", asciiPcd(xyz_header + extent("2", "1", "2"), "1 2 3\n4 5 6\n"));
  makeFile("no_rotation.pcd",
           asciiPcd(xyz_header + "VIEWPOINT 0 0 0 0 0 0 0\n" + extent("2", "1", "2"), "1 2 3\n4 5 6\n"));
  for (const char* name : {"old.pcd", "crlf.pcd", "shuffled.pcd", "by_content.txt", "no_rotation.pcd"}) {
    SCOPED_TRACE(name);
    const Cloud cloud = readCloud(pathOf(name));
    ASSERT_EQ(cloud.points->size(), 2u);
    EXPECT_EQ((*cloud.points)[1].getVector3fMap(), Eigen::Vector3f(4, 5, 6));
    EXPECT_EQ(cloud.sensor_orientation.coeffs(), Eigen::Quaternionf::Identity().coeffs());
  }
}

TEST_F(CloudFile, PcdHeadersThatClaimTooMuchAreRefused) {
  const std::string body = "1 2 3\n4 5 6\n";
  expectError("a.pcd", asciiPcd(xyz_header + extent("1000000000000", "1", "1000000000000"), body),
              "1000000000000");
  expectError("b.pcd", asciiPcd(xyz_header + extent("-2", "1", "-2"), body), "'-2'");
  expectError("c.pcd", asciiPcd(xyz_header + extent("2", "-1", "2"), body), "'-1'");
  expectError("d.pcd", asciiPcd(xyz_header + extent("65536", "65536", "0"), body), "65536");
  expectError("e.pcd", asciiPcd(xyz_header + extent("2", "1", "3"), body), "POINTS, 3");
  expectError("f.pcd", asciiPcd(xyz_header + extent("3", "1", "3"), body), "truncated");
  expectError("g.pcd", asciiPcd(xyz_header + extent("99999999999999999999", "1", "2"), body),
              "99999999999999999999");
  expectError("h.pcd", asciiPcd(xyz_header + extent("2000000000", "1", "2000000000"), body), "truncated");
  expectError("i.pcd", asciiPcd(xyz_header + extent("two", "1", "2"), body), "'two'");
  for (const char* data : {"binary", "binary_compressed"}) {
    const std::string header = xyz_header + extent("2000000000", "1", "2000000000") + "DATA " + data + "\n";
    expectError("j.pcd", header + std::string(100, 'a'), "");
    expectError("k.pcd", xyz_header + extent("0", "1", "0") + "DATA " + data + "\n" + std::string(8, '\0'),
                "holds no points");
  }
  expectError("l.pcd", asciiPcd(xyz_header + extent("0", "1", "0"), ""), "holds no points");
}

TEST_F(CloudFile, PcdHeadersWithBadFieldsAreRefused) {
  const auto header = [](const std::string& sizes, const std::string& types, const std::string& counts) {
    return asciiPcd("FIELDS x y z\nSIZE " + sizes + "\nTYPE " + types + "\nCOUNT " + counts + "\n" +
                        extent("1", "1", "1"),
                    "1 2 3\n");
  };
  expectError("a.pcd", header("4 4 4", "F F Q", "1 1 1"), "'Q'");
  expectError("b.pcd", header("4 4 0", "F F F", "1 1 1"), "'0'");
  expectError("c.pcd", header("4 4 -4", "F F F", "1 1 1"), "'-4'");
  expectError("d.pcd", header("4 4 3", "F F F", "1 1 1"), "'3'");
  expectError("e.pcd", header("4 4 4", "F F F", "1 1 0"), "'0'");
  expectError("f.pcd", header("4 4 4", "F F F", "1 1 -1"), "'-1'");
  expectError("g.pcd", header("4 4 4", "F F F", "1 1 4294967297"), "'4294967297'");
  expectError("h.pcd", header("4 4 4", "F F F", "1 1 16777216"), "16777216");
  expectError("i.pcd", header("4 4", "F F F", "1 1 1"), "SIZE has 2 values for 3 fields");
  expectError("j.pcd", header("4 4 4", "F F F", "2 1 1"), "");
  const std::string one = extent("1", "1", "1");
  expectError("k.pcd", asciiPcd("FIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\n" + one, "1 2\n"),
              "no field 'z'");
  expectError("l.pcd", asciiPcd("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 2\n" + one, "1 2 3 4\n"),
              "'z' has 2 values");
  expectError("m.pcd", asciiPcd("FIELDS\n" + one, "1 2 3\n"), "FIELDS");
  expectError("n.pcd", asciiPcd(xyz_header + "VIEWPOINT 0 0 0 1 0 0\n" + one, "1 2 3\n"), "VIEWPOINT");
  expectError("o.pcd", asciiPcd(xyz_header + "VIEWPOINT 0 0 nan 1 0 0 0\n" + one, "1 2 3\n"), "VIEWPOINT");
  expectError("p.pcd", xyz_header + one + "DATA fancy\n1 2 3\n", "'fancy'");
  expectError("q.pcd", xyz_header + one, "DATA");
  expectError("r.pcd", asciiPcd(xyz_header + one, "1 2 three\n"), "'1 2 three'");
  expectError("s.pcd", asciiPcd(xyz_header + one, "1 2 3 4\n"), "'1 2 3 4'");
}

TEST_F(CloudFile, CompressedSizesThatLieAreRefused) {
  const std::string header = xyz_header + extent("2", "1", "2") + "DATA binary_compressed\n";
  const auto sizes = [](std::uint32_t compressed, std::uint32_t plain) {
    std::string bytes(8, '\0');
    std::memcpy(bytes.data(), &compressed, 4);
    std::memcpy(bytes.data() + 4, &plain, 4);
    return bytes;
  };
  expectError("a.pcd", header + "123", "truncated");
  expectError("b.pcd", header + sizes(4000000000u, 24) + std::string(25, '\0'), "truncated");
  expectError("c.pcd", header + sizes(25, 4000000000u) + std::string(25, '\0'), "4000000000");
  expectError("d.pcd", header + sizes(25, 24) + std::string(25, '\xff'), "damaged");
  expectError("e.pcd", header + sizes(0, 24), "too short");
  const std::string large = xyz_header + extent("100000000", "1", "100000000") + "DATA binary_compressed\n";
  expectError("f.pcd", large + sizes(25, 1200000000u) + std::string(25, '\0'), "too short");
}

// ----------------------------------------------------------------------------------------------------- what
// is no cloud

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

// ------------------------------------------------------------------------------------------------- damaged
// files at large

/// A valid small file of each kind, damaged in every way that a fixed seed gives.
class DamagedCloudFile : public CloudFile, public ::testing::WithParamInterface<std::string> {
 protected:
  std::string validFile() const {
    pcl::PCLPointCloud2 table;
    pcl::toPCLPointCloud2(labelledCloud(), table);
    const std::string path = pathOf("valid");
    if (GetParam() == "ascii.pcd") writeByPcl(path, table, Kind::ASCII);
    if (GetParam() == "binary.pcd") writeByPcl(path, table, Kind::BINARY);
    if (GetParam() == "compressed.pcd") writeByPcl(path, table, Kind::COMPRESSED);
    if (GetParam() == "ascii.ply" || GetParam() == "binary.ply") {
      pcl::PLYWriter().write(path, table, Eigen::Vector4f::Zero(), Eigen::Quaternionf::Identity(),
                             GetParam() == "binary.ply", true);
    }
    if (GetParam() == "text.csv") makeFile("valid", "x;y;z;label\n1.5;2;3;0\n4;5e1;nan;1\n-7;8;9;2\n");
    return contentOf(path).substr(0, usedSize(path));
  }

  /// PCL pads its binary files to whole pages: the bytes of such a file up to its last point. All bytes of
  /// any other.
  std::size_t usedSize(const std::string& path) const {
    if (GetParam() != "binary.pcd" && GetParam() != "compressed.pcd") return std::string::npos;
    pcl::PCLPointCloud2 header;
    Eigen::Vector4f position;
    Eigen::Quaternionf rotation;
    int version = 0, storage = 0;
    unsigned int body = 0;
    pcl::PCDReader().readHeader(path, header, position, rotation, version, storage, body);
    if (GetParam() == "binary.pcd") return body + pointCount(header) * header.point_step;
    std::uint32_t compressed = 0;
    std::memcpy(&compressed, contentOf(path).data() + body, sizeof compressed);
    return body + 2 * sizeof compressed + compressed;
  }

  /// A cloud or a WorkError.
  /// \return whether it was a cloud
  bool readsOrRefuses(const std::string& content) const {
    const std::string path = makeFile(GetParam(), content);
    try {
      const Cloud cloud = readCloud(path);
      EXPECT_GT(cloud.points->size(), 0u);
      EXPECT_EQ(cloud.points->size(), pointCount(cloud.fields));
      EXPECT_EQ(cloud.fields.data.size(), pointCount(cloud.fields) * cloud.fields.point_step);
      EXPECT_LE(cloud.points->size(), 100 * content.size());
      return true;
    } catch (const WorkError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      return false;
    }
  }
};

TEST_P(DamagedCloudFile, TruncatedAtEveryLength) {
  const std::string content = validFile();
  ASSERT_TRUE(readsOrRefuses(content));
  std::size_t read = 0;
  for (std::size_t length = 0; length < content.size(); ++length) {
    SCOPED_TRACE(length);
    if (readsOrRefuses(content.substr(0, length))) ++read;
  }
  // Binary points are all needed; in text a last line end or digit is not, and PLY has a camera behind its
  // points.
  const bool all_needed = GetParam() == "binary.pcd" || GetParam() == "compressed.pcd";
  EXPECT_LE(read, all_needed ? 0 : content.size() / 2);
}

TEST_P(DamagedCloudFile, BytesChanged) {
  const std::string content = validFile();
  ASSERT_FALSE(content.empty());
  constexpr std::string_view nasty = "0919-. \n#xz_\xff";
  for (unsigned seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string damaged = content;
    const unsigned changes = 1 + random() % 3;
    for (unsigned i = 0; i < changes; ++i) {
      const auto byte = seed % 2 == 0 ? static_cast<char>(random()) : nasty[random() % nasty.size()];
      damaged[random() % damaged.size()] = byte;
    }
    readsOrRefuses(damaged);
  }
}

TEST_P(DamagedCloudFile, PiecesDoubledAndRemoved) {
  const std::string content = validFile();
  ASSERT_FALSE(content.empty());
  for (unsigned seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string damaged = content;
    const std::string piece = damaged.substr(random() % damaged.size(), random() % 20);
    damaged.insert(random() % damaged.size(), piece);
    damaged.erase(random() % damaged.size(), random() % 5);
    readsOrRefuses(damaged);
  }
}

INSTANTIATE_TEST_SUITE_P(EveryKind, DamagedCloudFile,
                         ::testing::Values("ascii.pcd", "binary.pcd", "compressed.pcd", "ascii.ply",
                                           "binary.ply", "text.csv"),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           name[name.find('.')] = '_';
                           return name;
                         });

}  // namespace
}  // namespace pcl_fft_ground::cli
