#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "io/cloud_file.h"
#include "methods/segmentation.h"

namespace pcl_fft_ground::cli {

/// Writes labelled.pcd, ground.pcd and objects.pcd: the input's points with all their fields and `label` and
/// `segment`; a label or segment that the input brought is kept as `truth` or `truth_segment`.
void writeClouds(const std::string& directory, const Cloud& cloud, const Segmentation& segmentation);

/// Writes labelled.las: the LAS file `input` with the classes of what its points are; those that are neither
/// ground nor object keep theirs.
/// \throws WorkError naming the file
void writeLas(const std::string& directory, const std::string& input, const Segmenter& segmenter,
              const Segmentation& segmentation, const LasClasses& classes);

/// How ground_surface.tif is written.
struct RasterOptions {
  double resolution = 0;  ///< side of a cell [m]; 0: that of the surface
  std::string crs;        ///< coordinate reference system; empty: the one that the input names
};

/// Writes ground_surface.pcd, a point per cell in the frame of the input, ground_surface.asc, the surface
/// resampled to the input's x and y axes, and, where there is GDAL, ground_surface.tif, the same in the
/// input's own coordinates with how certain it is. \throws WorkError for a resolution that would give more
/// than core::MAX_CELLS cells
void writeGroundSurface(const std::string& directory, const Cloud& cloud, const Segmentation& segmentation,
                        const RasterOptions& raster);

/// Writes segments.csv, a row per segment.
void writeSegments(const std::string& directory, const Cloud& cloud, const Segmentation& segmentation);

/// Writes elevation.png, ground.png, spectrum.png, labels.png and segments.png.
void writePictures(const std::string& directory, const Segmenter& segmenter, const Segmentation& segmentation,
                   const Cloud& cloud);

}  // namespace pcl_fft_ground::cli
