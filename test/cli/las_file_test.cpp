// LAS files: read, refused where they lie, and written with other classes.

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "cloud_file_fixture.h"
#include "io/cloud_stream.h"
#include "las_bytes.h"
#include "segment_fixture.h"

namespace pcl_fft_ground::cli {
namespace {

TEST_F(CloudFile, EveryPointFormatOfLasIsRead) {
  for (std::uint8_t format = 0; format <= 10; ++format) {
    SCOPED_TRACE(static_cast<int>(format));
    const bool is_new = format >= 6;
    for (const unsigned minor : is_new ? std::vector<unsigned>{4} : std::vector<unsigned>{0, 1, 2, 3, 4}) {
      const Cloud cloud = readCloud(makeFile("a.las", lasFile(minor, format)));
      EXPECT_EQ(cloud.format, CloudFormat::LAS);
      ASSERT_EQ(cloud.points->size(), 5u);
      EXPECT_EQ(cloud.origin, Eigen::Vector3d(500002, 5400000, 0));
      const Eigen::Vector3d second = (*cloud.points)[1].getVector3fMap().cast<double>() + cloud.origin;
      EXPECT_NEAR((second - Eigen::Vector3d(500001, 5399998, 100.05)).norm(), 0, 1e-5);
      EXPECT_TRUE(std::isnan((*cloud.points)[3].x));  // withheld
      EXPECT_EQ(floatsOf(cloud.fields, "x")[3], 1.0f);
      EXPECT_EQ(floatsOf(cloud.fields, "classification"), (std::vector<float>{2, 5, 1, 6, 2}));
      EXPECT_EQ(floatsOf(cloud.fields, "intensity").front(), 1234.0f);
      EXPECT_EQ(floatsOf(cloud.fields, "return_number").front(), 2.0f);
      EXPECT_EQ(floatsOf(cloud.fields, "number_of_returns").front(), is_new ? 3.0f : 2.0f);
      const bool has_time = format != 0 && format != 2;
      EXPECT_EQ(findField(cloud.fields, "gps_time") != nullptr, has_time);
      const bool has_colour =
          format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
      EXPECT_EQ(findField(cloud.fields, "green") != nullptr, has_colour);
      EXPECT_EQ(findField(cloud.fields, "nir") != nullptr, format == 8 || format == 10);
      EXPECT_EQ(cloud.labels, (std::vector<int>{0, 1, 2, 2, 0}));
      EXPECT_TRUE(cloud.remarks.empty());
    }
  }
}

/// Nothing is made ready for a header that is longer than the file.
TEST_F(CloudFile, LasPointsBehindTheEndOfTheFileAreNoStream) {
  std::string bytes = lasFile();
  putAt(bytes, 96, std::uint32_t{0xFFFFFFF0});
  try {
    CloudStream(makeFile("a.las", bytes), {});
    ADD_FAILURE() << "not refused";
  } catch (const WorkError& error) {
    EXPECT_NE(std::string(error.what()).find("truncated"), std::string::npos) << error.what();
  }
}

TEST_F(CloudFile, LasClassesAreTruth) {
  const std::string path = makeFile("a.las", lasFile(4, 6,
                                                     {{{0, 0, 0}, 0},
                                                      {{0, 0, 0}, 1},
                                                      {{0, 0, 0}, 2},
                                                      {{0, 0, 0}, 7},
                                                      {{0, 0, 0}, 12},
                                                      {{0, 0, 0}, 18},
                                                      {{0, 0, 0}, 5},
                                                      {{0, 0, 0}, 200}}));
  EXPECT_EQ(readCloud(path).labels, (std::vector<int>{2, 2, 0, 2, 2, 2, 1, 1}));
  ReadOptions options;
  options.ground_classes = {2, 7};
  EXPECT_EQ(readCloud(path, options).labels, (std::vector<int>{2, 2, 0, 0, 2, 2, 1, 1}));
  options.ignored_classes = std::vector<int>{5};
  EXPECT_EQ(readCloud(path, options).labels, (std::vector<int>{1, 1, 0, 0, 1, 1, 2, 1}));
}

/// A LAS file with one record in front of its points.
std::string withRecord(std::string file, std::uint16_t id, const std::string& data) {
  const auto put = [](std::string& bytes, std::size_t at, auto number) {
    std::memcpy(bytes.data() + at, &number, sizeof number);
  };
  std::string record(54, '\0');
  const std::string user = "LASF_Projection";
  std::copy(user.begin(), user.end(), record.begin() + 2);
  put(record, 18, id);
  put(record, 20, static_cast<std::uint16_t>(data.size()));
  record += data;
  std::uint16_t header_bytes = 0;
  std::uint32_t points_begin = 0;
  std::memcpy(&header_bytes, file.data() + 94, sizeof header_bytes);
  std::memcpy(&points_begin, file.data() + 96, sizeof points_begin);
  put(file, 96, points_begin + static_cast<std::uint32_t>(record.size()));
  put(file, 100, std::uint32_t{1});
  return file.insert(header_bytes, record);
}

TEST_F(CloudFile, LasOfAGeographicSystemIsRemarkedOn) {
  constexpr std::uint16_t WKT = 2112, GEO_KEYS = 34735;
  const std::string file = lasFile(0, 2, {{{0, 0, 0}, 1}, {{1, 1, 0}, 2}});
  const auto keys = [](std::uint16_t key, std::uint16_t code) {
    const std::array<std::uint16_t, 8> numbers{1, 1, 0, 1, key, 0, 1, code};
    return std::string(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
  };
  const auto isRemarkedOn = [&](std::uint16_t id, const std::string& data) {
    const Cloud cloud = readCloud(makeFile("a.las", withRecord(file, id, data)));
    EXPECT_EQ(cloud.points->size(), 2U);
    return cloud.remarks.size() == 1 && cloud.remarks[0].find("degrees") != std::string::npos;
  };
  const std::string degrees =
      R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]]])";
  EXPECT_TRUE(isRemarkedOn(GEO_KEYS, keys(2048, 4326)));
  EXPECT_FALSE(isRemarkedOn(GEO_KEYS, keys(3072, 32633)));
  EXPECT_TRUE(isRemarkedOn(WKT, degrees));
  EXPECT_TRUE(isRemarkedOn(WKT, "COMPD_CS[\"a\"," + degrees + ",VERT_CS[\"b\"]]"));
  EXPECT_FALSE(isRemarkedOn(WKT, "PROJCS[\"c\"," + degrees + ",PROJECTION[\"Transverse_Mercator\"]]"));
  EXPECT_FALSE(isRemarkedOn(WKT, "nonsense"));
}

