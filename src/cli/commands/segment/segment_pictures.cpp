#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "commands/segment/segment_outputs.h"
#include "io/output_file.h"
#include "pictures/pictures.h"
#include "pictures/raster.h"

namespace pcl_fft_ground::cli {
namespace {

/// What the pictures show of each cell: what is lowest of the objects in it, as a ceiling or a crown would
/// hide all that is below, else the ground.
struct CellView {
  Eigen::ArrayXXi labels;    ///< -1 no points, else a CellClass
  Eigen::ArrayXXi segments;  ///< -1 no points, 0 none, k segment k, count + k segment k high above ground
  GridImage relief;          ///< what lights the cells: the top, but the ground below what is high above it
};

/// Height above the ground from which an object is high above it: half of that of the highest objects, all
/// but one in a hundred. So a table is an object in a room, and the ceiling is above it.
double overhangHeight(const std::vector<double>& heights, const core::Labels& labels) {
  constexpr double share_below = 0.99, share_of_height = 0.5;
  std::vector<double> of_objects;
  for (std::size_t n = 0; n < labels.size(); ++n)
    if (labels[n] == core::Label::OBJECT && std::isfinite(heights[n])) of_objects.push_back(heights[n]);
  if (of_objects.empty()) return std::numeric_limits<double>::infinity();
  const auto high = of_objects.begin() +
                    static_cast<std::ptrdiff_t>(share_below * static_cast<double>(of_objects.size() - 1));
  std::nth_element(of_objects.begin(), high, of_objects.end());
  return share_of_height * std::max(*high, 0.0);
}

CellView viewOfCells(const Cloud& cloud, const Segmentation& segmentation, const std::vector<double>& heights,
                     const GridImage& top) {
  const core::GridGeometry& cells = segmentation.elevation.geometry;
  constexpr double nothing = std::numeric_limits<double>::infinity();
  Eigen::ArrayXXd lowest_object = Eigen::ArrayXXd::Constant(cells.rows, cells.cols, nothing);
  Eigen::ArrayXXi lowest_segment = Eigen::ArrayXXi::Zero(cells.rows, cells.cols);
  CellView view{Eigen::ArrayXXi::Constant(cells.rows, cells.cols, -1), {}, top};
  for (std::size_t n = 0; n < cloud.points->size(); ++n) {
    if (segmentation.labels[n] == core::Label::NEITHER) continue;
    const Eigen::Vector3d p =
        segmentation.surface.frame_from_input * (*cloud.points)[n].getVector3fMap().cast<double>();
    const Eigen::Index cell = cellBelow(cells, p);
    if (cell < 0) continue;  // a far point
    const bool is_object = segmentation.labels[n] == core::Label::OBJECT;
    if (!is_object) view.labels.data()[cell] = static_cast<int>(CellClass::GROUND);
    if (!is_object || heights[n] >= lowest_object.data()[cell]) continue;
    lowest_object.data()[cell] = heights[n];
    lowest_segment.data()[cell] = segmentation.segments[n];
  }
  const double high = overhangHeight(heights, segmentation.labels);
  const core::GroundSurface& surface = segmentation.surface;
  view.segments = view.labels;
  for (Eigen::Index cell = 0; cell < view.labels.size(); ++cell) {
    if (lowest_object.data()[cell] == nothing) continue;
    const bool ground_seen = view.labels.data()[cell] == static_cast<int>(CellClass::GROUND) ||
                             (surface.supported.size() > 0 && surface.supported.data()[cell]);
    const bool overhangs = ground_seen && lowest_object.data()[cell] > high;
    const int segment = lowest_segment.data()[cell];
    view.labels.data()[cell] = static_cast<int>(overhangs ? CellClass::ABOVE_GROUND : CellClass::OBJECT);
    view.segments.data()[cell] =
        overhangs && segment > 0 ? segment + static_cast<int>(segmentation.clusters.size()) : segment;
    if (overhangs) view.relief.values.data()[cell] = surface.height.data()[cell];
  }
  return view;
}

/// The heights of the ground, those left out of which the method knows that it saw no ground nearby.
Eigen::ArrayXXd knownHeights(const core::GroundSurface& surface) {
  if (surface.supported.size() == 0) return surface.height;
  return surface.supported.select(surface.height, std::numeric_limits<double>::quiet_NaN());
}

SpectrumImage spectrumImage(const FFTGroundSegmentation<Point>& fft) {
  SpectrumImage image;
  image.before = core::magnitude(fft.getSpectrum());
  image.after = core::magnitude(fft.getFilteredSpectrum());
  image.cutoff = fft.getCutoff().frequency;
  image.object_size = fft.getCutoff().object_size;
  image.cell_size = fft.getCellSize();
  if (const auto peak = fft.getCutoff().peak)
    image.peak = Eigen::Vector2i(static_cast<int>(peak->k), static_cast<int>(peak->l));
  return image;
}

}  // namespace

void writePictures(const std::string& directory, const Segmenter& segmenter, const Segmentation& segmentation,
                   const Cloud& cloud) {
  const core::ElevationGrid& elevation = segmentation.elevation;
  const GridImage top{
      elevation.observed.select(elevation.elevation, std::numeric_limits<double>::quiet_NaN()),
      elevation.geometry.origin, elevation.geometry.cell_size};
  const GridImage ground{knownHeights(segmentation.surface), elevation.geometry.origin,
                         elevation.geometry.cell_size};
  const std::optional<ValueRange> range = robustRange(top.values);
  const auto draw = [&](const std::string& name, const auto& drawing) {
    writeWhole(directory + "/" + name, [&](const std::string& path) { drawing(path); });
  };
  draw("elevation.png", [&](const auto& path) {
    drawHeights(path, "Elevation: highest point of each cell", top, "height [m]", range);
  });
  const char* const ground_title = segmentation.surface.supported.size() == 0
                                       ? "Ground surface"
                                       : "Ground surface; white where no ground was seen nearby";
  draw("ground.png", [&](const auto& path) { drawHeights(path, ground_title, ground, "height [m]", range); });
  if (segmenter.fft != nullptr)
    draw("spectrum.png", [&](const auto& path) { drawSpectrum(path, spectrumImage(*segmenter.fft)); });

  const auto count = [&](const pcl::PointIndices& indices) {
    return static_cast<long long>(indices.indices.size());
  };
  LabelCounts counts{count(segmentation.ground), count(segmentation.objects), 0};
  counts.neither = static_cast<long long>(cloud.points->size()) - counts.ground - counts.objects;
  const CellView view = viewOfCells(cloud, segmentation, segmenter.filter->getHeightAboveGround(), top);
  draw("labels.png",
       [&](const auto& path) { drawLabels(path, "Ground and objects", view.relief, view.labels, counts); });
  draw("segments.png", [&](const auto& path) {
    drawSegments(path, "Segments", view.relief, view.segments,
                 static_cast<int>(segmentation.clusters.size()));
  });
}

}  // namespace pcl_fft_ground::cli
