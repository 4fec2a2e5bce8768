#include "errors.h"
#include "io/output_file.h"
#include "io/raster_files.h"

#ifdef PCL_FFT_GROUND_WITH_GDAL

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace pcl_fft_ground::cli {
namespace {

constexpr float no_data = -9999;

/// GDAL's complaints are returned, not printed, while it lives.
class QuietErrors {
 public:
  QuietErrors() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~QuietErrors() { CPLPopErrorHandler(); }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;
};

struct Close {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, Close>;

/// The reference system that a text names; nothing if GDAL does not know it. Names of files and of places in
/// the network, which GDAL would read as well, are none.
std::optional<OGRSpatialReference> referenceOf(const std::string& crs) {
  OGRSpatialReference reference;
  const auto limits = OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get();
  if (crs.empty() || reference.SetFromUserInput(crs.c_str(), limits) != OGRERR_NONE) return std::nullopt;
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);  // x before y, as in the raster
  return reference;
}

[[noreturn]] void fail(const std::string& path) {
  throw WorkError("cannot write '" + path + "': " + CPLGetLastErrorMsg());
}

/// A file in memory, removed at the end of the scope.
class MemoryFile {
 public:
  explicit MemoryFile(const void* owner)
      : name_("/vsimem/ground_" + std::to_string(reinterpret_cast<std::uintptr_t>(owner))) {}
  ~MemoryFile() { VSIUnlink(name_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const char* name() const { return name_.c_str(); }
  std::string_view content() const {
    vsi_l_offset size = 0;
    const GByte* const bytes = VSIGetMemFileBuffer(name_.c_str(), &size, FALSE);
    return {reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size)};
  }

 private:
  std::string name_;
};

void writeBand(GDALDataset& dataset, int number, const char* name, const Eigen::ArrayXXd& values,
               const std::string& path) {
  GDALRasterBand* const band = dataset.GetRasterBand(number);
  band->SetDescription(name);
  band->SetNoDataValue(no_data);
  std::vector<float> row(static_cast<std::size_t>(values.rows()));
  for (Eigen::Index j = 0; j < values.cols(); ++j) {  // the first row is the northernmost
    const auto line = values.col(values.cols() - 1 - j);
    for (Eigen::Index i = 0; i < values.rows(); ++i)
      row[static_cast<std::size_t>(i)] = std::isfinite(line(i)) ? static_cast<float>(line(i)) : no_data;
    const int width = static_cast<int>(values.rows());
    if (band->RasterIO(GF_Write, 0, static_cast<int>(j), width, 1, row.data(), width, 1, GDT_Float32, 0, 0,
                       nullptr) != CE_None)
      fail(path);
  }
}

}  // namespace

bool canWriteGeoTiff() {
  return true;
}

bool isKnownCrs(const std::string& crs) {
  const QuietErrors quiet;
  return referenceOf(crs).has_value();
}

void writeGeoTiff(const std::string& path, const GroundRaster& raster, const std::string& crs) {
  const QuietErrors quiet;
  GDALRegister_GTiff();
  const MemoryFile file(&raster);
  CPLStringList options;
  for (const char* option : {"TILED=YES", "COMPRESS=DEFLATE", "BIGTIFF=IF_SAFER"}) options.AddString(option);
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) fail(path);
  Dataset dataset(driver->Create(file.name(), static_cast<int>(raster.height.rows()),
                                 static_cast<int>(raster.height.cols()), 3, GDT_Float32, options.List()));
  if (dataset == nullptr) fail(path);
  const double top =
      raster.lower_left_corner.y() + raster.cell_size * static_cast<double>(raster.height.cols());
  std::array<double, 6> place{raster.lower_left_corner.x(), raster.cell_size, 0, top, 0, -raster.cell_size};
  if (dataset->SetGeoTransform(place.data()) != CE_None) fail(path);
  const auto reference = referenceOf(crs);
  if (!crs.empty() && (!reference || dataset->SetSpatialRef(&*reference) != CE_None)) fail(path);
  writeBand(*dataset, 1, "height", raster.height, path);
  writeBand(*dataset, 2, "uncertainty", raster.uncertainty, path);
  writeBand(*dataset, 3, "supported", raster.supported, path);
  dataset->FlushCache();
  dataset.reset();
  writeText(path, file.content());
}

}  // namespace pcl_fft_ground::cli

#else

namespace pcl_fft_ground::cli {

bool canWriteGeoTiff() {
  return false;
}

bool isKnownCrs(const std::string&) {
  return false;
}

void writeGeoTiff(const std::string& path, const GroundRaster&, const std::string&) {
  throw WorkError("cannot write '" + path + "': this program is built without GDAL");
}

}  // namespace pcl_fft_ground::cli

#endif
