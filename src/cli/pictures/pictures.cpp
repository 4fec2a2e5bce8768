#include "pictures/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "pictures/canvas.h"
#include "pictures/colour_map.h"
#include "pictures/map_page.h"

namespace pcl_fft_ground::cli {
namespace {

using Eigen::ArrayXXd;
using Eigen::ArrayXXi;
using Eigen::Index;
using Eigen::Vector2d;

const Colour kGround = {0.70, 0.70, 0.70};
const Colour kObject = {0.13, 0.36, 0.86};
const Colour kNoSegment = {0.84, 0.84, 0.84};
constexpr double kPale = 0.3;  // share of the colour of what is high above the ground in that of the cell
constexpr std::uint32_t kNothing = 0xffffffffU;

/// Size of a cell of a grid reduced to rows x cols [m].
Vector2d spacingOf(const GridImage& image, Index rows, Index cols) {
  return image.cell_size * Vector2d(static_cast<double>(image.values.rows()) / static_cast<double>(rows),
                                    static_cast<double>(image.values.cols()) / static_cast<double>(cols));
}

Index pixels(double length) {
  return static_cast<Index>(length);
}

ArrayXXd shadeFor(const GridImage& image, const ArrayXXd& reduced) {
  if (reduced.size() == 0) return reduced;
  return hillShade(reduced, spacingOf(image, reduced.rows(), reduced.cols()));
}

Colour mixed(const Colour& first, const Colour& second, double share_of_second) {
  const auto mix = [&](double a, double b) { return a + share_of_second * (b - a); };
  return {mix(first.red, second.red), mix(first.green, second.green), mix(first.blue, second.blue)};
}

std::string withShare(const std::string& name, long long count, long long total) {
  const double percent = total > 0 ? 100.0 * static_cast<double>(count) / static_cast<double>(total) : 0.0;
  return name + ": " + groupedNumber(count) + " points (" + fixedNumber(percent, 1) + " %)";
}

void requireSameSize(const GridImage& shade, const ArrayXXi& classes) {
  if (shade.values.rows() != classes.rows() || shade.values.cols() != classes.cols())
    throw std::invalid_argument("the classes of a picture must have the size of its elevation grid");
}

/// What is needed to write a number on a segment.
struct Blob {
  Index cells = 0;
  Vector2d sum = Vector2d::Zero();
  Vector2d label_cell = Vector2d::Zero();  ///< the cell of the segment nearest to its centroid
};

std::map<int, Blob> blobsOf(const ArrayXXi& segments) {
  std::map<int, Blob> blobs;
  const auto for_each_cell = [&](const auto& visit) {
    for (Index j = 0; j < segments.cols(); ++j)
      for (Index i = 0; i < segments.rows(); ++i)
        if (segments(i, j) > 0)
          visit(blobs[segments(i, j)], Vector2d(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5));
  };
  for_each_cell([](Blob& blob, const Vector2d& cell) {
    ++blob.cells;
    blob.sum += cell;
    blob.label_cell = cell;
  });
  for_each_cell([](Blob& blob, const Vector2d& cell) {
    const Vector2d centroid = blob.sum / static_cast<double>(blob.cells);
    if ((cell - centroid).squaredNorm() < (blob.label_cell - centroid).squaredNorm()) blob.label_cell = cell;
  });
  return blobs;
}

/// Numbers the largest segments, but none too small for its number and none on top of another.
void numberSegments(Canvas& canvas, const Plot& plot, const ArrayXXi& segments) {
  constexpr std::size_t kMost = 40;
  constexpr double kLeastArea = 350.0;  // pixels, about what a number covers
  const Vector2d pixels_per_cell(plot.area.width / static_cast<double>(segments.rows()),
                                 plot.area.height / static_cast<double>(segments.cols()));
  const std::map<int, Blob> blobs = blobsOf(segments);
  std::vector<std::pair<int, Blob>> by_size(blobs.begin(), blobs.end());
  std::stable_sort(by_size.begin(), by_size.end(),
                   [](const auto& a, const auto& b) { return a.second.cells > b.second.cells; });
  TextStyle style{13.0, Anchor::MIDDLE, {0.05, 0.05, 0.05}, Weight::BOLD};
  style.halo = 2.0;
  std::vector<Vector2d> taken;
  for (const auto& [segment, blob] : by_size) {
    const double area = static_cast<double>(blob.cells) * pixels_per_cell.prod();
    if (area < kLeastArea || taken.size() == kMost) break;
    const Vector2d offset = blob.label_cell.cwiseProduct(pixels_per_cell);
    const Vector2d position(plot.area.x + offset.x(), plot.area.bottom() - offset.y());
    const bool is_free = std::none_of(taken.begin(), taken.end(), [&](const Vector2d& other) {
      return std::abs(other.x() - position.x()) < 26.0 && std::abs(other.y() - position.y()) < 16.0;
    });
    if (!is_free) continue;
    canvas.text(position, std::to_string(segment), style);
    taken.push_back(position);
  }
}

}  // namespace

void drawHeights(const std::filesystem::path& path, const std::string& title, const GridImage& image,
                 const std::string& label, const std::optional<ValueRange>& range) {
  const MapPage page = layOutMap(image, MapKey::COLOUR_BAR);
  const std::optional<ValueRange> shown = range ? range : robustRange(image.values);
  const ArrayXXd heights =
      reducedMean(image.values, pixels(page.plot.area.width), pixels(page.plot.area.height));
  if (!shown || !image.values.isFinite().any()) {
    Canvas canvas = startMap(page, title, {});
    writeInMiddle(canvas, page.plot, "no known values");
    canvas.write(path);
    return;
  }
  const ColourScale scale{heightPalette(), *shown, label,
                          (image.values.isFinite() && image.values < shown->low).any(),
                          (image.values.isFinite() && image.values > shown->high).any()};
  const ArrayXXd light = shadeFor(image, heights);
  Pixels map(heights.rows(), heights.cols());
  for (Index k = 0; k < heights.size(); ++k) {
    const double height = heights.data()[k];
    map.data()[k] = std::isfinite(height) ? packed(shaded(scale.colour(height), light.data()[k])) : kNothing;
  }
  Canvas canvas = startMap(page, title, map);
  drawColourBar(canvas, page.key, scale);
  canvas.write(path);
}

void drawLabels(const std::filesystem::path& path, const std::string& title, const GridImage& shade,
                const ArrayXXi& classes, const LabelCounts& counts) {
  requireSameSize(shade, classes);
  const MapPage page = layOutMap(shade, MapKey::LEGEND);
  const Index width = pixels(page.plot.area.width);
  const Index height = pixels(page.plot.area.height);
  const ArrayXXd light = shadeFor(shade, reducedMean(shade.values, width, height));
  const std::array<Colour, 3> colours{kGround, kObject, mixed(kGround, kObject, kPale)};  // by CellClass
  const Pixels map = shadedClasses(reducedMode(classes, width, height), light,
                                   [&](int kind) { return colours[static_cast<std::size_t>(kind)]; });
  Canvas canvas = startMap(page, title, map);
  if (!(classes >= 0).any()) writeInMiddle(canvas, page.plot, "no points");
  const long long total = counts.ground + counts.objects + counts.neither;
  std::vector<LegendEntry> legend = {{kGround, withShare("ground", counts.ground, total)},
                                     {kObject, withShare("objects", counts.objects, total)}};
  if ((classes == static_cast<int>(CellClass::ABOVE_GROUND)).any())
    legend.push_back({colours.back(), "objects high above ground"});
  if (counts.neither > 0) legend.push_back({{1.0, 1.0, 1.0}, withShare("neither", counts.neither, total)});
  drawLegend(canvas, page.key.y, legend);
  canvas.write(path);
}

void drawSegments(const std::filesystem::path& path, const std::string& title, const GridImage& shade,
                  const ArrayXXi& segments, int count) {
  requireSameSize(shade, segments);
  const MapPage page = layOutMap(shade, MapKey::LEGEND);
  const Index width = pixels(page.plot.area.width);
  const Index height = pixels(page.plot.area.height);
  const ArrayXXi shown = reducedMode(segments, width, height);
  const ArrayXXd light = shadeFor(shade, reducedMean(shade.values, width, height));
  std::map<int, Colour> colours = {{0, kNoSegment}};
  const Pixels map = shadedClasses(shown, light, [&](int segment) {
    const auto known = colours.find(segment);
    if (known != colours.end()) return known->second;
    const Colour colour =
        segment <= count ? segmentColour(segment) : mixed(kNoSegment, segmentColour(segment - count), kPale);
    return colours.emplace(segment, colour).first->second;
  });
  Canvas canvas = startMap(page, title, map);
  if (!(segments >= 0).any()) writeInMiddle(canvas, page.plot, "no points");
  if (shown.size() > 0) numberSegments(canvas, page.plot, (shown > count).select(shown - count, shown));
  const std::string noun = count == 1 ? " segment" : " segments";
  const std::string numbering = count > 0 ? ", numbered by falling size" : "";
  drawLegend(canvas, page.key.y,
             {{kNoSegment, "ground and unclustered points"},
              {segmentColour(1), groupedNumber(count) + noun + numbering}});
  canvas.write(path);
}

}  // namespace pcl_fft_ground::cli
