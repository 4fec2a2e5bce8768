// LAZ: unpacked and packed as the same bytes, refused where it is damaged, and written with other classes.
// Where the program is built without LASzip there is nothing but the refusal.

#include <cmath>
#include <cstdlib>

#include "cloud_file_fixture.h"
#include "las_bytes.h"
#include "segment_fixture.h"

namespace pcl_fft_ground::cli {
namespace {

#define SKIP_WITHOUT_LASZIP() \
  if (!isBuiltWithLaszip()) GTEST_SKIP() << "built without LASzip"

/// Points whose classes and heights vary, so that there is something to compress.
std::vector<LasPoint> manyPoints(std::int32_t count) {
  std::vector<LasPoint> points;
  for (std::int32_t n = 0; n < count; ++n)
    points.push_back(
        {{n % 97, n / 97 - 1000, (n * n) % 1013}, static_cast<std::uint8_t>(n % 19), n % 7 == 0});
  return points;
}

/// With an extended record behind its points.
std::string withExtendedRecord(std::string las, const std::string& user) {
  const std::string data = "something longer than nothing";
  std::string record(60, '\0');
  record.replace(2, user.size(), user);
  putAt(record, 18, std::uint16_t{1000});
  putAt(record, 20, std::uint64_t{data.size()});
  if (numberAt<std::uint32_t>(las, 243) == 0) putAt(las, 235, std::uint64_t{las.size()});
  putAt(las, 243, numberAt<std::uint32_t>(las, 243) + 1);
  return las + record + data;
}

TEST_F(CloudFile, LazIsRefusedWithAWayOutWhereItCannotBeRead) {
  if (isBuiltWithLaszip()) GTEST_SKIP() << "built with LASzip";
  std::string bytes = lasFile(2, 3);
  bytes[104] = '\x83';
  expectError("a.laz", bytes, "built without LASzip: convert it by");
}

TEST_F(CloudFile, LazUnpacksToTheBytesThatWerePacked) {
  SKIP_WITHOUT_LASZIP();
  for (std::uint8_t format = 0; format <= 10; ++format)
    for (const unsigned minor : format >= 6 ? std::vector<unsigned>{4} : std::vector<unsigned>{0, 2, 3, 4}) {
      SCOPED_TRACE(std::to_string(format) + " of 1." + std::to_string(minor));
      std::string las = lasFile(minor, format, manyPoints(3000));
      if (minor == 4) las = withExtendedRecord(las, "somebody");
      const std::string laz = packedLas(las);
      EXPECT_LT(laz.size(), las.size() / 2);
      EXPECT_EQ(static_cast<std::uint8_t>(laz[104]), 0x80U | format);
      EXPECT_EQ(unpackedLas(laz), las);
    }
}

TEST_F(CloudFile, LazIsReadAsTheSameLas) {
  SKIP_WITHOUT_LASZIP();
  const std::string las = lasFile(4, 7, manyPoints(500));
  const Cloud unpacked = readCloud(makeFile("a.las", las)),
              cloud = readCloud(makeFile("a.laz", packedLas(las)));
  EXPECT_EQ(cloud.format, CloudFormat::LAS);
  EXPECT_TRUE(cloud.is_compressed);
  EXPECT_EQ(cloud.fields.data, unpacked.fields.data);
  EXPECT_EQ(cloud.labels, unpacked.labels);
  EXPECT_EQ(cloud.origin, unpacked.origin);
}

TEST_F(CloudFile, WhatTellsOfTheCompressionIsNoPartOfTheUnpackedFile) {
  SKIP_WITHOUT_LASZIP();
  const std::string plain = lasFile(4, 6, manyPoints(100));
  const std::string kept = withExtendedRecord(plain, "somebody");
  // A cloud-optimised file has the order of its chunks in a record of its own.
  std::string laz = packedLas(kept);
  EXPECT_EQ(unpackedLas(withExtendedRecord(laz, "copc")), kept);
  EXPECT_EQ(unpackedLas(withExtendedRecord(packedLas(plain), "copc")), plain);
}

TEST_F(CloudFile, DamagedLazEndsInOneLine) {
  SKIP_WITHOUT_LASZIP();
  for (const unsigned minor : {2U, 4U}) {
    std::string las = lasFile(minor, minor == 4 ? 7 : 3, manyPoints(2000));
    if (minor == 4) las = withExtendedRecord(las, "somebody");
    const std::string whole = packedLas(las);
    for (std::size_t n = 0; n < 64; ++n) {
      const std::size_t length = std::max<std::size_t>(4, whole.size() * n / 64);
      SCOPED_TRACE(length);
      expectError("a.laz", std::string_view(whole).substr(0, length), "is truncated");
    }
    for (std::size_t cut = 1; cut < 24; ++cut)  // within the table of the chunks, or the record behind it
      expectError("a.laz", std::string_view(whole).substr(0, whole.size() - cut), "is truncated");
    const auto expectDamaged = [&](std::size_t place, auto number) {
      SCOPED_TRACE(place);
      std::string bytes = whole;
      putAt(bytes, place, number);
      EXPECT_FALSE(errorOf(makeFile("b.laz", bytes)).empty());
    };
    for (const std::uint32_t offset : {0U, 226U, 4294967295U}) expectDamaged(96, offset);
    for (const std::uint16_t length : {0, 1, 65535}) expectDamaged(105, length);
    if (minor == 2)
      for (const std::uint32_t count : {2001U, 60000U, 4294967295U}) expectDamaged(107, count);
    if (minor == 4)
      for (const std::uint64_t count : {std::uint64_t{2001}, std::uint64_t{1} << 40U, ~std::uint64_t{0}})
        expectDamaged(247, count);
    for (const std::uint32_t count : {0U, 1U})
      expectDamaged(100, count);  // LASzip's record is not among them
    expectDamaged(numberAt<std::uint32_t>(whole, 96), std::int64_t{1} << 60);
  }
}

using LazSegmentation = SegmentCommand;

TEST_F(LazSegmentation, WritesTheFileWithOtherClassesCompressed) {
  SKIP_WITHOUT_LASZIP();
  std::vector<LasPoint> points;
  for (std::int32_t i = 0; i < 100; ++i)
    for (std::int32_t j = 0; j < 100; ++j)
      points.push_back(
          {{10 * i, 10 * j, i >= 40 && i < 55 && j >= 60 && j < 75 ? 1000 : (i * 7 + j * 3) % 10}, 1});
  const std::string las = withExtendedRecord(lasFile(4, 6, points), "somebody");
  run(runSegment, {makeFile("box.las", las), "-o", output(), "--max-object-size", "3"});
  const std::string expected = contentOf(outputOf("labelled.las"));
  const std::string laz = makeFile("box.laz", packedLas(las));
  run(runSegment, {laz, "-o", output(), "--max-object-size", "3"});
  EXPECT_NE(expected, las);
  EXPECT_EQ(unpackedLas(contentOf(outputOf("labelled.laz"))), expected);
  EXPECT_THROW(run(runSegment, {laz, "-o", output(), "--tile", "5"}), WorkError);
}

/// What the header of a LAS file says of its points, written there by the program that made the file.
TEST_F(CloudFile, KnownLazFilesHaveThePointsThatTheirHeadersTellOf) {
  const char* const data = std::getenv("PCL_FFT_GROUND_DATA");
  if (data == nullptr) GTEST_SKIP() << "PCL_FFT_GROUND_DATA names no folder of real scans";
  SKIP_WITHOUT_LASZIP();
  const std::string folder = std::string(data) + "/las/";
  for (const auto& [name, count] :
       {std::pair{"simple.laz", 1065U}, {"las14_pdrf6.laz", 135U}, {"example.copc.laz", 30U}}) {
    SCOPED_TRACE(name);
    const std::string content = contentOf(folder + name);
    const Cloud cloud = readCloud(folder + name);
    ASSERT_EQ(cloud.points->size(), count);
    Eigen::AlignedBox3d bounds;
    for (const auto& point : *cloud.points)
      bounds.extend(point.getVector3fMap().cast<double>() + cloud.origin);
    std::vector<std::uint64_t> returns(16, 0);
    for (const float number : floatsOf(cloud.fields, "return_number"))
      ++returns[static_cast<std::size_t>(number)];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      EXPECT_NEAR(bounds.max()[i], numberAt<double>(content, 179 + 16 * axis), 1e-3);
      EXPECT_NEAR(bounds.min()[i], numberAt<double>(content, 187 + 16 * axis), 1e-3);
    }
    const bool is_new = content[25] == 4;
    for (std::size_t n = 1; n <= 5; ++n) {
      const std::uint64_t told = is_new ? numberAt<std::uint64_t>(content, 247 + 8 * n)
                                        : numberAt<std::uint32_t>(content, 107 + 4 * n);
      EXPECT_EQ(returns[n], told) << n;
    }
  }
  EXPECT_EQ(readCloud(folder + "simple.laz").fields.data, readCloud(folder + "simple.las").fields.data);
}

}  // namespace
}  // namespace pcl_fft_ground::cli
