// Text as programs of the field write it, and files that are no clouds of ours: read right, or named.

#include <cmath>
#include <cstdio>

#include "cloud_file_fixture.h"

namespace pcl_fft_ground::cli {
namespace {

std::vector<std::string> fieldNames(const Cloud& cloud) {
  std::vector<std::string> names;
  for (const auto& field : cloud.fields.fields) names.push_back(field.name);
  return names;
}

using Names = std::vector<std::string>;

TEST_F(CloudFile, CoordinatesHoweverTextWritesThem) {
  const std::vector<std::pair<std::string, std::string>> files{
      {"decimal commas, semicolons", "1,5;2,25;-3\n4,5;5;6\n"},
      {"decimal commas, blanks", "1,5 2,25 -3\n4,5 5 6\n"},
      {"decimal commas, tabs", "X\tY\tZ\n1,5\t2,25\t-3\n4,5\t5\t6\n"},
      {"decimal commas, not in the first line", "1.5 2.25 -3\n4,5 5,0 6,0\n"},
      {"decimal commas in quotes", "\"X\",\"Y\",\"Z\"\n\"1,5\",\"2,25\",\"-3\"\n\"4,5\",\"5\",\"6\"\n"},
      {"quotes", "\"1.5\",\"2.25\",\"-3\"\n'4.5','5','6'\n"},
      {"commas and blanks", "1.5, 2.25, -3\n4.5 , 5 , 6\n"},
      {"separators at the ends", "x,y,z,\n1.5,2.25,-3,\n4.5,5,6,\n"},
      {"semicolons at the ends", "1.5;2.25;-3;\n4.5;5;6;\n"},
      {"semicolons behind commas", "1.5,2.25,-3;\n4.5,5,6;\n"},
      {"line ends of old", "x,y,z\r1.5,2.25,-3\r4.5,5,6\r"},
      {"exponents", "1.5e0 0.225E+1 -3.0e+00\n45e-1 5 6\n"},
      {"count behind the header", "//X Y Z\n2\n1.5 2.25 -3\n4.5 5 6\n"},
      {"count before the header", "2\n//X Y Z\n1.5 2.25 -3\n4.5 5 6\n"},
      {"CloudCompare", "//X,Y,Z\n1.5,2.25,-3\n4.5,5,6\n"},
      {"X,Y,Depth", "X,Y,Depth\n1.5,2.25,-3\n4.5,5,6\n"},
      {"lon,lat,z", "lon,lat,z\n1.5,2.25,-3\n4.5,5,6\n"},
      {"lat before lon", "Latitude;Longitude;Altitude\n2.25;1.5;-3\n5;4.5;6\n"},
      {"northing first", "ID,Northing,Easting,Elevation\n1,2.25,1.5,-3\n2,5,4.5,6\n"},
      {"units", "X [m],Y [m],Z [m]\n1.5,2.25,-3\n4.5,5,6\n"},
      {"units behind blanks", "X (m) Y (m) Z (m)\n1.5 2.25 -3\n4.5 5 6\n"},
      {"units in names", "x_m;y_m;z_m\n1.5;2.25;-3\n4.5;5;6\n"},
      {"a header as comment", "# time z y x\n7 -3 2.25 1.5\n8 6 5 4.5\n"},
      {"comments of other kinds",
       "// made by hand\n// x y z\n% a comment\n! another\n1.5 2.25 -3\n4.5 5 6\n"},
      {"a line of units", "x;y;z\n[m];[m];[m]\n1.5;2.25;-3\n4.5;5;6\n"},
      {"a line of plain units", "lon,lat,height\ndeg,deg,m\n1.5,2.25,-3\n4.5,5,6\n"},
      {"a title", "harbour, depth below datum in metres\n1.5 2.25 -3\n4.5 5 6\n"},
      {"an index without a name", ",x,y,z\n0,1.5,2.25,-3\n1,4.5,5,6\n"},
      {"a height beside z", "height,x,y,z\n0,1.5,2.25,-3\n1,4.5,5,6\n"}};
  for (const auto& [name, content] : files) {
    SCOPED_TRACE(name);
    const Cloud cloud = readCloud(makeFile("a.txt", content));
    ASSERT_EQ(cloud.points->size(), 2u);
    EXPECT_EQ((*cloud.points)[0].getVector3fMap(), Eigen::Vector3f(1.5f, 2.25f, -3));
    EXPECT_EQ((*cloud.points)[1].getVector3fMap(), Eigen::Vector3f(4.5f, 5, 6));
    EXPECT_TRUE(cloud.labels.empty());
  }
}

TEST_F(CloudFile, TextColumnsKeepTheirNames) {
  const auto namesIn = [&](const std::string& content) {
    return fieldNames(readCloud(makeFile("a.txt", content)));
  };
  EXPECT_EQ(namesIn("Easting,Northing,Elevation,Intensity\n1,2,3,0\n4,5,6,37\n"),
            (Names{"x", "y", "z", "Intensity"}));
  EXPECT_EQ(namesIn("//X Y Z R G B\n1 2 3 4 5 6\n"), (Names{"x", "y", "z", "R", "G", "B"}));
  EXPECT_EQ(namesIn("x,y,z,\"GPS Time\"\n1,2,3,4\n"), (Names{"x", "y", "z", "GPS_Time"}));
  EXPECT_EQ(namesIn("1 2 3 0 2 3\n4 5 6 1 2 3\n"), (Names{"x", "y", "z", "field4", "field5", "field6"}));
  EXPECT_EQ(namesIn("1 2 3 rock\n4 5 6 sand\n"), (Names{"x", "y", "z"}));
  const Cloud timed = readCloud(makeFile("a.txt", "time x y z\n1600000000.25 1 2 3\n1600000000.5 4 5 6\n"));
  EXPECT_EQ(fieldNumbers(timed.fields, *findField(timed.fields, "time")),
            (std::vector<double>{1600000000.25, 1600000000.5}));
}

TEST_F(CloudFile, AFourthColumnIsALabelOnlyIfItIsOne) {
  const auto read = [&](const std::string& content) { return readCloud(makeFile("a.txt", content)); };
  EXPECT_EQ(read("1 2 3 0\n4 5 6 1\n7 8 9 2\n").labels, (std::vector<int>{0, 1, 2}));
  for (const char* content : {"1 2 3 0\n4 5 6 37\n", "1 2 3 0\n4 5 6 0.5\n", "1 2 3 0\n4 5 6 -1\n",
                              "x,y,z,Intensity\n1,2,3,0\n4,5,6,1\n", "1 2 3 0 9\n4 5 6 1 9\n"}) {
    SCOPED_TRACE(content);
    const Cloud cloud = read(content);
    EXPECT_TRUE(cloud.labels.empty());
    EXPECT_EQ(cloud.label_fault, "");
    EXPECT_EQ(cloud.fields.fields.size(),
              content[0] == '1' && std::string(content).find('9') != std::string::npos ? 5u : 4u);
  }
  EXPECT_EQ(read("X,Y,Z,Class\n1,2,3,0\n4,5,6,1\n").labels, (std::vector<int>{0, 1}));
  const Cloud words = read("X,Y,Z,Class\n1,2,3,sand\n4,5,6,rock\n");
  EXPECT_TRUE(words.labels.empty());
  // Classes 1 and 2 of another name are those of LAS, or ours: nobody knows.
  EXPECT_NE(read("X,Y,Z,Classification\n1,2,3,2\n4,5,6,1\n").label_fault.find("1, 2"), std::string::npos);
}

TEST_F(CloudFile, OtherLabelsNeedAWordOnWhatTheyMean) {
  const std::string path =
      makeFile("a.txt", "x y z label\n1 2 3 40\n1 2 3 44\n1 2 3 50\n1 2 3 0\n1 2 3 nan\n");
  const Cloud unknown = readCloud(path);
  EXPECT_TRUE(unknown.labels.empty());
  EXPECT_NE(unknown.label_fault.find("its labels are 0, 40, 44, 50: no scores"), std::string::npos)
      << unknown.label_fault;
  ReadOptions options;
  options.ground_classes = {40, 44};
  EXPECT_EQ(readCloud(path, options).labels, (std::vector<int>{0, 0, 1, 1, 2}));
  options.ignored_classes = std::vector<int>{0, 1};
  EXPECT_EQ(readCloud(path, options).labels, (std::vector<int>{0, 0, 1, 2, 2}));
  options.ground_classes = {7};
  EXPECT_TRUE(readCloud(path, options).labels.empty());
  EXPECT_NE(readCloud(path, options).label_fault.find("none of its labels, 0, 40, 44, 50,"),
            std::string::npos);
  EXPECT_NE(readCloud(makeFile("b.txt", "1 2 3\n"), options).label_fault.find("has no labels"),
            std::string::npos);
}

TEST_F(CloudFile, DecimalCommasPartedByCommasAreRefused) {
  expectError("a.csv", "5,118,1,153,0,200\n9,505,8,786,0,309\n1,442,2,993,0,048\n", "decimal commas");
  expectError("b.csv", "5,1,1,15,0,2\n9,5,8,78,0,05\n", "decimal commas");
  const Cloud colours = readCloud(makeFile("c.csv", "5,118,1,153,0,200\n9,55,8,78,0,39\n1,2,2,93,0,148\n"));
  EXPECT_EQ(colours.points->size(), 3u);
}

TEST_F(CloudFile, DegreesAndUnknownColumnsAreToldOf) {
  const auto remarkOf = [&](const std::string& content) {
    const std::vector<std::string> remarks = readCloud(makeFile("a.csv", content)).remarks;
    return remarks.size() == 1 ? remarks.front() : std::to_string(remarks.size()) + " remarks";
  };
  EXPECT_NE(remarkOf("lon,lat,z\n1,2,3\n").find("degrees"), std::string::npos);
  EXPECT_NE(remarkOf("a,b,c\n1,2,3\n").find("'a, b, c'"), std::string::npos);
  EXPECT_EQ(remarkOf("x,y,z\n1,2,3\n"), "0 remarks");
}

TEST_F(CloudFile, OtherFormatsAreNamedWithAWayOut) {
  using namespace std::string_literals;
  expectError("a.pcd.gz", "\x1f\x8b\x08\x00"s, "gunzip");
  expectError("a.bz2", "BZh91AY", "bunzip2");
  expectError("a.zip", "PK\x03\x04", "zip");
  expectError("a.e57", "ASTM-E57 and more", "E57");
  expectError("a.txt", "\xff\xfe" + "1\0 \0002\0 \0003\0\n\0"s, "UTF-16");
  expectError("b.txt", "1\0 \0002\0 \0003\0\n\0"s, "iconv");
  expectError("c.txt", "\0001\0 \0002\0 \0003\0\n"s, "UTF-16");
  expectError("a.obj", "# made by hand\nv 1 2 3\nv 4 5 6\nf 1 2 1\n", "OBJ");
  expectError("obj.txt", "mtllib a.mtl\no thing\nv 1 2 3\n", "OBJ");
  const std::string ptx =
      "2\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 2 3 0.5\n4 5 6 0.5\n";
  expectError("a.ptx", ptx, "PTX");
  expectError("ptx.txt", ptx, "PTX");
  expectError("a.asc", "ncols 2\nnrows 1\n1 2\n", "gdal_translate");
  expectError("a.npy", "\x93NUMPY\x01\x00"s, "NumPy");
}

/// Points of so many float32 each.
std::string floats(std::size_t points, std::size_t values, float last_step) {
  std::string bytes;
  for (std::size_t n = 0; n < points; ++n)
    for (std::size_t i = 0; i < values; ++i) {
      const auto step = static_cast<float>(n);
      const float value = i < 4 ? 0.5f * step - static_cast<float>(i) : last_step * step;
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  return bytes;
}

TEST_F(CloudFile, PointsOfKittiAndNuScenesAreToldApart) {
  const auto namesIn = [&](const std::string& content, std::optional<CloudFormat> format = std::nullopt) {
    return fieldNames(readCloud(makeFile("a.bin", content), {format, {}, {}}));
  };
  const Names kitti{"x", "y", "z", "intensity"}, nuscenes{"x", "y", "z", "intensity", "ring"};
  EXPECT_EQ(namesIn(floats(7, 4, 0)), kitti);
  EXPECT_EQ(namesIn(floats(7, 5, 1)), nuscenes);
  EXPECT_EQ(namesIn(floats(20, 4, 0)), kitti);     // 320 bytes, which fit both
  EXPECT_EQ(namesIn(floats(16, 5, 1)), nuscenes);  // these, too
  EXPECT_EQ(namesIn(floats(16, 5, 0.3f)), kitti);  // by what the fifth values are
  EXPECT_EQ(namesIn(floats(16, 5, 0.3f), CloudFormat::NUSCENES), nuscenes);
  const Cloud cloud = readCloud(makeFile("b.bin", floats(7, 5, 1)));
  EXPECT_EQ((*cloud.points)[6].getVector3fMap(), Eigen::Vector3f(3, 2, 1));
  EXPECT_EQ(floatsOf(cloud.fields, "ring")[6], 6.0f);
  EXPECT_TRUE(cloud.labels.empty());
  expectError("c.bin", floats(7, 4, 0) + "abc", "115 bytes");
  expectError("d.bin", std::string(160, '\x7e'), "no float32 coordinates");
  EXPECT_THROW(readCloud(makeFile("e.bin", floats(7, 4, 0)), {CloudFormat::NUSCENES, {}, {}}), WorkError);
}

TEST_F(CloudFile, AFormatCanBeNamed) {
  const std::string text = makeFile("a.pcd", "1 2 3\n4 5 6\n");
  EXPECT_THROW(readCloud(text), WorkError);
  EXPECT_EQ(readCloud(text, {CloudFormat::TEXT, {}, {}}).points->size(), 2u);
  EXPECT_THROW(readCloud(text, {CloudFormat::LAS, {}, {}}), WorkError);
}

TEST_F(CloudFile, FieldsOfCountZeroAreLeftOut) {
  const std::string header =
      "FIELDS x y z intensity _ rgb\nSIZE 4 4 4 4 1 4\nTYPE F F F F U F\nCOUNT 1 1 1 1 0 0\n";
  const Cloud text = readCloud(makeFile("a.pcd", asciiPcd(header + extent("1", "1", "1"), "1 2 3 4\n")));
  EXPECT_EQ(fieldNames(text), (Names{"x", "y", "z", "intensity"}));
  ASSERT_EQ(text.remarks.size(), 1u);
  EXPECT_NE(text.remarks.front().find("'rgb'"), std::string::npos);
  const Cloud binary =
      readCloud(makeFile("b.pcd", header + extent("1", "1", "1") + "DATA BINARY\n" + floats(1, 4, 0)));
  EXPECT_EQ((*binary.points)[0].getVector3fMap(), Eigen::Vector3f(0, -1, -2));
}

TEST_F(CloudFile, CapitalsAreNoHindrance) {
  EXPECT_EQ(
      readCloud(makeFile("A.PCD", xyz_header + extent("1", "1", "1") + "DATA ASCII\n1 2 3\n")).points->size(),
      1u);
  const Cloud ply =
      readCloud(makeFile("a.ply",
                         "ply\nformat ascii 1.0\nelement vertex 1\nproperty double X\nproperty float Y\n"
                         "property int Z\nproperty uchar scalar_Classification\nend_header\n1 2 3 0\n"));
  EXPECT_EQ((*ply.points)[0].getVector3fMap(), Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(fieldNames(ply), (Names{"x", "y", "z", "scalar_Classification"}));
  EXPECT_EQ(ply.labels, std::vector<int>{0});
  EXPECT_TRUE(hasCloudName("a/SUBMAP_03.PCD"));
  EXPECT_TRUE(hasCloudName("a.Las"));
  EXPECT_FALSE(hasCloudName("a.pcd/readme.txt"));
}

TEST_F(CloudFile, AViewpointWithoutRotationIsNoPose) {
  const auto read = [&](const std::string& viewpoint) {
    return readCloud(makeFile("a.pcd", asciiPcd(xyz_header + viewpoint + extent("1", "1", "1"), "1 2 3\n")));
  };
  EXPECT_NE(read("VIEWPOINT 1 2 3 0 0 0 0\n").pose_fault.find("quaternion of zeros"), std::string::npos);
  EXPECT_EQ(read("VIEWPOINT 1 2 3 1 0 0 0\n").pose_fault, "");
  EXPECT_EQ(read("").pose_fault, "");
}

}  // namespace
}  // namespace pcl_fft_ground::cli
