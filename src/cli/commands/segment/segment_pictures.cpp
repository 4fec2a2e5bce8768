#include <limits>

#include "commands/segment/segment_outputs.h"
#include "io/output_file.h"
#include "pictures/grid_cell.h"
#include "pictures/pictures.h"

namespace pcl_fft_ground::cli {
namespace {

/// The class of each cell: the largest among its points, so that an object is not hidden by the ground below
/// it. \param value function from point number to class; the cells without points get -1
template <typename ValueOfPoint>
Eigen::ArrayXXi classesOfCells(const Cloud& cloud, const Segmentation& segmentation,
                               const ValueOfPoint& value) {
  const core::GridGeometry& cells = segmentation.elevation.geometry;
  Eigen::ArrayXXi classes = Eigen::ArrayXXi::Constant(cells.rows, cells.cols, -1);
  for (std::size_t n = 0; n < cloud.points->size(); ++n) {
    if (segmentation.labels[n] == core::Label::NEITHER) continue;
    const Eigen::Vector3d p =
        segmentation.surface.frame_from_input * (*cloud.points)[n].getVector3fMap().cast<double>();
    const Eigen::Index cell = cellBelow(cells, p);
    if (cell < 0) continue;  // a far point
    classes.data()[cell] = std::max(classes.data()[cell], value(n));
  }
  return classes;
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
  const Eigen::ArrayXXi labels = classesOfCells(
      cloud, segmentation, [&](std::size_t n) { return static_cast<int>(segmentation.labels[n]); });
  draw("labels.png", [&](const auto& path) { drawLabels(path, "Ground and objects", top, labels, counts); });
  const Eigen::ArrayXXi segments = classesOfCells(
      cloud, segmentation, [&](std::size_t n) { return static_cast<int>(segmentation.segments[n]); });
  draw("segments.png", [&](const auto& path) {
    drawSegments(path, "Segments", top, segments, static_cast<int>(segmentation.clusters.size()));
  });
}

}  // namespace pcl_fft_ground::cli
