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

constexpr double NOTHING = std::numeric_limits<double>::infinity();

/// What the pictures show of each cell.
struct CellView {
  Eigen::ArrayXXi labels;    ///< -1 no points, else a CellClass
  Eigen::ArrayXXi segments;  ///< -1 no points, 0 none, k segment k, count + k segment k high above ground
  GridImage relief;          ///< what lights the cells: the top, but the ground below what is high above it
};

/// Height above the ground from which an object is high above it: half of that of the highest objects, all
/// but one in a hundred. So a table is an object in a room, and the ceiling is above it.
double overhangHeight(std::vector<double> of_objects) {
  constexpr double share_below = 0.99, share_of_height = 0.5;
  if (of_objects.empty()) return NOTHING;
  const auto high = of_objects.begin() +
                    static_cast<std::ptrdiff_t>(share_below * static_cast<double>(of_objects.size() - 1));
  std::nth_element(of_objects.begin(), high, of_objects.end());
  return share_of_height * std::max(*high, 0.0);
}

CellView viewOfCells(const CellViews& views, const core::GroundSurface& surface, const GridImage& top,
                     int segments) {
  const core::GridGeometry& cells = views.cells();
  CellView view{Eigen::ArrayXXi::Constant(cells.rows, cells.cols, -1),
                Eigen::ArrayXXi::Constant(cells.rows, cells.cols, -1), top};
  const double high = overhangHeight(views.objectHeights());
  for (Eigen::Index cell = 0; cell < view.labels.size(); ++cell) {
    const double lowest = views.lowestObject().data()[cell];
    if (views.hasGround(cell))
      view.labels.data()[cell] = view.segments.data()[cell] = static_cast<int>(CellClass::GROUND);
    if (lowest == NOTHING) continue;
    const bool ground_seen =
        views.hasGround(cell) || (surface.supported.size() > 0 && surface.supported.data()[cell]);
    const bool overhangs = ground_seen && lowest > high;
    const int segment = views.lowestSegment().data()[cell];
    view.labels.data()[cell] = static_cast<int>(overhangs ? CellClass::ABOVE_GROUND : CellClass::OBJECT);
    view.segments.data()[cell] = overhangs && segment > 0 ? segment + segments : segment;
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

CellViews::CellViews(const core::GridGeometry& cells)
    : cells_(cells),
      top_(Eigen::ArrayXXd::Constant(cells.rows, cells.cols, std::numeric_limits<double>::quiet_NaN())),
      lowest_object_(Eigen::ArrayXXd::Constant(cells.rows, cells.cols, NOTHING)),
      lowest_segment_(Eigen::ArrayXXi::Zero(cells.rows, cells.cols)),
      has_ground_(core::Mask::Constant(cells.rows, cells.cols, false)) {}

void CellViews::add(const Eigen::Vector3d& level, core::Label label, std::int32_t segment, double height) {
  constexpr std::size_t ENOUGH = 1 << 20;
  if (label == core::Label::NEITHER) return;
  const bool is_object = label == core::Label::OBJECT;
  if (is_object && std::isfinite(height) && objects_++ % one_in_ == 0) {
    object_heights_.push_back(height);
    if (object_heights_.size() >= 2 * ENOUGH) {  // every second one remains
      for (std::size_t n = 0; n < ENOUGH; ++n) object_heights_[n] = object_heights_[2 * n];
      object_heights_.resize(ENOUGH);
      one_in_ *= 2;
    }
  }
  const Eigen::Index cell = cellBelow(cells_, level);
  if (cell < 0) return;  // a far point
  double& top = top_.data()[cell];
  if (!(top >= level.z())) top = level.z();
  if (!is_object) has_ground_.data()[cell] = true;
  if (!is_object || height >= lowest_object_.data()[cell]) return;
  lowest_object_.data()[cell] = height;
  lowest_segment_.data()[cell] = segment;
}

void drawPictures(const std::string& directory, const CellViews& views, const core::GroundSurface& surface,
                  const std::optional<SpectrumImage>& spectrum, const PointCounts& counts) {
  const core::GridGeometry& cells = views.cells();
  const GridImage top{views.top(), cells.origin, cells.cell_size};
  const GridImage ground{knownHeights(surface), cells.origin, cells.cell_size};
  const std::optional<ValueRange> range = robustRange(top.values);
  const auto draw = [&](const std::string& name, const auto& drawing) {
    writeWhole(directory + "/" + name, [&](const std::string& path) { drawing(path); });
  };
  draw("elevation.png", [&](const auto& path) {
    drawHeights(path, "Elevation: highest point of each cell", top, "height [m]", range);
  });
  const char* const ground_title = surface.supported.size() == 0
                                       ? "Ground surface"
                                       : "Ground surface; white where no ground was seen nearby";
  draw("ground.png", [&](const auto& path) { drawHeights(path, ground_title, ground, "height [m]", range); });
  if (spectrum) draw("spectrum.png", [&](const auto& path) { drawSpectrum(path, *spectrum); });
  const CellView view = viewOfCells(views, surface, top, counts.segments);
  draw("labels.png", [&](const auto& path) {
    drawLabels(path, "Ground and objects", view.relief, view.labels,
               {counts.ground, counts.objects, counts.neither});
  });
  draw("segments.png", [&](const auto& path) {
    drawSegments(path, "Segments", view.relief, view.segments, counts.segments);
  });
}

void writePictures(const std::string& directory, const Segmenter& segmenter, const Segmentation& segmentation,
                   const Cloud& cloud) {
  CellViews views(segmentation.elevation.geometry);
  const std::vector<double> heights = segmenter.filter->getHeightAboveGround();
  const Eigen::Isometry3d& frame = segmentation.surface.frame_from_input;
  for (std::size_t n = 0; n < cloud.points->size(); ++n)
    views.add(frame * (*cloud.points)[n].getVector3fMap().cast<double>(), segmentation.labels[n],
              segmentation.segments[n], heights[n]);
  PointCounts counts;
  counts.ground = static_cast<long long>(segmentation.ground.indices.size());
  counts.objects = static_cast<long long>(segmentation.objects.indices.size());
  counts.neither = static_cast<long long>(cloud.points->size()) - counts.ground - counts.objects;
  counts.segments = static_cast<int>(segmentation.clusters.size());
  std::optional<SpectrumImage> spectrum;
  if (segmenter.fft != nullptr) spectrum = spectrumImage(*segmenter.fft);
  drawPictures(directory, views, segmentation.surface, spectrum, counts);
}

}  // namespace pcl_fft_ground::cli