TEST_F(CloudFile, LasTruncatedAnywhereIsRefused) {
  for (const unsigned minor : {2U, 4U}) {
    const std::string whole = lasFile(minor, minor == 4 ? 7 : 3);
    for (std::size_t length = 4; length < whole.size(); ++length) {
      SCOPED_TRACE(length);
      expectError("a.las", std::string_view(whole).substr(0, length), "is truncated");
    }
  }
}

TEST_F(CloudFile, LasHeadersThatLieAreRefusedOrMended) {
  const auto changed = [](unsigned minor, std::uint8_t format, std::size_t place, auto number) {
    std::string bytes = lasFile(minor, format);
    putAt(bytes, place, number);
    return bytes;
  };
  expectError("a.las", changed(2, 3, 24, std::uint8_t{2}), "version 2.2");
  expectError("b.las", changed(2, 3, 25, std::uint8_t{5}), "version 1.5");
  expectError("c.las", changed(2, 3, 104, std::uint8_t{11}), "format 11");
  for (const std::uint16_t length : {0, 1, 33})
    expectError("e.las", changed(2, 3, 105, length), "too short for point format 3");
  expectError("f.las", changed(2, 3, 105, std::uint16_t{65535}), "truncated");
  for (const std::uint32_t offset : {0U, 1U, 226U}) expectError("g.las", changed(2, 3, 96, offset), "header");
  for (const std::uint32_t offset : {300U, 5000U, 4294967295U})
    expectError("h.las", changed(2, 3, 96, offset), "truncated");
  for (const std::uint32_t count : {6U, 4294967295U})
    expectError("i.las", changed(2, 3, 107, count), "truncated");
  for (const std::uint64_t count : {std::uint64_t{6}, std::uint64_t{1} << 40U, ~std::uint64_t{0}})
    expectError("j.las", changed(4, 6, 247, count), "truncated");
  expectError("k.las", changed(2, 3, 107, std::uint32_t{0}), "holds no points");
  for (const double number : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    expectError("l.las", changed(2, 3, 131, number), "scale");
    expectError("m.las", changed(2, 3, 171, number), "offset");
  }
  expectError("n.las", changed(2, 3, 139, 0.0), "scale");
  expectError("o.las", "1 2 3\n4 5 6\n", "no LAS file");
  // Wrong, but the points are there: the number of records in front of them, sums, bounds.
  for (const std::size_t place : {100U, 111U, 179U}) {
    const Cloud cloud = readCloud(makeFile("p.las", changed(2, 3, place, std::uint32_t{0xFFFFFFFF})));
    EXPECT_EQ(cloud.points->size(), 5u);
  }
  const Cloud fewer = readCloud(makeFile("q.las", changed(2, 3, 107, std::uint32_t{2})));
  EXPECT_EQ(fewer.points->size(), 2u);
  ASSERT_EQ(fewer.remarks.size(), 1u);
  EXPECT_NE(fewer.remarks.front().find("room for 5"), std::string::npos);
  // The old count of version 1.4 is 0 or the same.
  EXPECT_EQ(readCloud(makeFile("r.las", changed(4, 3, 107, std::uint32_t{0}))).points->size(), 5u);
  EXPECT_EQ(readCloud(makeFile("s.las", changed(4, 3, 247, std::uint64_t{0}))).points->size(), 5u);
}

