#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/cloud_file.h"
#include "methods/segmentation.h"
#include "pcl_fft_ground/core/segments/object_properties.h"
#include "pictures/pictures.h"

namespace pcl_fft_ground::cli {

/// The points of labelled.pcd: those of the input with all their fields and `label`, `segment` and, where
/// they are there, `height`.
pcl::PCLPointCloud2 labelledFields(const Cloud& cloud, const Segmentation& segmentation);

/// Writes labelled.pcd, ground.pcd and objects.pcd: the input's points with all their fields and `label` and
/// `segment`; a label or segment that the input brought is kept as `truth` or `truth_segment`.
void writeClouds(const std::string& directory, const Cloud& cloud, const Segmentation& segmentation);

/// Writes labelled.las, or labelled.laz of a compressed cloud: the LAS file `input` with the classes of what
/// its points are; those that are neither ground nor object keep theirs.
/// \throws WorkError naming the file
void writeLas(const std::string& directory, const std::string& input, const Cloud& cloud,
              const Segmenter& segmenter, const Segmentation& segmentation, const LasClasses& classes);

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

/// The first line of segments.csv.
std::string segmentHeader();

/// A row of segments.csv. \param size number of points; `points` may be fewer, evenly taken
/// \param heights of `points` above the ground [m]
std::string segmentRow(std::size_t number, std::size_t size, const core::Points& points,
                       const std::vector<double>& heights, const core::ObjectView& view);

/// Writes segments.csv, a row per segment.
void writeSegments(const std::string& directory, const Cloud& cloud, const Segmentation& segmentation);

/** What the pictures show of the cells of a grid: points are added one by one.
 *
 * Of each cell what is lowest of the objects in it is shown, as a ceiling or a crown would hide all that is
 * below, else the ground.
 */
class CellViews {
 public:
  explicit CellViews(const core::GridGeometry& cells);

  /// \param level place in the level frame; beside the grid it counts for nothing
  /// \param segment its number, 0 for none
  /// \param height above the ground [m]
  void add(const Eigen::Vector3d& level, core::Label label, std::int32_t segment, double height);

  const core::GridGeometry& cells() const { return cells_; }
  const Eigen::ArrayXXd& top() const { return top_; }  ///< the highest point of each cell, NaN for none
  const Eigen::ArrayXXd& lowestObject() const { return lowest_object_; }  ///< its height [m], infinite: none
  const Eigen::ArrayXXi& lowestSegment() const { return lowest_segment_; }
  bool hasGround(Eigen::Index cell) const { return has_ground_.data()[cell]; }

  /// Of the objects, evenly taken, the heights above the ground [m].
  const std::vector<double>& objectHeights() const { return object_heights_; }

 private:
  core::GridGeometry cells_;
  Eigen::ArrayXXd top_, lowest_object_;
  Eigen::ArrayXXi lowest_segment_;
  core::Mask has_ground_;
  std::vector<double> object_heights_;
  std::size_t objects_ = 0, one_in_ = 1;
};

/// How many points are what, and how many segments there are.
struct PointCounts {
  long long ground = 0, objects = 0, neither = 0;
  int segments = 0;
};

/// Draws what writePictures() writes. \param surface at the cells of the views
/// \param spectrum nothing: no spectrum.png
void drawPictures(const std::string& directory, const CellViews& views, const core::GroundSurface& surface,
                  const std::optional<SpectrumImage>& spectrum, const PointCounts& counts);

/// Writes elevation.png, ground.png, spectrum.png, labels.png and segments.png.
void writePictures(const std::string& directory, const Segmenter& segmenter, const Segmentation& segmentation,
                   const Cloud& cloud);

}  // namespace pcl_fft_ground::cli
