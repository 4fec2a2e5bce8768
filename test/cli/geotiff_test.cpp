// ground_surface.tif, read back by GDAL; without it the options are refused.

#include <cstdio>

#include "errors.h"
#include "io/raster_files.h"
#include "las_bytes.h"
#include "segment_fixture.h"

#ifdef PCL_FFT_GROUND_WITH_GDAL
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#endif

namespace pcl_fft_ground::cli {
namespace {

using GeoTiff = SegmentCommand;

#ifdef PCL_FFT_GROUND_WITH_GDAL

struct Close {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};

/// A file as GDAL reads it; (i, j) as in GroundRaster.
struct ReadBack {
  explicit ReadBack(const std::string& path) {
    GDALAllRegister();
    dataset.reset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
    if (dataset == nullptr) throw WorkError(path + " is not opened by GDAL");
    dataset->GetGeoTransform(place.data());
  }
  Eigen::ArrayXXf band(int number) const {
    const int width = dataset->GetRasterXSize(), height = dataset->GetRasterYSize();
    Eigen::ArrayXXf values(width, height);
    EXPECT_EQ(dataset->GetRasterBand(number)->RasterIO(GF_Read, 0, 0, width, height, values.data(), width,
                                                       height, GDT_Float32, 0, 0, nullptr),
              CE_None);
    return values.rowwise().reverse();
  }