/// The bytes at which two files differ.
std::vector<std::size_t> differences(const std::string& a, const std::string& b) {
  EXPECT_EQ(a.size(), b.size());
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (a[i] != b[i]) places.push_back(i);
  return places;
}

TEST_F(CloudFile, OnlyTheClassesOfALasFileChange) {
  const std::string old_format = lasFile(2, 1), new_format = lasFile(4, 10) + "an EVLR";
  const std::string changed = reclassifiedLas(old_format, {2, 7, -1, -1, 31});
  const std::size_t begin = 227 + 57 + 15;
  EXPECT_EQ(differences(old_format, changed), (std::vector<std::size_t>{begin + 30, begin + 4 * 30}));
  EXPECT_EQ(static_cast<unsigned char>(changed[begin + 30]), 0x27U);  // the key point flag is kept
  const std::string also = reclassifiedLas(new_format, {1, -1, 255, -1, 2});
  EXPECT_EQ(differences(new_format, also), (std::vector<std::size_t>{375 + 57 + 16, 375 + 57 + 16 + 2 * 69}));
  EXPECT_THROW(reclassifiedLas(old_format, {2, 7, -1, -1}), WorkError);
  EXPECT_THROW(reclassifiedLas(old_format, {32, 7, -1, -1, 2}), WorkError);
}

/// A box on level ground with a point far below and one withheld, in LAS.
std::string boxLas(std::size_t& withheld, std::size_t& below) {
  std::vector<LasPoint> points;
  for (std::int32_t i = 0; i < 100; ++i)
    for (std::int32_t j = 0; j < 100; ++j) {
      const bool is_box = i >= 40 && i < 55 && j >= 60 && j < 75;
      points.push_back({{10 * i, 10 * j, (i * 7 + j * 3) % 10 + (is_box ? 1000 : 0)}, 1});
    }
  below = 1234;
  points[below].xyz[2] = -3000;
  withheld = 4321;
  points[withheld] = {{0, 0, 900000}, 9, true};
  return lasFile(2, 1, points);
}

using LasSegmentation = SegmentCommand;

TEST_F(LasSegmentation, WritesTheFileWithOtherClasses) {
  std::size_t withheld = 0, below = 0;
  const std::string input = makeFile("box.las", boxLas(withheld, below));
  run(runSegment, {input, "-o", output(), "--max-object-size", "3"});
  const std::string before = contentOf(input), after = contentOf(outputOf("labelled.las"));
  const std::vector<std::size_t> places = differences(before, after);
  const std::size_t begin = 227 + 57, length = 30;
  for (const std::size_t place : places) EXPECT_EQ((place - begin) % length, 15u);
  const std::vector<double> label = labels();
  const auto classOf = [&](std::size_t n) { return after[begin + n * length + 15] & 0x1F; };
  for (std::size_t n = 0; n < label.size(); ++n) {
    if (n == withheld || n == below) continue;
    EXPECT_EQ(classOf(n), label[n] == 0 ? 2 : 1) << n;
  }
  EXPECT_EQ(label[withheld], 2);
  EXPECT_EQ(classOf(withheld), 9);
  EXPECT_EQ(classOf(below), 7);
  EXPECT_EQ(std::count(label.begin(), label.end(), 1), 15 * 15 + 1);
  run(runSegment, {input, "-o", output(), "--max-object-size", "3", "--classes", "3,4,5"});
  const std::string others = contentOf(outputOf("labelled.las"));
  EXPECT_EQ(others[begin + 15] & 0x1F, 3);
  EXPECT_EQ(others[begin + below * length + 15] & 0x1F, 5);
}

TEST_F(LasSegmentation, RefusesClassesThatNoneIs) {
  const std::string las = makeFile("a.las", lasFile()), scan = makeScan();
  for (const char* classes : {"2", "2,1", "2,1,7,8", "2,1,256", "-1,1,7", "a,b,c", ""})
    EXPECT_THROW(run(runSegment, {las, "-o", output(), "--classes", classes}), UsageError) << classes;
  EXPECT_THROW(run(runSegment, {scan, "-o", output(), "--classes", "2,1,7"}), UsageError);
  EXPECT_FALSE(hasOutput());
}

