#pragma once

#include <Eigen/Core>
#include <string>

/// Maps of the ground for programs of geographic information systems. In all of them (i, j) is the cell at x
/// = corner.x + (i + 1/2) cell_size, y = corner.y + (j + 1/2) cell_size, and files appear whole or not at
/// all.
namespace pcl_fft_ground::cli {

/// Writes a map of heights as an ESRI ASCII grid.
/// \param heights            heights(i, j) [m]; anything not finite is "no data" (-9999). Written to 0.1 mm;
/// a
///         height of -9999 itself comes out 0.1 mm higher
/// \param lower_left_corner  outer corner of the cell (0, 0) [m], written with all its digits
/// \param cell_size          [m], above 0
/// \throws WorkError naming the file if it cannot be written
/// \throws std::invalid_argument for no cells, a corner that is not finite or a cell size that is not above
///         0
void writeAsciiGrid(const std::string& path, const Eigen::ArrayXXd& heights,
                    const Eigen::Vector2d& lower_left_corner, double cell_size);

/// The ground over level cells. All arrays have one size.
struct GroundRaster {
  Eigen::ArrayXXd height;                                       ///< [m]; NaN: no data
  Eigen::ArrayXXd uncertainty;                                  ///< standard deviation [m]; NaN: no data
  Eigen::ArrayXXd supported;                                    ///< 1 where ground was seen nearby, else 0
  Eigen::Vector2d lower_left_corner = Eigen::Vector2d::Zero();  ///< [m], in the coordinates of the file
  double cell_size = 1;                                         ///< [m], above 0
};

/// Whether this program is built with GDAL, which writes GeoTIFF.
bool canWriteGeoTiff();

/// Whether GDAL knows a coordinate reference system, such as "EPSG:25832" or WKT; false without GDAL.
bool isKnownCrs(const std::string& crs);

/** Writes the ground as GeoTIFF: float32 bands `height`, `uncertainty` and `supported`, no data -9999, tiled
 * and compressed.
 *
 * \param crs  of x and y, as isKnownCrs() knows it; empty: none is written
 * \throws WorkError naming the file if it cannot be written, or canWriteGeoTiff() says so
 */
void writeGeoTiff(const std::string& path, const GroundRaster& raster, const std::string& crs);

}  // namespace pcl_fft_ground::cli
