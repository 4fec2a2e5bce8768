#include <pcl/conversions.h>
#include <pcl/io/ply_io.h>

#include <filesystem>
#include <map>
#include <random>

#include "cloud_file_fixture.h"
#include "command_fixture.h"
#include "commands/commands.h"
#include "las_bytes.h"

namespace pcl_fft_ground::cli {
namespace {

/// A valid small file of each kind, damaged in every way that a fixed seed gives.
class DamagedCloudFile : public CloudFile, public ::testing::WithParamInterface<std::string> {
 protected:
  void SetUp() override {
    CloudFile::SetUp();
    if (GetParam() == "points.laz" && !isBuiltWithLaszip()) GTEST_SKIP() << "built without LASzip";
  }

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
    if (GetParam() == "points.las") makeFile("valid", lasFile());
    if (GetParam() == "points.laz") makeFile("valid", packedLas(lasFile()));
    if (GetParam() == "floats.bin") makeFile("valid", std::string(80, '\0'));
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

/// What a number in a header may be made.
const std::vector<std::string> EXTREMES{
    "0",   "-1", "1", "4294967295", "4294967296", "9223372036854775807", "18446744073709551616", "1e300",
    "nan", "x",  ""};

TEST_P(DamagedCloudFile, NumbersOfTheHeaderAtTheirExtremes) {
  const std::string content = validFile();
  if (GetParam() == "points.las" || GetParam() == "points.laz") {
    for (std::size_t place = 24; place < 227; ++place)
      for (const std::size_t bytes : {1U, 2U, 4U, 8U})
        for (const char byte : {'\0', '\x7f', '\xff'}) {
          std::string changed = content;
          changed.replace(place, bytes, bytes, byte);
          readsOrRefuses(changed);
        }
    return;
  }
  const std::size_t end = std::min<std::size_t>(content.size(), 500);
  for (std::size_t begin = 0; begin < end; ++begin) {
    const auto isDigit = [&](std::size_t i) { return i < end && content[i] >= '0' && content[i] <= '9'; };
    if (!isDigit(begin) || (begin > 0 && isDigit(begin - 1))) continue;
    std::size_t count = 1;
    while (isDigit(begin + count)) ++count;
    for (const std::string& number : EXTREMES) {
      SCOPED_TRACE(std::to_string(begin) + ": " + number);
      std::string changed = content;
      readsOrRefuses(changed.replace(begin, count, number));
    }
  }
}

TEST_P(DamagedCloudFile, NothingIsWrittenOfAFileCutAtAny32nd) {
  const std::string content = validFile();
  std::size_t refused = 0;
  for (std::size_t n = 0; n < 32; ++n) {
    SCOPED_TRACE(n);
    const std::string cut = content.substr(0, content.size() * n / 32);
    if (readsOrRefuses(cut)) continue;  // as text it is whole
    ++refused;
    const std::string path = makeFile(GetParam(), cut);
    EXPECT_THROW(run(runSegment, {path, "-o", pathOf("out"), "--max-object-size", "1"}), WorkError);
    EXPECT_FALSE(std::filesystem::exists(pathOf("out")));
  }
  // Text cut between two lines is whole, and so are floats between two points; PLY has a camera behind its
  // points.
  const std::map<std::string, std::size_t> least{
      {"text.csv", 4}, {"floats.bin", 24}, {"ascii.ply", 28}, {"binary.ply", 28}};
  EXPECT_GE(refused, least.count(GetParam()) != 0 ? least.at(GetParam()) : 31);
}

INSTANTIATE_TEST_SUITE_P(EveryKind, DamagedCloudFile,
                         ::testing::Values("ascii.pcd", "binary.pcd", "compressed.pcd", "ascii.ply",
                                           "binary.ply", "text.csv", "points.las", "points.laz",
                                           "floats.bin"),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           name[name.find('.')] = '_';
                           return name;
                         });

}  // namespace
}  // namespace pcl_fft_ground::cli