/// A file of PDAL's or lasR's, and what an independent count of it gave.
struct KnownLas {
  const char* name;
  std::size_t points;
  double low_x, high_x, low_z, high_z;
  std::size_t of_class_2;
};

TEST_F(CloudFile, KnownLasFilesAreReadAsCounted) {
  const char* const data = std::getenv("PCL_FFT_GROUND_DATA");
  if (data == nullptr) GTEST_SKIP() << "PCL_FFT_GROUND_DATA names no folder of real scans";
  const std::string folder = std::string(data) + "/las/";
  const std::vector<KnownLas> files{{"1.0_0.las", 1, 470692.44, 470692.44, 16, 16, 1},
                                    {"1.0_1.las", 1, 470692.44, 470692.44, 16, 16, 1},
                                    {"1.1_0.las", 1, 470692.44, 470692.44, 16, 16, 1},
                                    {"1.1_1.las", 1, 470692.44, 470692.44, 16, 16, 1},
                                    {"1.2_0.las", 1, 470692.44, 470692.44, 16, 16, 1},
                                    {"1.2_1.las", 1, 470692.44, 470692.44, 16, 16, 1},
                                    {"1.2_2.las", 1, 470692.44, 470692.44, 16, 16, 1},
                                    {"1.2_3.las", 1, 470692.44, 470692.44, 16, 16, 1},
                                    {"1.2-with-color.las", 1065, 635619.85, 638982.55, 406.59, 586.38, 276},
                                    {"100-points.las", 100, 635717.85, 638944.95, 409.19, 530.61, 27},
                                    {"Topography.las", 73403, 273357.145, 273642.856, 788.993, 829.758, 8159},
                                    {"bad-geotiff-keys.las", 10, 289814.15, 289818.5, 170.58, 170.76, 10},
                                    {"bad_vlr_count.las", 10, 289814.15, 289818.5, 170.58, 170.76, 10},
                                    {"extra_byte.las", 62, 286299.189, 286318.741, 20.124, 41.419, 0},
                                    {"extrabytes.las", 1065, 635619.85, 638982.55, 406.59, 586.38, 276},
                                    {"interesting.las", 1065, 635619.85, 638982.55, 406.59, 586.38, 276},
                                    {"prec3.las", 110, 636034.83, 637177.98, 407.32, 496.19, 17},
                                    {"simple.las", 1065, 635619.85, 638982.55, 406.59, 586.38, 276},
                                    {"test_epsg_4326.las", 10, -83.428, -83.428, 170.58, 170.76, 10},
                                    {"utm15.las", 1, 470692.44, 470692.44, 16, 16, 1}};
  for (const KnownLas& file : files) {
    SCOPED_TRACE(file.name);
    const Cloud cloud = readCloud(folder + file.name);
    ASSERT_EQ(cloud.points->size(), file.points);
    const auto boundsOf = [&](const char* name, double origin) {
      const std::vector<float> values = floatsOf(cloud.fields, name);
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      return std::pair{*low + origin, *high + origin};
    };
    const auto [low_x, high_x] = boundsOf("x", cloud.origin.x());
    const auto [low_z, high_z] = boundsOf("z", cloud.origin.z());
    const bool is_geographic = std::string(file.name) == "test_epsg_4326.las";
    EXPECT_EQ(std::count_if(cloud.remarks.begin(), cloud.remarks.end(),
                            [](const std::string& r) { return r.find("degrees") != std::string::npos; }),
              is_geographic ? 1 : 0);
    EXPECT_NEAR(low_x, file.low_x, 1e-3);
    EXPECT_NEAR(high_x, file.high_x, 1e-3);
    EXPECT_NEAR(low_z, file.low_z, 1e-3);
    EXPECT_NEAR(high_z, file.high_z, 1e-3);
    const std::vector<float> classes = floatsOf(cloud.fields, "classification");
    EXPECT_EQ(static_cast<std::size_t>(std::count(classes.begin(), classes.end(), 2.0f)), file.of_class_2);
    EXPECT_EQ(cloud.remarks.empty(), !is_geographic);
  }
  EXPECT_NE(errorOf(folder + "1.2-no-points.las").find("truncated"), std::string::npos);
  EXPECT_NE(errorOf(folder + "no-points.las").find("holds no points"), std::string::npos);
}

}  // namespace
}  // namespace pcl_fft_ground::cli
