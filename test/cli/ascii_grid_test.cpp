#include "io/raster_files.h"

#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>

#include "errors.h"
#include "temporary_folder.h"

namespace pcl_fft_ground::cli {
namespace {

using AsciiGrid = TemporaryFolder;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// What a program that knows the format makes of a file.
struct ReadBack {
  std::map<std::string, double> header;
  Eigen::ArrayXXd heights;  ///< (x, y), NaN where there is no data
};

ReadBack readBack(const std::string& content) {
  ReadBack grid;
  std::istringstream stream(content);
  for (int i = 0; i < 6; ++i) {
    std::string key;
    stream >> key;
    stream >> grid.header[key];
  }
  const auto columns = static_cast<Eigen::Index>(grid.header.at("ncols"));
  const auto rows = static_cast<Eigen::Index>(grid.header.at("nrows"));
  grid.heights.resize(columns, rows);
  for (Eigen::Index north = 0; north < rows; ++north) {
    for (Eigen::Index x = 0; x < columns; ++x) {
      double height = 0.0;
      stream >> height;
      grid.heights(x, rows - 1 - north) = height == grid.header.at("NODATA_value") ? nan : height;
    }
  }
  EXPECT_FALSE(stream.fail());
  std::string more;
  EXPECT_FALSE(stream >> more) << more;
  return grid;
}

TEST_F(AsciiGrid, IsWrittenFromNorthToSouth) {
  Eigen::ArrayXXd heights(3, 2);  // x along rows
  heights << 0.0, 1.0, 10.0, 11.0, 20.0, 21.0;
  writeAsciiGrid(pathOf("g.asc"), heights, {0.0, 0.0}, 1.0);
  EXPECT_EQ(contentOf(pathOf("g.asc")),
            "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n"
            "1.0000 11.0000 21.0000\n0.0000 10.0000 20.0000\n");
  EXPECT_EQ(names(), std::vector<std::string>{"g.asc"});
}

TEST_F(AsciiGrid, KeepsTenthsOfAMillimetreAndUtmCorners) {
  const Eigen::ArrayXXd heights = Eigen::ArrayXXd::Random(13, 7) * 4000.0;
  const Eigen::Vector2d corner(499999.98, 5412345.678901);
  writeAsciiGrid(pathOf("g.asc"), heights, corner, 0.02);
  const ReadBack grid = readBack(contentOf(pathOf("g.asc")));
  EXPECT_EQ(grid.header.at("xllcorner"), corner.x());
  EXPECT_EQ(grid.header.at("yllcorner"), corner.y());
  EXPECT_EQ(grid.header.at("cellsize"), 0.02);
  EXPECT_LE((grid.heights - heights).abs().maxCoeff(), 0.5001e-4);
}

TEST_F(AsciiGrid, WritesNoExponents) {
  writeAsciiGrid(pathOf("g.asc"), Eigen::ArrayXXd::Constant(1, 1, 3e7), {-4e6, 1e-7}, 1e-6);
  const std::string content = contentOf(pathOf("g.asc"));
  EXPECT_NE(content.find("xllcorner -4000000\n"), std::string::npos) << content;
  EXPECT_NE(content.find("yllcorner 0.0000001\n"), std::string::npos) << content;
  EXPECT_NE(content.find("cellsize 0.000001\n"), std::string::npos) << content;
  EXPECT_NE(content.find("\n30000000.0000\n"), std::string::npos) << content;
}

TEST_F(AsciiGrid, MarksWhatIsNotFiniteAndOnlyThat) {
  Eigen::ArrayXXd heights(2, 2);
  heights << nan, -9999.0, std::numeric_limits<double>::infinity(), 1.5;
  writeAsciiGrid(pathOf("g.asc"), heights, {0.0, 0.0}, 1.0);
  const ReadBack grid = readBack(contentOf(pathOf("g.asc")));
  EXPECT_TRUE(std::isnan(grid.heights(0, 0)));
  EXPECT_TRUE(std::isnan(grid.heights(1, 0)));
  EXPECT_NEAR(grid.heights(0, 1), -9999.0, 1.01e-4);
  EXPECT_EQ(grid.heights(1, 1), 1.5);
}

TEST_F(AsciiGrid, TakesTheLargestNumbers) {
  const double largest = std::numeric_limits<double>::max();
  writeAsciiGrid(pathOf("g.asc"), Eigen::ArrayXXd::Constant(1, 1, -largest), {largest, -largest},
                 std::numeric_limits<double>::denorm_min());
  const ReadBack grid = readBack(contentOf(pathOf("g.asc")));
  EXPECT_EQ(grid.header.at("xllcorner"), largest);
  EXPECT_EQ(grid.heights(0, 0), -largest);
}

TEST_F(AsciiGrid, RefusesWhatIsNoGrid) {
  const Eigen::ArrayXXd heights = Eigen::ArrayXXd::Zero(2, 2);
  const std::string path = pathOf("g.asc");
  EXPECT_THROW(writeAsciiGrid(path, Eigen::ArrayXXd(0, 3), {0.0, 0.0}, 1.0), std::invalid_argument);
  EXPECT_THROW(writeAsciiGrid(path, heights, {nan, 0.0}, 1.0), std::invalid_argument);
  for (const double cell : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(writeAsciiGrid(path, heights, {0.0, 0.0}, cell), std::invalid_argument) << cell;
  }
  EXPECT_THROW(writeAsciiGrid(pathOf("missing/g.asc"), heights, {0.0, 0.0}, 1.0), WorkError);
  EXPECT_TRUE(names().empty());
}

}  // namespace
}  // namespace pcl_fft_ground::cli
