// What the formats allow beyond what PCL writes, and what they do not.

#include <pcl/conversions.h>

#include <cmath>
#include <cstdio>

#include "cloud_file_fixture.h"

namespace pcl_fft_ground::cli {
namespace {

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
  EXPECT_EQ(floatsOf(counted.fields, "field4"), std::vector<float>{0.5f});
  EXPECT_EQ(floatsOf(counted.fields, "field6"), std::vector<float>{0});
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
  expectError("g.xyz", "x y z label\n1 2 3 0\n1 2 3 0.5\n", "the label a whole number");
  expectError("h.xyz", "1 2 1e999\n", "line 1 is malformed");
  expectError("i.xyz", "id x depth\n1 2 3\n", "'id, x, depth'");
  expectError("j.xyz", "1 2 0x3\n", "line 1 is malformed");
  expectError("k.xyz", "1 2 \x1b[31m\x07" + std::string(5000, 'a') + "\n",
              "line 1 is malformed: '1 2 \\x1b[31m\\x07aaa");
  expectError("l.xyz", "# nothing here\n\n", "holds no points");
  expectError("m.xyz", "x y z\n", "holds no points");
  expectError("n.xyz", std::string("1 2 3\n\0\n", 8), "neither PCD nor PLY nor LAS nor text");
}

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
    EXPECT_EQ(cloud.viewpoint.rotation.coeffs(), Eigen::Quaterniond::Identity().coeffs());
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
  expectError("e.pcd", header("4 4 4", "F F F", "1 1 0"), "is not 2 numbers");
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
  expectError("v.pcd", asciiPcd(xyz_header + "VIEWPOINT 0 -2e8 0 1 0 0 0\n" + one, "1 2 3\n"), "1e8 m");
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

}  // namespace
}  // namespace pcl_fft_ground::cli