  std::unique_ptr<GDALDataset, Close> dataset;
  std::array<double, 6> place{};
};

TEST_F(GeoTiff, HoldsTheRasterAsItIs) {
  GroundRaster raster;
  raster.height = Eigen::ArrayXXd::Random(300, 7) + 100;
  raster.height(3, 2) = std::nan("");
  raster.uncertainty = Eigen::ArrayXXd::Constant(300, 7, 0.25);
  raster.supported = Eigen::ArrayXXd::Ones(300, 7);
  raster.supported(3, 2) = 0;
  raster.lower_left_corner = {500000.25, 5400000.5};
  raster.cell_size = 0.5;
  writeGeoTiff(pathOf("a.tif"), raster, "EPSG:25832");
  EXPECT_EQ(names(), Words{"a.tif"});
  const ReadBack file(pathOf("a.tif"));
  EXPECT_EQ(file.place, (std::array<double, 6>{500000.25, 0.5, 0, 5400000.5 + 7 * 0.5, 0, -0.5}));
  ASSERT_EQ(file.dataset->GetRasterCount(), 3);
  Eigen::ArrayXXf expected = raster.height.cast<float>();
  expected(3, 2) = -9999;
  EXPECT_TRUE((file.band(1) == expected).all());
  EXPECT_TRUE((file.band(2) == 0.25f).all());
  EXPECT_TRUE((file.band(3) == raster.supported.cast<float>()).all());
  EXPECT_STREQ(file.dataset->GetRasterBand(2)->GetDescription(), "uncertainty");
  EXPECT_EQ(file.dataset->GetRasterBand(1)->GetNoDataValue(), -9999);
  ASSERT_NE(file.dataset->GetSpatialRef(), nullptr);
  EXPECT_STREQ(file.dataset->GetSpatialRef()->GetAuthorityCode(nullptr), "25832");
  EXPECT_STREQ(file.dataset->GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE"), "DEFLATE");
  int block_width = 0, block_height = 0;
  file.dataset->GetRasterBand(1)->GetBlockSize(&block_width, &block_height);
  EXPECT_EQ(block_width, 256);
}

/// The heights of ground_surface.asc, (i, j) as in GroundRaster; NaN where there is none.
Eigen::ArrayXXd asciiHeights(const std::string& content) {
  std::istringstream stream(content);
  std::string word;
  Eigen::Index cols = 0, rows = 0;
  stream >> word >> cols >> word >> rows;
  for (int i = 0; i < 8; ++i) stream >> word;
  Eigen::ArrayXXd heights(cols, rows);
  for (Eigen::Index j = rows - 1; j >= 0; --j)
    for (Eigen::Index i = 0; i < cols; ++i) stream >> heights(i, j);
  EXPECT_TRUE(stream);
  return (heights == -9999).select(std::nan(""), heights);
}

TEST_F(GeoTiff, IsTheSurfaceInTheCoordinatesOfTheFile) {
  std::vector<LasPoint> points;
  for (std::int32_t i = 0; i < 100; ++i)
    for (std::int32_t j = 0; j < 100; ++j) points.push_back({{10 * i, 10 * j, (i * 7 + j * 3) % 10}, 2});
  const std::string input = makeFile("a.las", lasFile(2, 1, points));
  run(runSegment, {input, "-o", output(), "--max-object-size", "3", "--crs", "EPSG:32633"});
  const Eigen::ArrayXXd ascii = asciiHeights(contentOf(outputOf("ground_surface.asc")));
  const ReadBack file(outputOf("ground_surface.tif"));
  const Eigen::ArrayXXf height = file.band(1), supported = file.band(3);
  ASSERT_EQ(height.rows(), ascii.rows());
  ASSERT_EQ(height.cols(), ascii.cols());
  const auto known = supported > 0.5f;
  const auto origin = report()["origin"][2].get<double>();
  EXPECT_GT(known.count(), height.size() / 2);
  for (Eigen::Index n = 0; n < height.size(); ++n) {
    if (known(n))
      EXPECT_NEAR(height(n), ascii(n) + origin, 1e-3) << n;
    else
      EXPECT_EQ(height(n), -9999) << n;
  }
  EXPECT_NEAR(file.place[0], 500000, 1);  // and the origin is added to the corner
  EXPECT_STREQ(file.dataset->GetSpatialRef()->GetAuthorityCode(nullptr), "32633");
  run(runSegment, {input, "-o", output(), "--max-object-size", "3", "--raster-resolution", "0.5"});
  const ReadBack coarse(outputOf("ground_surface.tif"));
  EXPECT_EQ(coarse.place[1], 0.5);
  EXPECT_NEAR(coarse.dataset->GetRasterXSize(), 20, 1);
  EXPECT_EQ(coarse.dataset->GetSpatialRef(), nullptr);
}

/// What a command prints; nothing where it fails.
std::string printedBy(const std::string& command) {
  std::string text;
  FILE* const pipe = popen((command + " 2>/dev/null").c_str(), "r");
  for (int c = 0; pipe != nullptr && (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  return pipe != nullptr && pclose(pipe) == 0 ? text : "";
}

TEST_F(GeoTiff, GdalsOwnToolsTellTheSameOfEveryCell) {
  if (printedBy("gdalinfo --version && gdal_translate --version").empty())
    GTEST_SKIP() << "gdalinfo and gdal_translate (gdal-bin) are missing";
  run(runSegment, {makeScan(), "-o", output(), "--max-object-size", "1", "--crs", "EPSG:32633"});
  const Eigen::ArrayXXd ascii = asciiHeights(contentOf(outputOf("ground_surface.asc")));
  const std::string tif = "'" + outputOf("ground_surface.tif") + "'";
  const json info = json::parse(printedBy("gdalinfo -json " + tif));
  EXPECT_EQ(info["size"], json({ascii.rows(), ascii.cols()}));
  EXPECT_NE(info["coordinateSystem"]["wkt"].get<std::string>().find("32633"), std::string::npos);
  ASSERT_EQ(info["bands"].size(), 3U);
  for (const std::size_t band : {0U, 1U, 2U})
    EXPECT_EQ(info["bands"][band]["description"], (Words{"height", "uncertainty", "supported"}[band]));
  EXPECT_EQ(info["bands"][0]["noDataValue"], -9999.0);
  std::istringstream cells(printedBy("gdal_translate -q -b 1 -of XYZ " + tif + " /vsistdout/"));
  std::size_t known = 0;
  const auto place = info["geoTransform"].get<std::vector<double>>();
  for (Eigen::Index j = ascii.cols() - 1; j >= 0; --j)  // from the north
    for (Eigen::Index i = 0; i < ascii.rows(); ++i) {
      double x = 0, y = 0, z = 0;
      ASSERT_TRUE(cells >> x >> y >> z);
      EXPECT_NEAR(x, place[0] + place[1] * (static_cast<double>(i) + 0.5), 1e-6);
      EXPECT_NEAR(y, place[3] + place[5] * (static_cast<double>(ascii.cols() - j) - 0.5), 1e-6);
      if (z == -9999) continue;
      ++known;
      EXPECT_NEAR(z, ascii(i, j), 1e-3) << i << " " << j;
    }
  EXPECT_GT(known, static_cast<std::size_t>(ascii.size()) / 2);
  double more = 0;
  EXPECT_FALSE(cells >> more);
}

TEST_F(GeoTiff, OptionsThatMakeNoRasterAreRefused) {
  const std::string scan = makeScan();
  for (const Words& wrong :
       {Words{"--crs", "EPSG:0"}, Words{"--crs", "nowhere"}, Words{"--raster-resolution", "0"},
        Words{"--raster-resolution", "-1"}, Words{"--raster-resolution", "nan"}})
    EXPECT_THROW(segment(scan, wrong), UsageError) << wrong.back();
  EXPECT_FALSE(hasOutput());
  EXPECT_THROW(segment(scan, {"--raster-resolution", "1e-6"}), WorkError);
}

#else

TEST_F(GeoTiff, IsRefusedWithoutGdal) {
  EXPECT_FALSE(canWriteGeoTiff());
  EXPECT_THROW(segment(makeScan(), {"--crs", "EPSG:25832"}), UsageError);
  segment(makeScan());
  EXPECT_FALSE(std::filesystem::exists(outputOf("ground_surface.tif")));
}

#endif

}  // namespace
}  // namespace pcl_fft_ground::cli
